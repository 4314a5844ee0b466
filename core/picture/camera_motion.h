// Where a camera stands that is keyed or goes around something.
#pragma once

#include "core/picture/scene_description.h"

namespace scree {

/// Whether it ever moves or zooms.
bool moves(const SceneCamera& camera);

/// The camera as it is at a moment [frames, with fraction], without keys or orbit. It rests before
/// its first key and after its last.
SceneCamera cameraAt(const SceneCamera& camera, double frame, bool zUp);

/// Which way is up in the camera's picture: its own `up`, else the scene's.
Vec3 upOf(const SceneCamera& camera, bool zUp);

/// Right, up and backward of a camera, as columns. One that looks along `up`, or nowhere (eye equal
/// to target), still gets an orthonormal frame.
Mat3 worldFromViewAxes(const Vec3& eye, const Vec3& target, const Vec3& up);

/// The same in another unit: all lengths times `factor`.
SceneCamera scaled(const SceneCamera& camera, double factor);

}  // namespace scree
