// Pictures of a scene without a display: OpenGL in software, off-screen.
#pragma once

#include <memory>
#include <vector>

#include "render/picture_engine.h"
#include "render/stage.h"

namespace scree {

/// Quality against time. Sizes are upper limits; memory follows the largest picture drawn.
struct RasterSettings : StageSettings {
    int samples = 1;          ///< a pixel, 1 or 4 [-]: 4 also smooths what is inside of surfaces,
                              ///< and takes twice as long
    bool smoothEdges = true;  ///< with one sample: stairs are straightened (edge_smoothing.h)
    int shadowTexels = 1536;  ///< along an edge of the sun's map; fewer: coarse, softer shadows
    int skyTexels = 512;      ///< along an edge of the sky's map, for light between bodies
};

/// The number of threads is threadCount() when the first Rasterizer of the process is made, unless
/// the environment says otherwise (LP_NUM_THREADS). Several may be used at once, each in a
/// thread of its own: OpenGL draws for one at a time, all else they do side by side.
class Rasterizer : public PictureEngine {
public:
    /// `looks` is parallel to scene.bodies. Throws Error{internal} when there is no OpenGL 3.3.
    Rasterizer(const SceneDescription& scene, const std::vector<Look>& looks,
               const RasterSettings& settings = {});
    ~Rasterizer() override;
    Rasterizer(const Rasterizer&) = delete;
    Rasterizer& operator=(const Rasterizer&) = delete;

    void setLooks(const std::vector<Look>& looks) override;
    Image draw(const SceneFrame& frame, const Camera& camera, int width, int height,
               int ofMix = 0) override;

private:
    class Context;
    std::unique_ptr<Context> context_;
};

}  // namespace scree
