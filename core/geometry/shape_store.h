// What of a shape takes time to make may be kept between runs. Core opens no files: who has a disk
// implements the store.
#pragma once

#include <cstdint>
#include <optional>

#include "core/geometry/distance_field.h"
#include "core/geometry/level_set_remesh.h"

namespace scree {

class ShapeStore {
public:
    virtual ~ShapeStore() = default;
    /// The field kept under `key`, if it is there and sound in itself. Who asks looks whether it
    /// fits the mesh.
    virtual std::optional<DistanceField> findField(std::uint64_t key) = 0;
    virtual void keepField(std::uint64_t key, const DistanceField& field) = 0;
    /// The same of the solid that a repair has made: its triangles are of points it has.
    virtual std::optional<TriMesh> findSolid(std::uint64_t key) = 0;
    virtual void keepSolid(std::uint64_t key, const TriMesh& solid) = 0;
};

/// Names a field by all that it is built from: mesh, lattice, storage, and the version of the
/// building code.
std::uint64_t fieldKey(const TriMesh& mesh, const NodeLayout& layout, FieldStorage storage);

/// The same of what remeshSolid makes of a mesh.
std::uint64_t solidKey(const TriMesh& mesh, const RemeshSettings& settings);

}  // namespace scree
