// Pictures of a scene without a display: OpenGL in software, off-screen.
#pragma once

#include <memory>
#include <vector>

#include "core/scene/scene_description.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/look.h"

namespace scree {

/// Quality against time. Sizes are upper limits; memory follows the largest picture drawn.
struct RasterSettings {
    int samples = 1;          ///< a pixel, 1 or 4 [-]: 4 also smooths what is inside of surfaces,
                              ///< and takes twice as long
    bool smoothEdges = true;  ///< with one sample: stairs are straightened (edge_smoothing.h)
    int shadowTexels = 1536;  ///< along an edge of the sun's map; fewer: coarse, softer shadows
    int skyTexels = 512;      ///< along an edge of the sky's map, for light between bodies
    bool groundLines = true;  ///< a faint grid on planes, to judge distances by
    /// Direction to the sun, with +y up; turned for scenes whose up axis is z.
    Vec3 towardSun = {-0.30, 0.80, 0.55};
};

/// Draws frames of one scene. A picture depends on its arguments alone: not on the pictures before
/// and not on the number of threads, which is threadCount() when the first Rasterizer of the
/// process is made, unless the environment says otherwise (LP_NUM_THREADS).
///
/// Planes (meshes of two triangles) are drawn as what they stand for, half spaces without end.
/// Bodies with a pose that is not finite are left out.
class Rasterizer {
public:
    /// `looks` is parallel to scene.bodies. Throws Error{internal} when there is no OpenGL 3.3.
    Rasterizer(const SceneDescription& scene, const std::vector<Look>& looks,
               const RasterSettings& settings = {});
    ~Rasterizer();
    Rasterizer(const Rasterizer&) = delete;
    Rasterizer& operator=(const Rasterizer&) = delete;

    /// One picture. One thread at a time; which thread does not matter.
    Image draw(const SceneFrame& frame, const Camera& camera, int width, int height);

private:
    class Context;
    std::unique_ptr<Context> context_;
};

}  // namespace scree
