// Pictures by rays: shadows with the sun's true penumbra and the sky light that really reaches a
// point, free of the rasteriser's maps. Slower, and better the more rays a pixel gets.
#pragma once

#include <memory>

#include "render/picture_engine.h"
#include "render/stage.h"

namespace scree {

struct TraceSettings : StageSettings {
    int samples = 8;          ///< paths a pixel [-]; few: grain in soft shadows; cost grows with it
    double sunDegrees = 2.0;  ///< the sun's width in the sky; the real one is half a degree wide
    double skyReach = 12.0;   ///< how far cover counts, in radii of a typical body [-]
};

/// All rays of a frame share its rows out among threadCount() threads.
class RayTracer : public PictureEngine {
public:
    /// `looks` is parallel to scene.bodies.
    RayTracer(const SceneDescription& scene, const std::vector<Look>& looks,
              const TraceSettings& settings = {});
    ~RayTracer() override;
    RayTracer(const RayTracer&) = delete;
    RayTracer& operator=(const RayTracer&) = delete;

    void setLooks(const std::vector<Look>& looks) override;
    Image draw(const SceneFrame& frame, const Camera& camera, int width, int height,
               int ofMix = 0) override;

private:
    class Tracer;
    std::unique_ptr<Tracer> tracer_;
};

}  // namespace scree
