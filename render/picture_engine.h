// What draws pictures, whichever way. Engines differ in speed and finish; scene, camera, light and
// colours are the same.
#pragma once

#include <vector>

#include "core/picture/scene_description.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/look.h"

namespace scree {

/// Draws frames of one scene. A picture depends on scene, looks and the arguments alone: not on the
/// pictures before and not on the number of threads.
///
/// Planes (meshes of two triangles) are drawn as what they stand for, half spaces without end.
/// Bodies with a pose that is not finite are left out.
class PictureEngine {
public:
    virtual ~PictureEngine() = default;

    /// How bodies look from now on; parallel to the scene's bodies.
    virtual void setLooks(const std::vector<Look>& looks) = 0;

    /// One picture, the first or a later one of several to be mixed: where chance decides, it
    /// decides anew for each of these. One thread at a time; which thread does not matter. Throws
    /// Error{usage} for a size that cannot be drawn.
    virtual Image draw(const SceneFrame& frame, const Camera& camera, int width, int height,
                       int ofMix = 0) = 0;
};

}  // namespace scree
