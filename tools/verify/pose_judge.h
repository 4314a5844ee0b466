// A judge of poses that knows nothing of any solver: dense points on the faces of one mesh and the
// deepest of its edges, and how deep they lie in the other, by the closest of its triangles and,
// where that is no clear case, by solid angle. It reads what a take or a cache holds: meshes and
// poses.
#pragma once

#include <memory>
#include <vector>

#include "core/picture/scene_description.h"

namespace scree::verify {

struct Overlap {
    std::size_t a = 0, b = 0;  ///< bodies, a < b
    double depth = 0.0;        ///< of the deepest point found [m]
};

class PoseJudge {
public:
    /// Keeps what it needs of the meshes. Lengths of the scene are taken for metres.
    explicit PoseJudge(const SceneDescription& scene);
    ~PoseJudge();

    /// All pairs that overlap in a frame, in the order of their bodies. Pairs of bodies that
    /// neither move are left out. A mesh of two triangles is the ground below it.
    std::vector<Overlap> overlaps(const SceneFrame& frame) const;

    /// The depth of the deepest of them [m].
    double deepestOverlap(const SceneFrame& frame) const;

    /// How deep a point of the world lies in a body; 0 outside.
    double depthIn(const SceneFrame& frame, std::size_t body, const Vec3& point) const;

    /// Shortest edge of the mesh's box in the artist's axes [m].
    double shortestEdge(std::size_t body) const;

private:
    struct Solid;

    const Solid& solidOf(std::size_t body) const { return *solids_[meshOf_[body]]; }
    bool areNear(const SceneFrame& frame, std::size_t a, std::size_t b) const;
    double deepest(const SceneFrame& frame, std::size_t a, std::size_t b) const;

    std::vector<std::unique_ptr<Solid>> solids_;
    std::vector<std::size_t> meshOf_;
    std::vector<char> moves_;
};

}  // namespace scree::verify
