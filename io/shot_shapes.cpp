#include "io/shot_shapes.h"

#include "io/file_bytes.h"
#include "io/shot_values.h"

namespace scree {
namespace {

std::string wordOf(const ShotNode& node, const char* key)
{
    const ShotNode* value = node.find(key);
    return value ? value->text : "";
}

void readField(const ShotNode& sdf, double metresPerUnit, ShapeSettings& settings)
{
    if (const ShotNode* resolution = sdf.find("resolution")) {
        settings.resolution = static_cast<int>(resolution->integer);
    }
    if (const ShotNode* voxel = sdf.find("voxel")) {
        settings.voxel = voxel->number * metresPerUnit;
    }
    const std::string storage = wordOf(sdf, "storage");
    settings.storage = storage == "dense"    ? FieldStorage::dense
                       : storage == "bricks" ? FieldStorage::bricks
                                             : FieldStorage::automatic;
}

void readRepair(const ShotNode& mesh, double metresPerUnit, ShapeSettings& settings,
                ProblemList& problems)
{
    const ShotNode* repair = mesh.find("repair");
    const ShotNode* thickness = mesh.find("thickness");
    const std::string asked = wordOf(mesh, "repair");
    settings.repair = asked == "shell"      ? MeshRepair::shell
                      : asked == "ground"   ? MeshRepair::ground
                      : asked == "room"     ? MeshRepair::room
                      : asked == "solidify" ? MeshRepair::solidify
                      : asked == "wrap"     ? MeshRepair::wrap
                                            : MeshRepair::none;
    const bool needsThickness =
        settings.repair == MeshRepair::shell || settings.repair == MeshRepair::solidify;
    if (needsThickness && !mesh.mentions("thickness")) {
        problems.add(repair->where, "\"" + asked + "\" needs a 'thickness'");
    }
    const bool hasThickness =
        settings.repair != MeshRepair::none && settings.repair != MeshRepair::wrap;
    if (!hasThickness && thickness && !mesh.isUnclear("repair")) {
        problems.add(thickness->where,
                     "only \"shell\", \"ground\", \"room\" and \"solidify\" have a 'thickness'");
    }
    if (thickness) settings.repairThickness = thickness->number * metresPerUnit;
}

class ShapeReader {
public:
    ShapeReader(const std::filesystem::path& folder, bool isStrict, Shot& shot,
                ProblemList& problems)
        : folder_(folder), isStrict_(isStrict), shot_(shot), problems_(problems)
    {
    }

    std::vector<std::string> read(const ShotNode* table)
    {
        if (!table) return {};
        std::vector<std::string> names;
        for (const ShotEntry& entry : table->entries) {
            names.push_back(entry.key);
            if (!entry.isValid) continue;
            ShotShape shape;
            shape.name = entry.key;
            shape.location = entry.where;
            readShapeSource(entry, shape);
            const ShotNode& scale = *entry.node.find("scale");
            shape.scale =
                scale.kind == ShotNode::Kind::list ? toVec3(scale) : Vec3::Constant(scale.number);
            shape.settings =
                readShapeSettings(entry.node, isStrict_, shot_.metresPerUnit, problems_);
            readCollide(entry.node, shape);
            readCollisionMesh(entry.node, shape);
            shot_.shapes.push_back(shape);
        }
        return names;
    }

private:
    void readShapeSource(const ShotEntry& entry, ShotShape& shape)
    {
        const ShotNode& node = entry.node;
        const auto length = [&](const ShotNode& table, const char* key) {
            return table.find(key)->number * shot_.metresPerUnit;
        };
        const auto whole = [](const ShotNode& table, const char* key) {
            return static_cast<int>(table.find(key)->integer);
        };
        if (const ShotNode* torus = node.find("torus")) {
            const TorusSpec spec{length(*torus, "major"), length(*torus, "minor"),
                                 toInts<2>(*torus->find("segments"))};
            if (spec.minor >= spec.major) {
                report(*torus->find("minor"),
                       "'minor' must be less than 'major', or the ring has "
                       "no hole");
            }
            shape.source = spec;
        } else if (const ShotNode* box = node.find("box")) {
            shape.source = BoxSpec{toVec3(*box->find("size")) * shot_.metresPerUnit,
                                   toInts<3>(*box->find("segments"))};
        } else if (const ShotNode* sphere = node.find("sphere")) {
            shape.source = SphereSpec{length(*sphere, "radius"), whole(*sphere, "subdivisions")};
        } else if (const ShotNode* cylinder = node.find("cylinder")) {
            shape.source = CylinderSpec{length(*cylinder, "radius"), length(*cylinder, "height"),
                                        whole(*cylinder, "sectors"), whole(*cylinder, "bands")};
        } else if (const ShotNode* capsule = node.find("capsule")) {
            shape.source = CapsuleSpec{length(*capsule, "radius"), length(*capsule, "height"),
                                       whole(*capsule, "sectors"), whole(*capsule, "rings")};
        } else if (const ShotNode* file = node.find("file")) {
            shape.source = FileSpec{reachable(*file)};
        } else if (!mentionsAny(node, {"torus", "box", "sphere", "cylinder", "capsule", "file"})) {
            problems_.add(entry.where, "[shape." + entry.key +
                                           "] says nothing of its form; give it "
                                           "torus, box, sphere, cylinder, capsule or file");
        }
    }

    /// A formula stands for few solids, and has neither field nor normals to choose.
    void readCollide(const ShotNode& node, ShotShape& shape)
    {
        const ShotNode& collide = *node.find("collide");
        shape.isExact = collide.text == "exact";
        if (!shape.isExact) return;
        if (mentionsAny(node, {"torus", "capsule", "file"})) {
            report(collide,
                   "collide = \"exact\" is for a sphere, box or cylinder; anything else "
                   "collides as its mesh");
        }
        const Vec3& scale = shape.scale;
        const bool isRound = node.mentions("sphere") || node.mentions("cylinder");
        const bool isUneven =
            scale.x() != scale.z() || (node.mentions("sphere") && scale.x() != scale.y());
        if (isRound && isUneven) {
            report(*node.find("scale"), "'scale' must keep the circles of an exact shape round");
        }
        const ShotNode* sdf = node.find("sdf");
        if (sdf || node.find("field")->text == "grid") {
            report(sdf ? *sdf : *node.find("field"),
                   "a shape that collides as \"exact\" has no sampled field");
        }
        if (node.find("normals")->text != "auto") {
            report(*node.find("normals"), "a shape that collides as \"exact\" has exact normals");
        }
        const ShotNode* mesh = node.find("mesh");
        if (mesh && mesh->find("repair")->text != "none") {
            report(*mesh, "a shape that collides as \"exact\" needs no repair of its mesh");
        }
        const ShotNode* collision = node.find("collision");
        if (collision) {
            report(*collision, "a shape that collides as \"exact\" has no mesh to collide as");
        }
        const ShotNode* edges = node.find("edge_samples");
        if (isRound && edges) {
            report(*edges, "an exact sphere or cylinder is not sampled by the edges of its mesh");
        }
    }

    void readCollisionMesh(const ShotNode& node, ShotShape& shape)
    {
        const ShotNode* collision = node.find("collision");
        const ShotNode* file = collision ? collision->find("file") : nullptr;
        if (file) shape.collision = FileSpec{reachable(*file)};
    }

    /// The path of a mesh, and a report when the system says nothing of what is there. That it is
    /// there, and what it holds, is asked when the world is built.
    std::string reachable(const ShotNode& file)
    {
        const std::string path = besideShot(file.text);
        if (const std::string obstacle = obstacleTo(path); !obstacle.empty()) {
            problems_.add(file.where, "mesh file '" + path + "' cannot be reached: " + obstacle,
                          ErrorKind::missingInput);
        }
        return path;
    }

    std::string besideShot(const std::string& file) const
    {
        return (folder_ / file).lexically_normal().string();
    }

    void report(const ShotNode& node, const std::string& message)
    {
        problems_.add(node.where, message);
    }

    const std::filesystem::path& folder_;
    bool isStrict_;
    Shot& shot_;
    ProblemList& problems_;
};

}  // namespace

ShapeSettings readShapeSettings(const ShotNode& node, bool isStrict, double metresPerUnit,
                                ProblemList& problems)
{
    ShapeSettings settings;
    if (const ShotNode* sdf = node.find("sdf")) readField(*sdf, metresPerUnit, settings);
    const bool isGrid = isStrict || wordOf(node, "field") == "grid";
    settings.field = isGrid ? FieldMode::grid : FieldMode::refined;
    const std::string normals = wordOf(node, "normals");
    settings.normals = normals == "true"     ? NormalMode::trueNormals
                       : normals == "smooth" ? NormalMode::smooth
                                             : NormalMode::automatic;
    if (const ShotNode* samples = node.find("edge_samples")) {
        settings.edgeSamples = samples->boolean;
    }
    if (const ShotNode* mesh = node.find("mesh")) {
        readRepair(*mesh, metresPerUnit, settings, problems);
    }
    return settings;
}

std::vector<std::string> readShapes(const ShotNode& tree, const std::filesystem::path& folder,
                                    bool isStrict, Shot& shot, ProblemList& problems)
{
    return ShapeReader(folder, isStrict, shot, problems).read(tree.find("shape"));
}

}  // namespace scree
