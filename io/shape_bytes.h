// What of a shape is kept on disk, as bytes: a mark, the version of the format, the key, arrays
// (count, then elements), and the hash of all before it. Equal things give equal bytes. What is not
// whole, not of this key or not written by this version is nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/geometry/distance_field.h"
#include "core/geometry/tri_mesh.h"

namespace scree {

/// Of the formats.
inline constexpr std::uint32_t kFieldVersion = 3, kSolidVersion = 1;

std::string bytesOfField(std::uint64_t key, const DistanceField& field);
std::optional<DistanceField> fieldOfBytes(std::uint64_t key, std::string_view bytes);

std::string bytesOfSolid(std::uint64_t key, const TriMesh& solid);
std::optional<TriMesh> solidOfBytes(std::uint64_t key, std::string_view bytes);

}  // namespace scree
