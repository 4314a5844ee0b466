// A polygon mesh of an Alembic file as triangles. Part of reading one (alembic_import.h).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/geometry/tri_mesh.h"
#include "io/alembic_reader.h"

namespace scree {

/// The property of that name, if there is one.
std::optional<StoredProperty> find(const std::vector<StoredProperty>& properties,
                                   std::string_view name);

/// Whether points, corners or faces of a mesh change over time.
bool isDeforming(const AlembicReader& reader, const StoredObject& object);

/// Points as they stand in the file, polygons cut into triangles that are counter-clockwise seen
/// from outside. Throws Error{badInput} when the points move, and for what is no mesh.
TriMesh readAlembicMesh(const AlembicReader& reader, const StoredObject& object);

}  // namespace scree
