#include "io/shape_bytes.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/base/hash.h"
#include "io/byte_cursor.h"

namespace scree {
namespace {

struct Format {
    std::string_view mark;
    std::uint32_t version;
};
constexpr Format kFieldFormat = {"scree distance field\n", kFieldVersion};
constexpr Format kSolidFormat = {"scree repaired solid\n", kSolidVersion};

template <class Element>
void appendArray(std::string& bytes, std::span<Element> elements)
{
    appendBytes(bytes, static_cast<std::uint64_t>(elements.size()));
    bytes.append(reinterpret_cast<const char*>(elements.data()), elements.size_bytes());
}

struct CutShort {};

template <class Element>
std::vector<Element> takeArray(ByteCursor& cursor)
{
    const auto count = cursor.take<std::uint64_t>();
    cursor.require(count, sizeof(Element));
    std::vector<Element> elements(count);
    cursor.takeInto(std::span(elements));
    return elements;
}

/// Whether points have places in the lattice: divisions by the spacing stay finite, too.
bool isLattice(const NodeLayout& layout)
{
    for (const int count : layout.count) {
        if (count < 2) return false;
    }
    return std::isnormal(layout.spacing) && layout.spacing > 0.0 && layout.origin.allFinite() &&
           layout.last().allFinite();
}

/// Whether the layout has as many blocks as there are. The product is never formed: it can be more
/// than any number holds, and nothing may be made of that size before it is known to be right.
bool hasItsBlocks(const DistanceNodes& nodes)
{
    std::size_t left = nodes.blocks.size();
    for (const int count : blocksAlong(nodes.layout)) {
        if (left % static_cast<std::size_t>(count) != 0) return false;
        left /= static_cast<std::size_t>(count);
    }
    return left == 1;
}

/// Whether every index stays inside its array. Only the faces are not compared: how many there are
/// is known to who has the mesh.
bool isConsistent(const DistanceField& field)
{
    const DistanceNodes& nodes = field.nodes;
    const bool isDense = nodes.storage == FieldStorage::dense;
    if (!isDense && nodes.storage != FieldStorage::bricks) return false;
    if (!isLattice(nodes.layout) || !hasItsBlocks(nodes)) return false;
    if (isDense && nodes.values.size() != nodes.layout.nodeCount()) return false;
    constexpr std::size_t kBlockLists = kBlockCells * kBlockCells * kBlockCells;
    for (const FieldBlock& block : nodes.blocks) {
        const std::size_t own = block.isCoarse ? 8 : kBrickValues;
        if (!isDense && block.first + own > nodes.values.size()) return false;
        if (isDense && block.isCoarse) return false;
        if (block.candidates != FieldBlock::kNone &&
            block.candidates + kBlockLists >= field.nearest.start.size()) {
            return false;
        }
    }
    std::uint32_t last = 0;
    for (const std::uint32_t start : field.nearest.start) {
        if (start < last || start > field.nearest.faces.size()) return false;
        last = start;
    }
    return true;
}

std::optional<DistanceField> takeField(ByteCursor& cursor)
{
    NodeLayout layout;
    for (int axis = 0; axis < 3; ++axis) layout.origin[axis] = cursor.take<double>();
    layout.spacing = cursor.take<double>();
    for (int& count : layout.count) count = cursor.take<int>();
    DistanceField field;
    field.nodes.layout = layout;
    field.nodes.storage = static_cast<FieldStorage>(cursor.take<std::int32_t>());
    field.nodes.blocks = takeArray<FieldBlock>(cursor);
    field.nodes.values = takeArray<float>(cursor);
    field.nearest.start = takeArray<std::uint32_t>(cursor);
    field.nearest.faces = takeArray<ListedFace>(cursor);
    if (!cursor.isAtEnd() || !isConsistent(field)) return std::nullopt;
    field.nodes.blockCount = blocksAlong(layout);
    return field;
}

std::optional<TriMesh> takeSolid(ByteCursor& cursor)
{
    const auto points = takeArray<double>(cursor);
    const auto triangles = takeArray<int>(cursor);
    if (!cursor.isAtEnd() || points.size() % 3 != 0 || triangles.size() % 3 != 0)
        return std::nullopt;
    const auto pointCount = static_cast<int>(points.size() / 3);
    const auto isCorner = [&](int corner) { return corner >= 0 && corner < pointCount; };
    if (triangles.empty() || !std::ranges::all_of(triangles, isCorner) ||
        !std::ranges::all_of(points, [](double x) { return std::isfinite(x); })) {
        return std::nullopt;
    }
    return TriMesh{Eigen::Map<const Points>(points.data(), 3, pointCount),
                   Eigen::Map<const Triangles>(triangles.data(), 3,
                                               static_cast<Eigen::Index>(triangles.size() / 3))};
}

/// Between a mark and the hash of all before it: format, key, and what `append` adds.
template <class Append>
std::string wrapped(const Format& format, std::uint64_t key, const Append& append)
{
    std::string bytes(format.mark);
    appendBytes(bytes, format.version);
    appendBytes(bytes, key);
    append(bytes);
    appendBytes(bytes, hashText(bytes));
    return bytes;
}

/// What `take` takes from between mark and hash.
template <class What, class Take>
std::optional<What> unwrapped(const Format& format, std::uint64_t key, std::string_view bytes,
                              const Take& take)
{
    const std::string_view mark = format.mark;
    if (!bytes.starts_with(mark) || bytes.size() < mark.size() + sizeof(std::uint64_t))
        return std::nullopt;
    const std::string_view hashed = bytes.substr(0, bytes.size() - sizeof(std::uint64_t));
    if (readBytes<std::uint64_t>(bytes, hashed.size()) != hashText(hashed)) return std::nullopt;
    try {
        ByteCursor cursor(hashed.substr(mark.size()), [] { throw CutShort(); });
        if (cursor.take<std::uint32_t>() != format.version) return std::nullopt;
        if (cursor.take<std::uint64_t>() != key) return std::nullopt;
        return take(cursor);
    } catch (const CutShort&) {
        return std::nullopt;
    }
}

}  // namespace

std::string bytesOfField(std::uint64_t key, const DistanceField& field)
{
    return wrapped(kFieldFormat, key, [&](std::string& bytes) {
        const NodeLayout& layout = field.nodes.layout;
        for (int axis = 0; axis < 3; ++axis) appendBytes(bytes, layout.origin[axis]);
        appendBytes(bytes, layout.spacing);
        for (const int count : layout.count) appendBytes(bytes, count);
        appendBytes(bytes, static_cast<std::int32_t>(field.nodes.storage));
        appendArray(bytes, std::span(field.nodes.blocks));
        appendArray(bytes, std::span(field.nodes.values));
        appendArray(bytes, std::span(field.nearest.start));
        appendArray(bytes, std::span(field.nearest.faces));
    });
}

std::optional<DistanceField> fieldOfBytes(std::uint64_t key, std::string_view bytes)
{
    return unwrapped<DistanceField>(kFieldFormat, key, bytes, takeField);
}

std::string bytesOfSolid(std::uint64_t key, const TriMesh& solid)
{
    return wrapped(kSolidFormat, key, [&](std::string& bytes) {
        appendArray(bytes, std::span(solid.points.data(), solid.points.size()));
        appendArray(bytes, std::span(solid.triangles.data(), solid.triangles.size()));
    });
}

std::optional<TriMesh> solidOfBytes(std::uint64_t key, std::string_view bytes)
{
    return unwrapped<TriMesh>(kSolidFormat, key, bytes, takeSolid);
}

}  // namespace scree
