// Depths seen along one direction, by a scan converter of our own. The lights' maps need nothing
// but depths, and for those OpenGL in software is a detour: it sorts every triangle into tiles and
// runs shaders over it, which takes several times as long (320 000 triangles of 1000 rings: 105
// ms).
#pragma once

#include <vector>

#include "core/picture/shaded_mesh.h"
#include "render/view_fit.h"

namespace scree {

/// Rows run upwards, as in OpenGL's textures. 0 is at the light, 1 as far away as the map reaches
/// and where nothing is.
struct DepthMap {
    int size = 0;               // texels along an edge
    std::vector<float> depths;  // size × size
};

/// No map is smaller: rows are drawn in blocks of so many texels.
inline constexpr int kFewestMapTexels = 8;

/// A map of that size with nothing in it.
void clearDepths(DepthMap& map, int size);

/// Draws one body; of a closed mesh only the sides that face the light. `clipFromAsset` may be a
/// camera's projection if all of the body is before the camera. Each triangle is pushed away by
/// `slopeBias` times the depth it spans over a texel, against surfaces that shade themselves. False
/// if the body is outside of the map, or farther than every texel around its image: then it would
/// change nothing, and is not drawn.
bool drawDepths(DepthMap& map, const ShadedMesh& mesh, const Mat4& clipFromAsset, double slopeBias);

/// Draws an infinite plane that faces the light; any other is left out.
void drawPlaneDepths(DepthMap& map, const PlaneSurface& plane, const Mat4& clipFromWorld);

/// Least and greatest depth of every tile of a map and the tiles around it: where a point is nearer
/// than the least or farther than the greatest, no texel within a tile's length needs to be asked.
struct DepthBounds {
    static constexpr int kTileTexels = 8;

    int size = 0;               // tiles along an edge
    std::vector<float> values;  // size × size × 2: least, greatest
};

DepthBounds boundDepths(const DepthMap& map);

/// Means of depth and of its square around every texel (Gaussian, 2.2 taps wide, `stride` texels
/// from tap to tap): what variance shadow maps [DL06] are read from.
struct DepthMoments {
    int size = 0;
    std::vector<float> values;  // size × size × 2: mean, mean of squares
};

/// Moments without a blur.
DepthMoments momentsOf(const DepthMap& map);

DepthMoments blurred(const DepthMoments& moments, int stride);

}  // namespace scree
