// What every engine must agree on so that its pictures look alike: the light, how planes appear,
// and what is drawn over surfaces.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/picture/preview_light.h"
#include "core/picture/scene_description.h"
#include "render/view_fit.h"

namespace scree {

/// What is shown, whichever engine draws.
struct StageSettings {
    bool groundLines = true;      ///< a faint grid on planes, to judge distances by
    bool wireframe = false;       ///< the edges of all triangles, over the shaded surface
    Vec3 towardSun = kTowardSun;  ///< as there
};

/// The tone curve: `toe` is the light [-] below which it falls off with the square, `gain` what it
/// rises by above, `shoulder` where it begins to bend towards white. Tuned on shots/rings_100,
/// whose picture was grey and flat with a gain of 1 and no toe.
inline constexpr double kFilmToe = 0.035, kFilmGain = 1.2, kFilmShoulder = 0.6;

/// What a display shows of light in a scene, both linear.
Vec3 tonedForDisplay(const Vec3& light);

/// Haze on planes begins and ends at these multiples of the distance from eye to target: measured
/// from the eye, so that it stands still while the heap moves.
inline constexpr double kHazeBegin = 1.1, kHazeEnd = 6.0;

/// Every so many of the grid's lines one is stronger.
inline constexpr double kStrongLinePeriod = 5.0;

/// Distance between the grid's lines: a power of ten, some ten of them across the picture.
double gridSpacing(double distanceToTarget);

/// Unit vector up and towards the sun in the axes of the scene.
Vec3 upOf(const SceneDescription& scene);
Vec3 sunOf(const SceneDescription& scene, const StageSettings& settings);

bool isFinite(const Pose& pose);

/// Where a plane's square stands and faces, in its asset frame.
PlaneSurface planeOf(const SceneMesh& mesh);

/// Columns: two directions along the plane, the first as close as can be to a world axis, with the
/// normal between them.
Mat3 planeAxes(const Vec3& normal);

/// The middle one of the radii of movable bodies, or of all when none moves; 1 for an empty scene.
/// `meshRadii` is parallel to scene.meshes, 0 for planes.
double typicalRadius(const SceneDescription& scene, const std::vector<double>& meshRadii);

/// The constants above for shaders, by the same names.
std::string lightConstantsInGlsl();

}  // namespace scree
