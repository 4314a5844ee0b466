// Where cameras of exports stand. A camera's own axes are those of USD, glTF and OpenGL: x to the
// right, y upwards, it looks along -z.
#pragma once

#include <vector>

#include "core/picture/scene_description.h"

namespace scree {

/// A camera that looks straight up or down, or nowhere, still gets an orthonormal frame.
Pose worldFromCamera(const SceneCamera& camera, bool zUp);

/// A camera at each of `times` [frames]: still, keyed or on an orbit.
std::vector<SceneCamera> camerasAt(const SceneCamera& camera, const std::vector<double>& times,
                                   bool zUp);

/// Where cameras stand, each orientation in the hemisphere of the one before, so that readers which
/// interpolate component by component go the short way.
std::vector<Pose> worldFromCameras(const std::vector<SceneCamera>& cameras, bool zUp);

/// For formats that cannot do without: a three-quarter view of all that moves in `frame`, or of
/// everything when nothing moves.
SceneCamera cameraOfAll(const SceneDescription& scene, const SceneFrame& frame);

}  // namespace scree
