// Take → pictures: looks (take_looks.h), a camera by name or one that sees everything, motion blur
// from the take's sub-frame samples.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "io/take_reader.h"
#include "render/camera.h"
#include "render/picture_engine.h"
#include "tools/take_looks.h"

namespace scree {

struct PaintSettings {
    bool isRayTraced = false;  ///< Embree instead of OSMesa
    int samples = 0;           ///< a pixel [-]; 0: as the engine likes
    LookKind look = LookKind::shaded;
    int motionBlur = 0;  ///< moments a picture is the mean of [-]; below 2: no blur
};

/// A camera that sees all that movable bodies do in the take, or all bodies when none moves; it
/// never cuts anything off. For shots that have no camera.
SceneCamera viewOfAction(const TakeReader& take, const SceneDescription& scene, double aspect);

class TakePainter {
public:
    /// `cameraName` empty: the shot's first camera, or without one viewOfAction(). Throws
    /// Error{usage} for a name that the take does not have.
    TakePainter(const TakeReader& take, const std::string& cameraName,
                const std::array<int, 2>& size, const PaintSettings& settings = {});

    /// `burnedIn` is written into the lower left corner; empty for none. Several threads may paint
    /// at once; each then has an engine of its own.
    Image paint(int frame, const std::string& burnedIn = "");

    /// What of the picture of a frame the whole take decides, in words: where a view of the action
    /// stands, and how far the scale of a look reaches. While a take grows they change.
    std::string viewAt(int frame) const;

    /// Those that are there: without who has not been born yet.
    std::size_t bodyCountAt(int frame) const;

    /// How many threads painting at once are worth it: ray tracing shares its rows out by itself.
    int usefulThreads() const;

private:
    class BorrowedEngine;

    std::unique_ptr<PictureEngine> makeEngine() const;
    Camera cameraAtFrame(double frame) const;
    Image drawBlurred(PictureEngine& engine, int frame) const;

    const TakeReader& take_;
    SceneDescription scene_;
    SceneCamera camera_;
    std::array<int, 2> size_;
    PaintSettings settings_;
    TakeLooks looks_;
    std::mutex engineLock_;
    std::vector<std::unique_ptr<PictureEngine>> freeEngines_;
};

}  // namespace scree
