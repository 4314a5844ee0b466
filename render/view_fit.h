// How much of the scene a picture or a map seen from a light has to hold. Everything is measured
// with balls around bodies: generous, cheap and the same for all meshes.
#pragma once

#include <vector>

#include "core/math/ball.h"
#include "render/camera.h"

namespace scree {

/// Surface of an infinite half space; the normal points out of the solid.
struct PlaneSurface {
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::UnitY();
};

/// The tightest depths that cut off neither a body nor a plane nearer than `reach`. Depth precision
/// is spent on what is there: touching bodies in a heap must not flicker through each other.
DepthRange fitDepth(const Camera& camera, double aspect, const std::vector<Ball>& bodies,
                    const std::vector<PlaneSurface>& planes, double reach);

/// The eight corners of what the camera sees, as columns.
Points visibleCorners(const Camera& camera, double aspect, const DepthRange& range);

/// A square map of depths, seen from far away along one direction (a light's or the sky's).
struct DepthMapFit {
    Mat4 clipFromWorld = Mat4::Identity();
    double texel = 0.0;  ///< edge length on the ground of one texel
    double depth = 0.0;  ///< distance between depth 0 and depth 1
    int size = 1;        ///< texels along an edge
};

/// A map that holds every caster that can darken something the camera sees. The map has texels of
/// `wantedTexel` or of whatever length `mostTexels` of them can cover everything with; its size
/// grows in steps and its texels stay where they are in the world, so that shadows do not crawl
/// while the heap changes shape. `margin` and at least a texel are kept free
/// around the casters, but to the sides where the picture ends before them.
DepthMapFit fitDepthMap(const Vec3& towardLight, const std::vector<Ball>& casters,
                        const Points& visible, double margin, double wantedTexel, int mostTexels);

}  // namespace scree
