#include "core/geometry/mesh_decimation.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModAspectRatioT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace scree {
namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using Halfedges = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;

/// Faces may not become slimmer than this (shortest height over longest edge), or turn by more
/// than the angle in one collapse [degrees]. Tuned on the three bones: looser, and the rims of
/// the eye sockets grow spikes.
constexpr double kSlimmest = 0.1;
constexpr double kLargestTurn = 45.0;

Halfedges toHalfedges(const TriMesh& mesh)
{
    Halfedges halfedges;
    std::vector<Halfedges::VertexHandle> handles;
    for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) {
        const Vec3 p = mesh.points.col(v);
        handles.push_back(halfedges.add_vertex({p.x(), p.y(), p.z()}));
    }
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const auto corner = [&](int k) { return handles[mesh.triangles(k, f)]; };
        if (!halfedges.add_face(corner(0), corner(1), corner(2)).is_valid()) {
            throw Error(ErrorKind::badInput, "triangle " + std::to_string(f) +
                                                 " of the mesh to decimate is not manifold");
        }
    }
    return halfedges;
}

TriMesh toTriMesh(const Halfedges& halfedges)
{
    TriMesh mesh;
    mesh.points.resize(3, static_cast<Eigen::Index>(halfedges.n_vertices()));
    for (const auto v : halfedges.vertices()) {
        const OpenMesh::Vec3d& p = halfedges.point(v);
        mesh.points.col(v.idx()) = Vec3(p[0], p[1], p[2]);
    }
    mesh.triangles.resize(3, static_cast<Eigen::Index>(halfedges.n_faces()));
    for (const auto f : halfedges.faces()) {
        int k = 0;
        for (const auto v : halfedges.fv_range(f)) mesh.triangles(k++, f.idx()) = v.idx();
    }
    return mesh;
}

/// Collapses edges by their quadric error, whatever else it is told to keep to.
class Decimation {
public:
    explicit Decimation(const TriMesh& mesh) : halfedges_(toHalfedges(mesh)), decimater_(halfedges_)
    {
        halfedges_.request_face_normals();
        halfedges_.update_face_normals();
        OpenMesh::Decimater::ModQuadricT<Halfedges>::Handle quadric;
        OpenMesh::Decimater::ModNormalFlippingT<Halfedges>::Handle flipping;
        OpenMesh::Decimater::ModAspectRatioT<Halfedges>::Handle aspect;
        decimater_.add(quadric);
        decimater_.add(flipping);
        decimater_.add(aspect);
        decimater_.module(quadric).unset_max_err();
        decimater_.module(flipping).set_max_normal_deviation(kLargestTurn);
        decimater_.module(aspect).set_aspect_ratio(1.0 / kSlimmest);
    }

    void stayWithin(double tolerance)
    {
        OpenMesh::Decimater::ModHausdorffT<Halfedges>::Handle hausdorff;
        decimater_.add(hausdorff);
        decimater_.module(hausdorff).set_tolerance(tolerance);
    }

    TriMesh downTo(std::size_t triangleCount)
    {
        decimater_.initialize();
        decimater_.decimate_to_faces(0, triangleCount);
        halfedges_.garbage_collection();
        return toTriMesh(halfedges_);
    }

private:
    Halfedges halfedges_;
    OpenMesh::Decimater::DecimaterT<Halfedges> decimater_;
};

}  // namespace

TriMesh decimated(const TriMesh& mesh, int triangleCount)
{
    const TriMesh few = Decimation(mesh).downTo(static_cast<std::size_t>(triangleCount));
    if (few.triangles.cols() != triangleCount) {
        throw Error(ErrorKind::badInput,
                    "decimation stops at " + std::to_string(few.triangles.cols()) +
                        " triangles instead of " + std::to_string(triangleCount));
    }
    return few;
}

TriMesh decimatedWithin(const TriMesh& mesh, double tolerance)
{
    Decimation decimation(mesh);
    decimation.stayWithin(tolerance);
    return decimation.downTo(0);
}

}  // namespace scree
