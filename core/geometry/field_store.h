// A distance field as data, and where finished ones may be kept between runs. Core opens no files:
// who has a disk implements the store.
#pragma once

#include <cstdint>
#include <optional>

#include "core/geometry/distance_nodes.h"
#include "core/geometry/nearest_faces.h"

namespace scree {

/// All of a field that takes time to build.
struct DistanceField {
    DistanceNodes nodes;
    NearestFaces nearest;
};

class FieldStore {
public:
    virtual ~FieldStore() = default;
    /// The field kept under `key`, if it is there and sound in itself. Who asks looks whether it
    /// fits the mesh.
    virtual std::optional<DistanceField> find(std::uint64_t key) = 0;
    virtual void keep(std::uint64_t key, const DistanceField& field) = 0;
};

/// Names a field by all that it is built from: mesh, lattice, storage, and the version of the
/// building code.
std::uint64_t fieldKey(const TriMesh& mesh, const NodeLayout& layout, FieldStorage storage);

}  // namespace scree
