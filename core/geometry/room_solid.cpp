#include "core/geometry/room_solid.h"

#include <vector>

#include "core/base/error.h"
#include "core/geometry/mesh_defects.h"
#include "core/geometry/primitives.h"
#include "core/math/aabb.h"
#include "core/math/point_box.h"

namespace scree {
namespace {

constexpr double kWall = 0.1;  // of the longest edge

[[noreturn]] void refuse(const std::string& name, const std::string& why)
{
    throw Error(ErrorKind::badInput, "shape '" + name + "' makes no room: " + why);
}

}  // namespace

RoomSolid wallAround(const TriMesh& room, double wall, const std::string& name)
{
    if (signedVolume(room) > 0.0) {
        refuse(name,
               "its faces look outward, so that it is full; turn them round in the file, or leave "
               "'repair' out");
    }
    const Aabb inside = boxOf(room.points);
    RoomSolid solid{{}, wall > 0.0 ? wall : kWall * inside.longestEdge()};
    const Aabb outside = inside.grown(solid.wall);
    TriMesh box = makeBox(outside.max - outside.min, {1, 1, 1});
    box.points.colwise() += 0.5 * (outside.min + outside.max);
    box.triangles.array() += static_cast<int>(room.points.cols());
    solid.mesh.points.resize(3, room.points.cols() + box.points.cols());
    solid.mesh.points << room.points, box.points;
    solid.mesh.triangles.resize(3, room.triangles.cols() + box.triangles.cols());
    solid.mesh.triangles << room.triangles, box.triangles;

    const std::vector<MeshDefect> defects = findDefects(solid.mesh);
    if (!defects.empty()) {
        refuse(name, "with walls around it, it is no solid: " + describe(defects) +
                         "; mend the mesh there, or, of a room that is open, write mesh = { repair "
                         "= \"solidify\", thickness = … }");
    }
    return solid;
}

}  // namespace scree
