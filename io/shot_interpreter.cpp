#include "io/shot_interpreter.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <unordered_map>
#include <unordered_set>

#include "core/math/rotation.h"
#include "io/emitter.h"
#include "io/nearest_word.h"
#include "io/pose_file.h"
#include "io/shot_camera.h"
#include "io/shot_check.h"
#include "io/shot_import.h"
#include "io/shot_motion.h"
#include "io/shot_pose.h"
#include "io/shot_shapes.h"
#include "io/shot_solver.h"
#include "io/shot_values.h"
#include "io/subframes.h"
#include "io/unique_names.h"

namespace scree {
namespace {

constexpr std::size_t kMostBodies = 1'000'000;

double metresPerUnit(const std::string& unit)
{
    if (unit == "cm") return 0.01;
    if (unit == "mm") return 0.001;
    if (unit == "in") return 0.0254;
    if (unit == "ft") return 0.3048;
    return 1.0;
}

BodyKind kindOf(const std::string& word)
{
    if (word == "static") return BodyKind::fixed;
    return word == "keyed" ? BodyKind::keyed : BodyKind::dynamic;
}

class Interpreter {
public:
    Interpreter(const ShotNode& tree, const std::string& shotPath, const ImportLimits& limits,
                ProblemList& problems)
        : tree_(tree),
          folder_(std::filesystem::path(shotPath).parent_path()),
          problems_(problems),
          groups_(tree, problems)
    {
        shot_.importLimits = limits;
    }

    Shot interpret()
    {
        readShotTable();
        if (const ShotNode* solver = tree_.find("solver")) {
            isStrict_ = readSolver(*solver, shot_, problems_);
        }
        if (const ShotNode* start = tree_.find("start")) readStart(*start, shot_);
        readMaterials();
        readMaterialPairs(tree_, shot_, problems_);
        shapeNames_ = readShapes(tree_, folder_, isStrict_, shot_, problems_);
        isShapeName_.insert(shapeNames_.begin(), shapeNames_.end());
        readForceFields(tree_, groups_, shot_, problems_);
        if (const ShotNode* bodies = tree_.find("body")) {
            for (const ShotNode& body : bodies->items) readBody(body);
        }
        if (const ShotNode* imports = tree_.find("import")) {
            for (const ShotNode& import : imports->items) readImport(import);
        }
        if (const ShotNode* emitters = tree_.find("emitter")) {
            for (const ShotNode& emitter : emitters->items) readEmitter(emitter);
        }
        readLook();
        return std::move(shot_);
    }

private:
    void readShotTable()
    {
        const ShotNode* table = tree_.find("shot");
        if (!table) return;
        if (const ShotNode* name = table->find("name")) {
            shot_.name = name->text;
            if (!isPlainName(name->text)) {
                report(*name, "name " + toTomlText(std::string_view(name->text)) +
                                  " must be letters, digits and _, not beginning with a digit");
            }
            if (name->text.size() > kLongestName) {
                report(*name, "a name of " + std::to_string(name->text.size()) +
                                  " letters is too long for a folder: at most " +
                                  std::to_string(kLongestName));
            }
        }
        const ShotNode& frames = *table->find("frames");
        if (!readFrameRange(frames.text, shot_.firstFrame, shot_.lastFrame)) {
            report(frames, "'frames' must be \"FIRST-LAST\", for example \"1001-1240\", not " +
                               toTomlText(frames));
        } else if (shot_.lastFrame < shot_.firstFrame) {
            report(frames, "'frames' must not end before they begin: " + toTomlText(frames));
        } else if (frames.text.find('-', 1) == std::string::npos) {
            problems_.warn(frames.where, "'frames' is the one frame " + frames.text +
                                             ", not so many: \"FIRST-LAST\" is a range");
        }
        shot_.framesPerSecond = table->find("fps")->number;
        shot_.metresPerUnit = metresPerUnit(table->find("units")->text);
        shot_.zUp = table->find("up")->text == "+z";
        shot_.settings.gravity = toVec3(*table->find("gravity"));
        shot_.settings.seed = static_cast<std::uint64_t>(table->find("seed")->integer);
    }

    void readMaterials()
    {
        const ShotNode* table = tree_.find("material");
        if (!table) return;
        for (const ShotEntry& entry : table->entries) {
            materialNames_.push_back(entry.key);
            if (!entry.isValid) continue;
            const ShotNode& node = entry.node;
            ShotMaterial material;
            material.location = entry.where;
            material.material.name = entry.key;
            material.material.density = node.find("density")->number;
            material.material.friction = node.find("friction")->number;
            material.material.restitution = node.find("restitution")->number;
            readRollingFriction(node, material.material.rolling);
            material.color = toVec3(*node.find("color"));
            material.roughness = node.find("roughness")->number;
            shot_.materials.push_back(material);
        }
    }

    void readRollingFriction(const ShotNode& node, RollingFriction& rolling)
    {
        const auto number = [&](const char* key, double unit) {
            const ShotNode* value = node.find(key);
            return value ? value->number * unit : 0.0;
        };
        rolling.rolling = number("rolling_friction", shot_.metresPerUnit);
        rolling.spinning = number("spinning_friction", shot_.metresPerUnit);
        rolling.rawRolling = number("rolling_friction_raw", 1.0);
        rolling.rawSpinning = number("spinning_friction_raw", 1.0);
    }

    void readBody(const ShotNode& node)
    {
        ShotBody body;
        body.location = node.where;
        if (const ShotNode* name = node.find("name")) body.name = body.item = name->text;
        const bool hasOwnName = claim(node, body.name, ownerOfItem_);
        readReferences(node, body);
        if (const ShotNode* plane = node.find("plane")) readPlane(node, *plane, body);
        readMotion(node, body);
        readSleep(node, body);
        readBodyForces(node, body, problems_);
        body.groups = groups_.read(node);
        body.isVisible = isVisible(node);

        // A copy count that is wrong or too large is reported, and nothing is expanded.
        const std::vector<Pose> copies = readCopies(node);
        if (!hasOwnName) return;
        const bool isSingle = !node.mentions("grid") && !node.mentions("poses");
        bool isNew = true;
        for (std::size_t i = 0; i < copies.size() && isNew; ++i) {
            ShotBody copy = body;
            if (body.kind != BodyKind::keyed) {
                copy.worldFromAsset = copies[i];
                copy.worldFromAsset.position *= shot_.metresPerUnit;
            }
            if (!isSingle && !body.name.empty()) copy.name = nameOfCopy(body.name, i);
            isNew = claimName(node, copy.name);
            if (isNew) shot_.bodies.push_back(std::move(copy));
        }
    }

    /// A body, and where nobody has it yet a shape, for every node that is asked for.
    void readImport(const ShotNode& node)
    {
        const ShotNode *file = node.find("file"), *material = node.find("material");
        if (material) requireKnown(*material, "material", materialNames_);
        if (!file || !material) return;
        const ShapeSettings settings =
            readShapeSettings(node, isStrict_, shot_.metresPerUnit, problems_);
        const CollisionGroups groups = groups_.read(node);
        bool isRight = true;  // what is wrong with all of them is told of one
        for (PlacedNode& placed :
             readImportedNodes(node, besideShot(file->text), shot_, problems_)) {
            if (!hasRoomFor(1.0, node)) return;
            ShotBody body;
            body.location = node.where;
            body.name = placed.name;
            body.name = freeName(placed.name, lastBody_,
                                 [&](const auto& name) { return ownerOfName_.contains(name); });
            ownerOfName_.emplace(body.name, node.where);
            body.shape = shapeOfNode(placed, settings, node.where);
            body.material = material->text;
            body.kind = kindOf(node.find("motion")->text);
            body.worldFromAsset = placed.worldFromNode;
            body.keys = std::move(placed.keys);
            body.interpolation = placed.interpolation;
            body.groups = groups;
            body.isVisible = isVisible(node);
            if (isRight) isRight = readImportedStart(node, body);
            shot_.bodies.push_back(std::move(body));
        }
    }

    /// The wanted name, or with the first number that nobody has. Files have thousands of nodes of
    /// one name: `last` remembers which number was given.
    template <class IsTaken>
    static std::string freeName(const std::string& wanted,
                                std::unordered_map<std::string, int>& last, const IsTaken& isTaken)
    {
        if (!isTaken(wanted)) return wanted;
        int& number = last.try_emplace(wanted, 1).first->second;
        while (isTaken(wanted + "_" + std::to_string(++number))) {
        }
        return wanted + "_" + std::to_string(number);
    }

    /// How a body of an import begins. False, and a report, when it cannot.
    bool readImportedStart(const ShotNode& node, ShotBody& body)
    {
        const std::size_t problemsBefore = problems_.count();
        if (const ShotNode* velocity = node.find("velocity")) {
            body.velocity = toVec3(*velocity) * shot_.metresPerUnit;
            if (body.kind != BodyKind::dynamic) {
                report(*velocity, "only dynamic bodies have a 'velocity'");
            }
        }
        if (body.kind == BodyKind::keyed) readFreeTimes(node, shot_, body, problems_);
        readSleep(node, body);
        return problems_.count() == problemsBefore;
    }

    std::string shapeOfNode(const PlacedNode& placed, const ShapeSettings& settings,
                            const SourceLocation& where)
    {
        // A mesh is one file's: of each [[import]] it is read anew.
        std::string& known = shapeOfMesh_[placed.shape.mesh.get()];
        if (!known.empty()) return known;
        ShotShape shape;
        shape.name = freeName(placed.name, lastShape_,
                              [&](const auto& name) { return isShapeName_.contains(name); });
        isShapeName_.insert(shape.name);
        known = shape.name;
        shape.source = placed.shape;
        shape.settings = settings;
        shape.location = where;
        shapeNames_.push_back(shape.name);
        shot_.shapes.push_back(shape);
        return shape.name;
    }

    /// Every body of an emitter is a body of the shot, with a birth.
    void readEmitter(const ShotNode& node)
    {
        const std::size_t problemsBefore = problems_.count();
        if (const ShotNode* poses = node.find("poses"))
            shot_.sideFiles.push_back(besideShot(poses->text));
        Emitter emitter = readEmitterTable(node, shot_, folder_.string(), problems_);
        const auto require = [&](const char* key, const std::vector<std::string>& names) {
            const ShotNode* value = node.find(key);
            if (!value) return;
            for (const ShotNode& item : value->items) requireKnown(item, key, names);
            if (value->items.empty()) requireKnown(*value, key, names);
        };
        require("shape", shapeNames_);
        require("material", materialNames_);
        if (const ShotNode* count = node.find("count")) hasRoomFor(1.0 * emitter.count, *count);
        if (problems_.count() > problemsBefore || !isComplete(node)) return;
        if (!claim(node, emitter.name, ownerOfItem_)) return;

        const CollisionGroups groups = groups_.read(node);
        for (int i = 0; i < emitter.count; ++i) {
            ShotBody body = emittedBody(emitter, shot_, i);
            body.name = nameOfCopy(emitter.name, static_cast<std::size_t>(i));
            body.item = emitter.name;
            body.location = node.where;
            body.groups = groups;
            if (!claimName(node, body.name)) return;
            shot_.bodies.push_back(std::move(body));
        }
    }

    /// Whether nothing that it needs was missing or found wrong before.
    static bool isComplete(const ShotNode& emitter)
    {
        for (const char* key : {"name", "shape", "material", "count"}) {
            if (!emitter.find(key)) return false;
        }
        return true;
    }

    static std::string nameOfCopy(const std::string& name, std::size_t index)
    {
        char number[24];
        std::snprintf(number, sizeof number, "_%04zu", index);
        return name + number;
    }

    bool claimName(const ShotNode& node, const std::string& name)
    {
        return claim(node, name, ownerOfName_);
    }

    using Owners = std::unordered_map<std::string, SourceLocation>;  // asked, never walked

    /// False, and a report, when another has the name.
    bool claim(const ShotNode& node, const std::string& name, Owners& owners)
    {
        const ShotNode* place = node.find("name");
        if (!place) return true;
        const auto [owner, isNew] = owners.try_emplace(name, place->where);
        if (!isNew) {
            report(*place,
                   "body name '" + name + "' is taken by the body at " + toString(owner->second));
        }
        return isNew;
    }

    void readReferences(const ShotNode& node, ShotBody& body)
    {
        if (const ShotNode* shape = node.find("shape")) {
            body.shape = shape->text;
            requireKnown(*shape, "shape", shapeNames_);
        } else if (!mentionsAny(node, {"shape", "plane"})) {
            report(node, "[[body]]" + quotedName(body) + " has neither 'shape' nor 'plane'");
        }
        if (const ShotNode* material = node.find("material")) {
            body.material = material->text;
            requireKnown(*material, "material", materialNames_);
        }
    }

    void requireKnown(const ShotNode& reference, const std::string& table,
                      const std::vector<std::string>& names)
    {
        for (const std::string& name : names) {
            if (name == reference.text) return;
        }
        const bool isTableMisspelt = !tree_.entry(table) && tree_.mentions(table);
        if (isTableMisspelt) return;
        report(reference, "no [" + table + "." + reference.text + "] in the shot" +
                              didYouMean(reference.text, names) +
                              (names.empty() ? "" : " (known: " + joined(names) + ")"));
    }

    void readPlane(const ShotNode& node, const ShotNode& plane, ShotBody& body)
    {
        PlaneSpec spec;
        spec.point = toVec3(*plane.find("point")) * shot_.metresPerUnit;
        if (const ShotNode* normal = plane.find("normal")) {
            const Vec3 direction = toVec3(*normal);
            const double largest = direction.cwiseAbs().maxCoeff();
            if (largest > 0.0) {
                spec.normal = (direction / largest).normalized();
            } else {
                report(*normal, "'normal' must not be zero");
            }
        }
        body.plane = spec;
        if (node.find("motion")->text != "static" && !node.isUnclear("motion")) {
            report(plane, "a plane cannot move: write motion = \"static\"");
        }
    }

    void readMotion(const ShotNode& node, ShotBody& body)
    {
        const std::string& motion = node.find("motion")->text;
        const bool isStatic = motion == "static";
        body.kind = kindOf(motion);
        readKeyedMotion(node, shot_, body, problems_);
        if (const ShotNode* velocity = node.find("velocity")) {
            body.velocity = toVec3(*velocity) * shot_.metresPerUnit;
            if (isStatic && !body.velocity.isZero(0.0)) {
                report(*velocity, "a static body has no 'velocity'");
            }
        }
        if (const ShotNode* spin = node.find("spin")) {
            body.angularVelocity = toVec3(*spin) * kRadiansPerDegree;
            if (isStatic && !body.angularVelocity.isZero(0.0)) {
                report(*spin, "a static body has no 'spin'");
            }
        }
        if (const ShotNode* mass = node.find("mass")) {
            body.mass = mass->number;
            if (isStatic) report(*mass, "a static body has no 'mass': nothing moves it");
            if (body.kind == BodyKind::keyed && body.isNeverFree()) {
                report(*mass, "a keyed body that is never released has no 'mass'");
            }
        }
    }

    static bool isVisible(const ShotNode& node)
    {
        const ShotNode* visible = node.find("visible");
        return !visible || visible->boolean;
    }

    void readSleep(const ShotNode& node, ShotBody& body)
    {
        const ShotNode* start = node.find("start");
        if (!start || start->text != "asleep") return;
        body.startsAsleep = true;
        if (body.kind != BodyKind::dynamic) {
            report(*start, "only a dynamic body can be asleep; nothing moves this one anyway");
        } else if (shot_.settings.method != Method::scree || !shot_.settings.sleep) {
            report(*start, "start = \"asleep\" needs method = \"scree\" with sleep = true");
        } else if (!body.velocity.isZero(0.0) || !body.angularVelocity.isZero(0.0)) {
            report(*start, "a body that starts asleep has no 'velocity' or 'spin'");
        }
    }

    /// Where the copies of a body stand [shot units]; one for a plain body.
    std::vector<Pose> readCopies(const ShotNode& node)
    {
        if (const ShotNode* poses = node.find("poses")) {
            const std::string path = besideShot(poses->text);
            const std::vector<Pose> copies = readPoseFile(path, poses->where, problems_);
            shot_.sideFiles.push_back(path);
            return hasRoomFor(static_cast<double>(copies.size()), *poses) ? copies
                                                                          : std::vector<Pose>();
        }
        const Pose base = readPose(node, problems_);
        if (const ShotNode* grid = node.find("grid")) return readGrid(*grid, base);
        return hasRoomFor(1.0, node) ? std::vector<Pose>{base} : std::vector<Pose>();
    }

    std::vector<Pose> readGrid(const ShotNode& grid, const Pose& base)
    {
        const ShotNode* countNode = grid.find("count");
        const ShotNode* spacingNode = grid.find("spacing");
        if (!countNode || !spacingNode) return {};
        const std::array<int, 3> count = toInts<3>(*countNode);
        if (!hasRoomFor(1.0 * count[0] * count[1] * count[2], *countNode)) return {};

        std::vector<Pose> copies;
        for (const Vec3& place : gridPlaces(count, toVec3(*spacingNode))) {
            copies.push_back({base.position + place, base.orientation});
        }
        return copies;
    }

    /// False, and one report in the whole shot, when the bodies become too many.
    bool hasRoomFor(double count, const ShotNode& node)
    {
        const bool hasRoom = static_cast<double>(shot_.bodies.size()) + count <= kMostBodies;
        if (!hasRoom && !isTooManyReported_) {
            report(node, "the shot has more than 1000000 bodies");
            isTooManyReported_ = true;
        }
        return hasRoom;
    }

    void readLook()
    {
        if (const ShotNode* render = tree_.find("render")) {
            shot_.render.size = toInts<2>(*render->find("size"));
            if (const ShotNode* burnIn = render->find("burnin"))
                shot_.render.burnIn = burnIn->boolean;
            if (const ShotNode* moments = render->find("motion_blur"))
                shot_.render.motionBlur = static_cast<int>(moments->integer);
            if (const ShotNode* still = render->find("still")) readStill(*still);
        }
        // After the size of the pictures: their shape decides what a camera of a file sees.
        if (const ShotNode* cameras = tree_.find("camera")) {
            for (const ShotNode& camera : cameras->items) readCamera(camera);
        }
        if (const ShotNode* output = tree_.find("output")) {
            for (const ShotNode& word : output->find("export")->items) {
                shot_.output.exports.push_back(word.text);
            }
            readSubframes(*output->find("subframes"));
            shot_.output.contacts = output->find("contacts")->boolean;
        }
    }

    void readStill(const ShotNode& still)
    {
        if (still.integer >= shot_.firstFrame && still.integer <= shot_.lastFrame) return;
        report(still, "'still' must be one of the shot's frames, " +
                          std::to_string(shot_.firstFrame) + " to " +
                          std::to_string(shot_.lastFrame));
    }

    void readSubframes(const ShotNode& list)
    {
        for (const ShotNode& item : list.items) shot_.output.subframes.push_back(item.number);
        if (!areSampleOffsets(shot_.output.subframes)) {
            report(list,
                   "'subframes' must lie within one frame and at least 0.01 frames apart, like "
                   "[-0.25, 0.0, 0.25], not " +
                       toTomlText(list));
        }
    }

    void readCamera(const ShotNode& node)
    {
        const ShotNode& name = *node.find("name");
        const auto isTaken = [&](const SceneCamera& other) { return other.name == name.text; };
        if (std::any_of(shot_.cameras.begin(), shot_.cameras.end(), isTaken)) {
            report(name, "camera name '" + name.text + "' is taken by another camera");
        }
        if (const ShotNode* file = node.find("file"))
            shot_.sideFiles.push_back(besideShot(file->text));
        shot_.cameras.push_back(interpretCamera(node, folder_, shot_, problems_));
    }

    static std::string quotedName(const ShotBody& body)
    {
        return body.name.empty() ? "" : " '" + body.name + "'";
    }

    std::string besideShot(const std::string& file) const
    {
        return (folder_ / file).lexically_normal().string();
    }

    void report(const ShotNode& node, const std::string& message)
    {
        problems_.add(node.where, message);
    }

    const ShotNode& tree_;
    std::filesystem::path folder_;
    ProblemList& problems_;
    Shot shot_;
    std::vector<std::string> materialNames_, shapeNames_;
    Owners ownerOfName_;  // of the bodies, copies one by one
    Owners ownerOfItem_;  // of [[body]] and [[emitter]], whose name the copies need not have
    std::unordered_set<std::string> isShapeName_;                  // of shapeNames_
    std::unordered_map<const TriMesh*, std::string> shapeOfMesh_;  // of what imports show
    std::unordered_map<std::string, int> lastBody_, lastShape_;    // numbers given, by name
    bool isTooManyReported_ = false;
    bool isStrict_ = false;
    GroupNames groups_;
};

}  // namespace

Shot interpretShot(const ShotNode& tree, const std::string& shotPath, const ImportLimits& limits,
                   ProblemList& problems)
{
    return Interpreter(tree, shotPath, limits, problems).interpret();
}

}  // namespace scree
