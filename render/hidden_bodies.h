// Bodies that cannot be seen, from the camera or from a light, because others lie before them. In a
// heap that is every second one, and neither our own scan converter nor OpenGL finds out before it
// has been through all of a body's triangles.
#pragma once

#include <cstddef>
#include <vector>

#include "core/picture/shaded_mesh.h"
#include "render/depth_map.h"
#include "render/view_fit.h"

namespace scree {

/// A body where it stands.
struct PlacedMesh {
    const ShadedMesh* mesh = nullptr;
    Pose worldFromAsset;
};

/// Draws bodies into the map from near to far. `balls` is parallel to `bodies`, both in the same
/// axes; `clipFromWorld` is a parallel projection or a camera's. Returns the places in `bodies` of
/// those that are neither outside of the map nor wholly behind what was drawn before them, from
/// near to far. A body that reaches behind the camera is not drawn, but returned.
std::vector<std::size_t> drawNearToFar(DepthMap& map, const std::vector<PlacedMesh>& bodies,
                                       const std::vector<Ball>& balls, const Mat4& clipFromWorld,
                                       double slopeBias);

/// The square map whose lower left texels are the points of a picture of that size, and the
/// projection into it.
struct PictureMap {
    int size = 0;
    Mat4 clipFromWorld = Mat4::Identity();
};

PictureMap mapOfPicture(const Mat4& clipFromWorld, int width, int height);

}  // namespace scree
