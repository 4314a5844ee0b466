// Symbols: u draws, uniform in 0 … 1; q orientation.
#include "io/emitter.h"

#include <cstdio>
#include <filesystem>

#include "core/base/random.h"
#include "core/math/rotation.h"
#include "io/pose_file.h"
#include "io/shot_values.h"

namespace scree {
namespace {

constexpr double kMostPlaces = 1'000'000.0;

/// What a draw is for; rejected draws go on from here, so the last ones stand alone.
enum Purpose : std::uint64_t { kShape = 0, kPlace = 1, kTilt = 4, kDirection = 1000 };

/// The dice of one body.
struct Dice {
    std::uint64_t seed, emitter, index;

    double draw(std::uint64_t purpose) const { return randomUnit(seed, emitter, index, purpose); }
    double drawSigned(std::uint64_t purpose) const { return 2.0 * draw(purpose) - 1.0; }
};

/// All rotations alike likely: a point drawn in the unit ball of quaternions, thrown out of the
/// ball's corners, has no favoured direction.
Quat anyOrientation(const Dice& dice)
{
    for (std::uint64_t purpose = kDirection;; purpose += 4) {
        Quat q(dice.drawSigned(purpose), dice.drawSigned(purpose + 1), dice.drawSigned(purpose + 2),
               dice.drawSigned(purpose + 3));
        const double size = q.squaredNorm();
        if (size <= 1.0 && size > 1e-4) return q.normalized();
    }
}

/// Leans from upright by an angle drawn in 0 … maxTilt, in a drawn direction.
Quat leaning(const Dice& dice, double maxTilt, bool zUp)
{
    for (std::uint64_t purpose = kDirection;; purpose += 2) {
        const double a = dice.drawSigned(purpose), b = dice.drawSigned(purpose + 1);
        const double size = a * a + b * b;
        if (size > 1.0 || size < 1e-4) continue;
        const Vec3 axis = (zUp ? Vec3(a, b, 0.0) : Vec3(a, 0.0, b)).normalized();
        return exponentialMap(maxTilt * dice.draw(kTilt) * axis);
    }
}

std::size_t drawShape(const std::vector<double>& weights, double u)
{
    double sum = 0.0;
    for (const double weight : weights) sum += weight;
    double reached = 0.0;
    for (std::size_t i = 0; i + 1 < weights.size(); ++i) {
        reached += weights[i];
        if (u * sum < reached) return i;
    }
    return weights.size() - 1;
}

void readShapes(const ShotNode& node, Emitter& emitter, ProblemList& problems)
{
    if (const ShotNode* shape = node.find("shape")) {
        for (const ShotNode& item : shape->items) emitter.shapes.push_back(item.text);
        if (shape->items.empty()) emitter.shapes.push_back(shape->text);
    }
    emitter.weights.assign(emitter.shapes.size(), 1.0);
    const ShotNode* weights = node.find("weights");
    if (!weights || emitter.shapes.empty()) return;
    if (weights->items.size() != emitter.shapes.size()) {
        problems.add(weights->where, "'weights' must be as many as the shapes, " +
                                         std::to_string(emitter.shapes.size()) + ", not " +
                                         std::to_string(weights->items.size()));
        return;
    }
    for (std::size_t i = 0; i < weights->items.size(); ++i) {
        emitter.weights[i] = weights->items[i].number;
    }
}

void readBirths(const ShotNode& node, const Shot& shot, Emitter& emitter, ProblemList& problems)
{
    emitter.firstBirth = emitter.lastBirth = shot.firstFrame;
    const ShotNode* frames = node.find("frames");
    if (!frames) return;
    if (!readFrameRange(frames->text, emitter.firstBirth, emitter.lastBirth)) {
        problems.add(frames->where,
                     "'frames' must be \"FIRST-LAST\" or one frame, for example "
                     "\"1001-1120\", not " +
                         toTomlText(*frames));
    } else if (emitter.lastBirth < emitter.firstBirth) {
        problems.add(frames->where,
                     "'frames' must not end before they begin: " + toTomlText(*frames));
    } else if (emitter.firstBirth < shot.firstFrame || emitter.lastBirth > shot.lastFrame) {
        problems.add(frames->where, "births must lie in the frames of the shot, " +
                                        std::to_string(shot.firstFrame) + "-" +
                                        std::to_string(shot.lastFrame) + ", not " +
                                        toTomlText(*frames));
    }
}

void readBox(const ShotNode& box, double metresPerUnit, Emitter& emitter, ProblemList& problems)
{
    const ShotNode *min = box.find("min"), *max = box.find("max");
    if (!min || !max) return;
    emitter.boxMin = toVec3(*min) * metresPerUnit;
    emitter.boxMax = toVec3(*max) * metresPerUnit;
    if ((emitter.boxMin.array() > emitter.boxMax.array()).any()) {
        problems.add(min->where, "'min' must not exceed 'max', " + toTomlText(*max));
    }
}

void readLayout(const ShotNode& layout, double metresPerUnit, Emitter& emitter,
                ProblemList& problems)
{
    const ShotNode* grid = layout.find("grid");
    const ShotNode* count = grid ? grid->find("count") : nullptr;
    const ShotNode* spacing = grid ? grid->find("spacing") : nullptr;
    if (!count || !spacing) return;
    std::array<int, 3> counts{};
    for (int k = 0; k < 3; ++k) counts[k] = static_cast<int>(count->items[k].integer);
    if (1.0 * counts[0] * counts[1] * counts[2] > kMostPlaces) {
        problems.add(count->where, "'count' must be at most a million places in all");
        return;
    }
    const Vec3 middle = toVec3(*layout.find("position"));
    for (const Vec3& place : gridPlaces(counts, toVec3(*spacing))) {
        emitter.places.push_back({(middle + place) * metresPerUnit, Quat::Identity()});
    }
}

void readPlaces(const ShotNode& node, const Shot& shot, const std::string& folder, Emitter& emitter,
                ProblemList& problems)
{
    if (const ShotNode* box = node.find("box")) {
        readBox(*box, shot.metresPerUnit, emitter, problems);
    } else if (const ShotNode* layout = node.find("layout")) {
        readLayout(*layout, shot.metresPerUnit, emitter, problems);
    } else if (const ShotNode* poses = node.find("poses")) {
        const auto path = (std::filesystem::path(folder) / poses->text).lexically_normal();
        emitter.places = readPoseFile(path.string(), poses->where, problems);
        emitter.placesHaveOrientations = true;
        for (Pose& place : emitter.places) place.position *= shot.metresPerUnit;
    } else if (!node.mentions("box") && !node.mentions("layout") && !node.mentions("poses")) {
        problems.add(node.where, "[[emitter]]" +
                                     (emitter.name.empty() ? "" : " '" + emitter.name + "'") +
                                     " does not say where: give it box, layout or poses");
    }
}

}  // namespace

Emitter readEmitterTable(const ShotNode& node, const Shot& shot, const std::string& folder,
                         ProblemList& problems)
{
    Emitter emitter;
    if (const ShotNode* name = node.find("name")) emitter.name = name->text;
    if (const ShotNode* material = node.find("material")) emitter.material = material->text;
    if (const ShotNode* count = node.find("count")) {
        emitter.count = static_cast<int>(count->integer);
    }
    readShapes(node, emitter, problems);
    readBirths(node, shot, emitter, problems);
    readPlaces(node, shot, folder, emitter, problems);
    if (const ShotNode* tilt = node.find("tilt")) {
        emitter.anyOrientation = tilt->kind == ShotNode::Kind::text;
        emitter.maxTilt = emitter.anyOrientation ? 0.0 : tilt->number * kRadiansPerDegree;
    }
    emitter.velocity = toVec3(*node.find("velocity")) * shot.metresPerUnit;
    emitter.angularVelocity = toVec3(*node.find("spin")) * kRadiansPerDegree;
    const std::string& clear = node.find("clear")->text;
    emitter.clearance = clear == "skip"   ? BirthClearance::skip
                        : clear == "fail" ? BirthClearance::fail
                                          : BirthClearance::wait;
    return emitter;
}

ShotBody emittedBody(const Emitter& emitter, const Shot& shot, int index)
{
    const Dice dice{shot.settings.seed, hashText(emitter.name), static_cast<std::uint64_t>(index)};
    ShotBody body;
    body.shape = emitter.shapes[drawShape(emitter.weights, dice.draw(kShape))];
    body.material = emitter.material;
    body.velocity = emitter.velocity;
    body.angularVelocity = emitter.angularVelocity;

    // Find its place and how it stands there.
    if (emitter.places.empty()) {
        const Vec3 u(dice.draw(kPlace), dice.draw(kPlace + 1), dice.draw(kPlace + 2));
        body.worldFromAsset.position =
            emitter.boxMin + u.cwiseProduct(emitter.boxMax - emitter.boxMin);
    } else {
        body.worldFromAsset = emitter.places[index % emitter.places.size()];
    }
    if (!emitter.placesHaveOrientations) {
        body.worldFromAsset.orientation = emitter.anyOrientation
                                              ? anyOrientation(dice)
                                              : leaning(dice, emitter.maxTilt, shot.zUp);
    }

    // Spread the births evenly over all their frames.
    const std::int64_t frames = emitter.lastBirth - emitter.firstBirth + 1;
    const std::int64_t after = frames * index / emitter.count;
    body.birth = {emitter.firstBirth + static_cast<int>(after), emitter.clearance};
    return body;
}

std::vector<Vec3> gridPlaces(const std::array<int, 3>& count, const Vec3& spacing)
{
    std::vector<Vec3> places;
    for (int z = 0; z < count[2]; ++z) {
        for (int y = 0; y < count[1]; ++y) {
            for (int x = 0; x < count[0]; ++x) {
                const Vec3 steps(x - 0.5 * (count[0] - 1), y - 0.5 * (count[1] - 1),
                                 z - 0.5 * (count[2] - 1));
                places.push_back(steps.cwiseProduct(spacing));
            }
        }
    }
    return places;
}

bool readFrameRange(const std::string& text, int& first, int& last)
{
    int length = 0, a = 0, b = 0;
    const int size = static_cast<int>(text.size());
    if (text.size() > 32) return false;
    if (std::sscanf(text.c_str(), "%9d%n", &a, &length) == 1 && length == size) {
        first = last = a;
        return true;
    }
    if (std::sscanf(text.c_str(), "%9d -%9d%n", &a, &b, &length) != 2 || length != size) {
        return false;
    }
    first = a;
    last = b;
    return true;
}

}  // namespace scree
