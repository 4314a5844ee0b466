// Rays and closest points on a mesh, by Embree. It answers with triangles; positions and normals
// are computed here in double precision, so that single precision only ever decides ties.  [A6]
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/tri_mesh.h"

namespace scree {

class SurfaceRays {
public:
    SurfaceRays();
    /// Keeps its own copy of what it needs of the mesh. The build is single-threaded and uses one
    /// instruction set on every machine, for equal bits.
    explicit SurfaceRays(const TriMesh& mesh);
    ~SurfaceRays();
    SurfaceRays(SurfaceRays&&) noexcept;
    SurfaceRays& operator=(SurfaceRays&&) noexcept;

    enum class Facing { any, along, against };  ///< sign of (triangle normal · ray direction)

    struct Hit {
        int triangle = -1;
        double distance = 0.0;  ///< along the unit direction [m]
    };

    /// The first triangle within `reach` that faces as asked.
    std::optional<Hit> firstHit(const Vec3& origin, const Vec3& direction, double reach,
                                Facing facing) const;

    /// Index of the triangle closest to `point`. Something must lie within `reach` [m]; the closer
    /// it is to the answer, the shorter the search.
    int closestTriangle(const Vec3& point,
                        double reach = std::numeric_limits<double>::infinity()) const;

    /// Indices of the triangles within `reach` [m] of `point`, ascending; a few that are a hair
    /// farther may be among them.
    void trianglesWithin(const Vec3& point, double reach, std::vector<int>& triangles) const;

private:
    struct Scene;
    std::unique_ptr<Scene> scene_;
};

}  // namespace scree
