#include "io/shot_motion.h"

#include <algorithm>

#include "io/nearest_word.h"
#include "io/shot_pose.h"
#include "io/shot_values.h"

namespace scree {
namespace {

constexpr std::size_t kMostGroups = 64;

/// Frames are seconds since time zero to core.
double secondsOf(const Shot& shot, double frame)
{
    return (frame - shot.firstFrame) / shot.framesPerSecond;
}

/// False, and a report, when a key does not stand after the one before.
bool isLater(const ShotNode& frame, const ShotNode* before, ProblemList& problems)
{
    if (!before || frame.number > before->number) return true;
    problems.add(frame.where, "keys must be in order of time, no two at the same: " +
                                  toTomlText(frame) + " after " + toTomlText(*before));
    return false;
}

MotionKey readMotionKey(const ShotNode& node, const Shot& shot, ProblemList& problems)
{
    MotionKey key;
    if (const ShotNode* frame = node.find("frame")) key.time = secondsOf(shot, frame->number);
    key.pose = readPose(node, problems);
    key.pose.position *= shot.metresPerUnit;
    return key;
}

void readTakeOver(const ShotNode& start, const Shot& shot, ShotBody& body, ProblemList& problems)
{
    if (start.integer <= shot.firstFrame) {
        problems.add(start.where, "'keyed_from' must be a frame after the first, " +
                                      std::to_string(shot.firstFrame) +
                                      "; without it a body is keyed from the beginning");
        return;
    }
    body.keyedFromFrame = static_cast<int>(start.integer);
}

void readRelease(const ShotNode& release, const Shot& shot, ShotBody& body, ProblemList& problems)
{
    if (body.keyedFromFrame && release.integer <= *body.keyedFromFrame) {
        problems.add(release.where, "'release' must be a frame after 'keyed_from', " +
                                        std::to_string(*body.keyedFromFrame));
        return;
    }
    if (release.integer <= shot.firstFrame) {
        problems.add(release.where,
                     "'release' must be a frame after the first, " +
                         std::to_string(shot.firstFrame) +
                         "; a body that is free from the beginning has motion = \"dynamic\"");
        return;
    }
    body.releaseFrame = static_cast<int>(release.integer);
}

Falloff falloffOf(const std::string& word)
{
    if (word == "linear") return Falloff::linear;
    if (word == "smooth") return Falloff::smooth;
    if (word == "inverse_square") return Falloff::inverseSquare;
    return Falloff::none;
}

/// A unit vector; reports a zero one.
Vec3 directionOf(const ShotNode& node, ProblemList& problems)
{
    const Vec3 direction = toVec3(node);
    const double largest = direction.cwiseAbs().maxCoeff();
    if (largest > 0.0) return (direction / largest).normalized();
    problems.add(node.where, "'direction' must not be zero");
    return Vec3::UnitY();
}

class FieldReader {
public:
    FieldReader(const ShotNode& node, const Shot& shot, ProblemList& problems)
        : node_(node), shot_(shot), problems_(problems)
    {
    }

    ForceField read()
    {
        if (const ShotNode* name = node_.find("name")) field_.name = name->text;
        readKind();
        readStrength();
        readPlace();
        return field_;
    }

private:
    void readKind()
    {
        const ShotNode* type = node_.find("type");
        if (!type) return;
        using Kind = ForceField::Kind;
        field_.kind = type->text == "wind"      ? Kind::wind
                      : type->text == "vortex"  ? Kind::vortex
                      : type->text == "uniform" ? Kind::uniform
                                                : Kind::radial;
        const bool isRadial = field_.kind == Kind::radial;
        if (const ShotNode* direction = node_.find("direction")) {
            if (isRadial) report(*direction, "a radial force has no 'direction'");
            field_.direction = directionOf(*direction, problems_);
        } else if (!isRadial && !node_.mentions("direction")) {
            report(node_, "a force of type \"" + type->text + "\" needs a 'direction'");
        }
        if (const ShotNode* drag = node_.find("drag")) {
            if (field_.kind != Kind::wind) report(*drag, "only a wind has 'drag'");
            field_.drag = drag->number;
        }
        if (field_.kind == Kind::wind) strengthUnit_ = shot_.metresPerUnit;
    }

    void readStrength()
    {
        if (const ShotNode* strength = node_.find("strength")) {
            field_.strength = strength->number * strengthUnit_;
        } else if (!node_.mentions("strength") && !node_.mentions("keys")) {
            report(node_, "[[force]] has neither 'strength' nor 'keys'");
        }
        const ShotNode* keys = node_.find("keys");
        if (!keys) return;
        if (keys->items.empty()) report(*keys, "'keys' must not be empty");
        const ShotNode* before = nullptr;
        for (const ShotNode& item : keys->items) {
            const ShotNode *frame = item.find("frame"), *strength = item.find("strength");
            if (!frame || !strength || !isLater(*frame, before, problems_)) continue;
            before = frame;
            field_.keys.push_back(
                {secondsOf(shot_, frame->number), strength->number * strengthUnit_});
        }
    }

    void readPlace()
    {
        field_.centre = toVec3(*node_.find("center")) * shot_.metresPerUnit;
        const ShotNode& falloff = *node_.find("falloff");
        field_.falloff = falloffOf(falloff.text);
        if (const ShotNode* reach = node_.find("reach")) {
            field_.reach = reach->number * shot_.metresPerUnit;
            if (field_.falloff == Falloff::none && !node_.isUnclear("falloff")) {
                report(*reach, "'reach' means nothing without a 'falloff'");
            }
        } else if (field_.falloff != Falloff::none && !node_.mentions("reach")) {
            report(falloff, "a 'falloff' needs a 'reach'");
        }
    }

    void report(const ShotNode& where, const std::string& message)
    {
        problems_.add(where.where, message);
    }

    const ShotNode& node_;
    const Shot& shot_;
    ProblemList& problems_;
    ForceField field_;
    double strengthUnit_ = 1.0;  // accelerations are in m/s², the speed of a wind in shot units
};

}  // namespace

void readFreeTimes(const ShotNode& node, const Shot& shot, ShotBody& body, ProblemList& problems)
{
    if (const ShotNode* start = node.find("keyed_from")) {
        readTakeOver(*start, shot, body, problems);
    }
    if (const ShotNode* release = node.find("release")) {
        readRelease(*release, shot, body, problems);
    }
}

void readKeyedMotion(const ShotNode& node, const Shot& shot, ShotBody& body, ProblemList& problems)
{
    if (body.kind != BodyKind::keyed) {
        for (const char* key : {"keys", "interpolate", "keyed_from", "release"}) {
            const ShotNode* stray = node.find(key);
            if (stray && !node.isUnclear("motion")) {
                problems.add(stray->where,
                             "'" + std::string(key) + "' is for bodies with motion = \"keyed\"");
            }
        }
        return;
    }
    if (const ShotNode* word = node.find("interpolate")) {
        body.interpolation =
            word->text == "linear" ? KeyInterpolation::linear : KeyInterpolation::smooth;
    }
    readFreeTimes(node, shot, body, problems);
    const ShotNode* keys = node.find("keys");
    if (!keys || keys->items.empty()) {
        if (keys || !node.mentions("keys")) {
            problems.add((keys ? *keys : node).where,
                         "a keyed body needs 'keys', for example "
                         "keys = [{ frame = 1001, position = [0, 0, "
                         "0] }]");
        }
        return;
    }
    const ShotNode* before = nullptr;
    for (const ShotNode& item : keys->items) {
        const ShotNode* frame = item.find("frame");
        if (!frame || !isLater(*frame, before, problems)) continue;
        before = frame;
        body.keys.push_back(readMotionKey(item, shot, problems));
    }
    if (!body.keys.empty()) body.worldFromAsset = body.keys.front().pose;
}

void readBodyForces(const ShotNode& node, ShotBody& body, ProblemList& problems)
{
    for (const char* key : {"force", "torque"}) {
        const ShotNode* value = node.find(key);
        if (!value) continue;
        if (body.isNeverFree()) {
            problems.add(value->where,
                         "nothing moves this body, so it has no '" + std::string(key) + "'");
        }
        (std::string(key) == "force" ? body.force : body.torque) = toVec3(*value);
    }
}

void readMaterialPairs(const ShotNode& tree, Shot& shot, ProblemList& problems)
{
    const ShotNode* pairs = tree.find("pair");
    if (!pairs) return;
    std::vector<std::string> names;
    for (const ShotMaterial& material : shot.materials) names.push_back(material.material.name);
    for (const ShotNode& node : pairs->items) {
        ShotPair pair;
        if (const ShotNode* friction = node.find("friction")) pair.friction = friction->number;
        if (const ShotNode* e = node.find("restitution")) pair.restitution = e->number;
        if (!node.mentions("friction") && !node.mentions("restitution")) {
            problems.add(node.where, "[[pair]] says neither 'friction' nor 'restitution'");
        }
        const ShotNode* of = node.find("of");
        if (!of) continue;
        if (of->items.size() != 2) {
            problems.add(of->where, "'of' must name two materials, like [\"steel\", \"wood\"]");
            continue;
        }
        for (const ShotNode& name : of->items) {
            if (std::find(names.begin(), names.end(), name.text) != names.end()) continue;
            problems.add(name.where, "no [material." + name.text + "] in the shot" +
                                         didYouMean(name.text, names) +
                                         (names.empty() ? "" : " (known: " + joined(names) + ")"));
        }
        pair.a = std::min(of->items[0].text, of->items[1].text);
        pair.b = std::max(of->items[0].text, of->items[1].text);
        for (const ShotPair& other : shot.pairs) {
            if (other.a != pair.a || other.b != pair.b) continue;
            problems.add(of->where, "another [[pair]] is of " + pair.a + " and " + pair.b + " too");
        }
        shot.pairs.push_back(pair);
    }
}

GroupNames::GroupNames(const ShotNode& tree, ProblemList& problems)
    : names_{""}, problems_(problems)
{
    for (const char* table : {"body", "import", "emitter"}) {
        const ShotNode* list = tree.find(table);
        if (!list) continue;
        for (const ShotNode& item : list->items) {
            const ShotNode* group = item.find("group");
            if (!group || std::find(names_.begin(), names_.end(), group->text) != names_.end()) {
                continue;
            }
            if (names_.size() == kMostGroups) {
                problems.add(group->where, "the shot has more than 63 groups");
                return;
            }
            names_.push_back(group->text);
        }
    }
}

CollisionGroups GroupNames::read(const ShotNode& node)
{
    CollisionGroups groups;
    if (const ShotNode* group = node.find("group")) groups.group = bitOf(*group);
    if (const ShotNode* names = node.find("collides")) groups.collidesWith = bitsOf(*names);
    if (const ShotNode* names = node.find("unmoved_by")) groups.unmovedBy = bitsOf(*names);
    return groups;
}

std::uint64_t GroupNames::bitOf(const ShotNode& name)
{
    const auto found = std::find(names_.begin(), names_.end(), name.text);
    if (found != names_.end()) return std::uint64_t{1} << (found - names_.begin());
    const std::vector<std::string> given(names_.begin() + 1, names_.end());
    problems_.add(name.where, "no body has group = " + toTomlText(name) +
                                  didYouMean(name.text, given) +
                                  (given.empty() ? "" : " (known: " + joined(given) + ")"));
    return 0;
}

std::uint64_t GroupNames::bitsOf(const ShotNode& names)
{
    std::uint64_t bits = 0;
    for (const ShotNode& name : names.items) bits |= bitOf(name);
    return bits;
}

void readForceFields(const ShotNode& tree, GroupNames& groups, Shot& shot, ProblemList& problems)
{
    const ShotNode* fields = tree.find("force");
    if (!fields) return;
    for (const ShotNode& node : fields->items) {
        ForceField field = FieldReader(node, shot, problems).read();
        if (const ShotNode* names = node.find("groups")) field.groups = groups.bitsOf(*names);
        shot.fields.push_back(std::move(field));
    }
}

}  // namespace scree
