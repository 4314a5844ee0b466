#include "core/geometry/shape_store.h"

#include "core/base/hash.h"

namespace scree {
namespace {

/// To be raised with every change of what is built from the same input.
constexpr std::uint64_t kBuildVersion = 5, kRepairVersion = 1;

template <class Value>
std::uint64_t hashValue(const Value& value, std::uint64_t seed)
{
    return hashBytes(&value, sizeof value, seed);
}

std::uint64_t hashMesh(const TriMesh& mesh, std::uint64_t version)
{
    std::uint64_t key = hashValue(mesh.points.cols(), version);
    key = hashBytes(mesh.points.data(), sizeof(double) * mesh.points.size(), key);
    return hashBytes(mesh.triangles.data(), sizeof(int) * mesh.triangles.size(), key);
}

}  // namespace

std::uint64_t fieldKey(const TriMesh& mesh, const NodeLayout& layout, FieldStorage storage)
{
    std::uint64_t key = hashMesh(mesh, kBuildVersion);
    key = hashBytes(layout.origin.data(), 3 * sizeof(double), key);
    key = hashValue(layout.spacing, key);
    key = hashBytes(layout.count.data(), sizeof layout.count, key);
    return hashValue(static_cast<int>(storage), key);
}

std::uint64_t solidKey(const TriMesh& mesh, const RemeshSettings& settings)
{
    std::uint64_t key = hashMesh(mesh, kRepairVersion);
    key = hashValue(static_cast<int>(settings.repair), key);
    key = hashValue(settings.thickness, key);
    return hashValue(settings.voxel, key);
}

}  // namespace scree
