// Where cameras of exports stand. A camera's own axes are those of USD, glTF and OpenGL: x to the
// right, y upwards, it looks along -z.
#pragma once

#include "core/scene/scene_description.h"

namespace scree {

/// A camera that looks straight up or down, or nowhere, still gets an orthonormal frame.
Pose worldFromCamera(const SceneCamera& camera, bool zUp);

/// For formats that cannot do without: a three-quarter view of all that moves in `frame`, or of
/// everything when nothing moves.
SceneCamera cameraOfAll(const SceneDescription& scene, const SceneFrame& frame);

}  // namespace scree
