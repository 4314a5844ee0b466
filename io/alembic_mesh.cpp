#include "io/alembic_mesh.h"

#include <algorithm>
#include <cstring>

#include "io/face_cut.h"

namespace scree {

namespace {

constexpr std::uint32_t kMostCorners = 150'000'000;

class MeshReader {
public:
    MeshReader(const AlembicReader& reader, const StoredObject& object)
        : reader_(reader), name_(object.name)
    {
        const auto geometry = find(reader.properties(object), ".geom");
        if (!geometry) refuse("is empty");
        properties_ = reader.properties(*geometry);
    }

    TriMesh read()
    {
        readPoints();
        corners_ = arrayOf<std::int32_t>(required(".faceIndices"), AlembicType::i32, 1);
        faceSizes_ = arrayOf<std::int32_t>(required(".faceCounts"), AlembicType::i32, 1);
        readUvs();
        cutFaces();

        TriMesh mesh;
        mesh.points = points_;
        const auto count = static_cast<Eigen::Index>(cut_.size() / 3);
        mesh.triangles.resize(3, count);
        if (!uvs_.empty()) mesh.cornerUvs.resize(2, 3 * count);
        for (Eigen::Index k = 0; k < 3 * count; ++k) {
            const std::size_t corner = cut_[static_cast<std::size_t>(k)];
            mesh.triangles.data()[k] = corners_[corner];
            if (!uvs_.empty()) mesh.cornerUvs.col(k) = uvs_[corner];
        }
        return mesh;
    }

private:
    void readPoints()
    {
        const auto numbers = arrayOf<float>(required("P"), AlembicType::f32, 3);
        points_.resize(3, static_cast<Eigen::Index>(numbers.size() / 3));
        // Adding zero turns -0 into +0: the two are one point but not the same bits.
        for (std::size_t i = 0; i < numbers.size(); ++i) points_.data()[i] = numbers[i] + 0.0;
        if (!points_.allFinite()) refuse("has coordinates that are not finite");
    }

    /// One for every corner of the file's faces, or none: with an index or without, for corners or
    /// for points.
    void readUvs()
    {
        const auto property = find(properties_, "uv");
        if (!property) return;
        const bool isIndexed = property->layout.kind == AlembicKind::compound;
        const std::vector<StoredProperty> parts = reader_.properties(*property);
        const auto values = isIndexed ? find(parts, ".vals") : property;
        if (!values || values->sampleCount == 0) return;
        const auto numbers = arrayOf<float>(*values, AlembicType::f32, 2);
        std::vector<std::uint32_t> order;
        if (const auto indices = find(parts, ".indices")) {
            order = arrayOf<std::uint32_t>(*indices, AlembicType::u32, 1);
        } else {
            for (std::uint32_t i = 0; i < numbers.size() / 2; ++i) order.push_back(i);
        }

        const std::string_view scope = metadataValue(property->layout.metadata, "geoScope");
        const bool isPerPoint = scope == "vtx" || scope == "var";
        const std::size_t expected =
            isPerPoint ? static_cast<std::size_t>(points_.cols()) : corners_.size();
        if (order.size() != expected) refuse("has texture coordinates for other corners");
        for (std::size_t k = 0; k < corners_.size(); ++k) {
            const std::size_t at = 2 * std::size_t{order[isPerPoint ? pointAt(k) : k]};
            if (at >= numbers.size()) refuse("has texture coordinates that are not there");
            uvs_.emplace_back(numbers[at], numbers[at + 1]);
            if (!uvs_.back().allFinite()) refuse("has texture coordinates that are not finite");
        }
    }

    void cutFaces()
    {
        std::size_t first = 0;
        for (const std::int32_t size : faceSizes_) {
            if (size < 0 || static_cast<std::size_t>(size) > corners_.size() - first) {
                refuse("has faces with more corners than there are");
            }
            addFace(first, static_cast<std::size_t>(size));
            first += static_cast<std::size_t>(size);
        }
    }

    /// Alembic's faces are clockwise seen from outside, so they are walked backwards.
    void addFace(std::size_t first, std::size_t size)
    {
        if (size < 3) return;  // loose points and lines have no surface
        const auto corner = [&](int k) { return first + size - 1 - static_cast<std::size_t>(k); };
        if (size == 3) {
            for (int k = 0; k < 3; ++k) cut_.push_back(corner(k));
            return;
        }
        Points around(3, static_cast<Eigen::Index>(size));
        for (int k = 0; k < static_cast<int>(size); ++k)
            around.col(k) = points_.col(pointAt(corner(k)));
        for (const int k : cutFace(around)) cut_.push_back(corner(k));
    }

    Eigen::Index pointAt(std::size_t corner) const
    {
        const std::int32_t point = corners_[corner];
        if (point < 0 || point >= points_.cols()) {
            refuse("has a face with a corner that is no point");
        }
        return point;
    }

    StoredProperty required(const char* name) const
    {
        const auto property = find(properties_, name);
        if (!property || property->sampleCount == 0) refuse("has no " + std::string(name));
        if (property->firstChange > 0) {
            refuse("changes its shape over time; only rigid motion can be played");
        }
        return *property;
    }

    template <class Number>
    std::vector<Number> arrayOf(const StoredProperty& property, AlembicType type, int extent) const
    {
        if (property.layout.kind == AlembicKind::compound || property.layout.type != type ||
            property.layout.extent != extent) {
            refuse("has " + property.layout.name + " of a kind that cannot be read");
        }
        const std::string_view bytes = reader_.sample(property, 0);
        const std::size_t valueBytes = sizeof(Number) * static_cast<std::size_t>(extent);
        if (bytes.size() % valueBytes != 0) refuse("is damaged: half a number");
        if (bytes.size() / sizeof(Number) > kMostCorners) refuse("is too large");
        std::vector<Number> numbers(bytes.size() / sizeof(Number));
        if (!bytes.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
        return numbers;
    }

    [[noreturn]] void refuse(const std::string& why) const
    {
        reader_.refuse("has a mesh '" + name_ + "' that " + why);
    }

    const AlembicReader& reader_;
    std::string name_;
    std::vector<StoredProperty> properties_;
    Points points_;
    std::vector<std::int32_t> corners_, faceSizes_;  // points of corners, corners of faces
    std::vector<Eigen::Vector2f> uvs_;               // parallel to corners_, or empty
    std::vector<std::size_t> cut_;                   // into corners_, three for each triangle
};

}  // namespace

std::optional<StoredProperty> find(const std::vector<StoredProperty>& properties,
                                   std::string_view name)
{
    for (const StoredProperty& property : properties) {
        if (property.layout.name == name) return property;
    }
    return std::nullopt;
}

bool isDeforming(const AlembicReader& reader, const StoredObject& object)
{
    const auto geometry = find(reader.properties(object), ".geom");
    if (!geometry) return false;
    const std::vector<StoredProperty> properties = reader.properties(*geometry);
    return std::any_of(properties.begin(), properties.end(), [](const StoredProperty& property) {
        const std::string& name = property.layout.name;
        const bool isShape = name == "P" || name == ".faceIndices" || name == ".faceCounts";
        return isShape && property.firstChange > 0;
    });
}

TriMesh readAlembicMesh(const AlembicReader& reader, const StoredObject& object)
{
    return MeshReader(reader, object).read();
}

}  // namespace scree
