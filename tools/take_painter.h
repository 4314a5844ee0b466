// Take → pictures: looks from the take's materials, a camera by name or one that sees everything.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "io/take_reader.h"
#include "render/camera.h"
#include "render/rasterizer.h"

namespace scree {

class TakePainter {
public:
    /// `cameraName` empty: the shot's first camera, or without one a view of all the movable bodies
    /// do in `frames`. Throws Error{usage} for a name that the take does not have.
    TakePainter(const TakeReader& take, const std::vector<int>& frames,
                const std::string& cameraName, const std::array<int, 2>& size);

    /// `burnedIn` is written into the lower left corner; empty for none.
    Image paint(int frame, const std::string& burnedIn = "");

private:
    const TakeReader& take_;
    SceneDescription scene_;
    Camera camera_;
    std::array<int, 2> size_;
    std::unique_ptr<Rasterizer> rasterizer_;
};

}  // namespace scree
