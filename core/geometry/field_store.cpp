#include "core/geometry/field_store.h"

#include "core/base/hash.h"

namespace scree {
namespace {

/// To be raised with every change of what is built from the same input.
constexpr std::uint64_t kBuildVersion = 4;

template <class Value>
std::uint64_t hashValue(const Value& value, std::uint64_t seed)
{
    return hashBytes(&value, sizeof value, seed);
}

}  // namespace

std::uint64_t fieldKey(const TriMesh& mesh, const NodeLayout& layout, FieldStorage storage)
{
    std::uint64_t key = hashValue(mesh.points.cols(), kBuildVersion);
    key = hashBytes(mesh.points.data(), sizeof(double) * mesh.points.size(), key);
    key = hashBytes(mesh.triangles.data(), sizeof(int) * mesh.triangles.size(), key);
    key = hashBytes(layout.origin.data(), 3 * sizeof(double), key);
    key = hashValue(layout.spacing, key);
    key = hashBytes(layout.count.data(), sizeof layout.count, key);
    return hashValue(static_cast<int>(storage), key);
}

}  // namespace scree
