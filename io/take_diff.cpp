#include "io/take_diff.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/math/rotation.h"
#include "io/shot_difference.h"

namespace scree {
namespace {

void requireSameBodies(const TakeInfo& a, const TakeInfo& b)
{
    const std::size_t count = std::min(a.bodies.size(), b.bodies.size());
    for (std::size_t i = 0; i < count; ++i) {
        if (a.bodies[i].name == b.bodies[i].name) continue;
        throw Error(ErrorKind::badInput, "the takes have different bodies: number " +
                                             std::to_string(i + 1) + " is '" + a.bodies[i].name +
                                             "' in one, '" + b.bodies[i].name + "' in the other");
    }
    if (a.bodies.size() != b.bodies.size()) {
        throw Error(ErrorKind::badInput,
                    "the takes have different bodies: " + std::to_string(a.bodies.size()) +
                        " and " + std::to_string(b.bodies.size()));
    }
}

// Bit for bit, so that −0 and 0 differ as they do for resume.
bool isSame(const Vec3& a, const Vec3& b)
{
    return std::memcmp(a.data(), b.data(), sizeof a) == 0;
}

bool isSame(const Quat& a, const Quat& b)
{
    return std::memcmp(a.coeffs().data(), b.coeffs().data(), sizeof a) == 0;
}

bool isSame(const BodyMotion& a, const BodyMotion& b)
{
    return isSame(a.position, b.position) && isSame(a.orientation, b.orientation) &&
           isSame(a.velocity, b.velocity) && isSame(a.angularMomentum, b.angularMomentum);
}

bool isSame(const SceneFrame& a, const SceneFrame& b)
{
    for (std::size_t i = 0; i < a.worldFromAsset.size(); ++i) {
        const Pose &p = a.worldFromAsset[i], &q = b.worldFromAsset[i];
        if (!isSame(p.position, q.position) || !isSame(p.orientation, q.orientation)) return false;
    }
    return true;
}

std::optional<double> firstOffset(const FrameState& a, const FrameState& b)
{
    if (a.between.empty() || a.between.size() != b.between.size()) return std::nullopt;
    for (std::size_t i = 0; i < a.between.size(); ++i) {
        if (a.between[i].offset != b.between[i].offset) return std::nullopt;
        if (!isSame(a.between[i], b.between[i])) return a.between[i].offset;
    }
    return std::nullopt;
}

bool isSame(const Stay& a, const Stay& b)
{
    return isSame(a.position, b.position) && isSame(a.orientation, b.orientation) &&
           a.frames == b.frames;
}

bool isSame(const BodyRest& a, const BodyRest& b)
{
    return isSame(a.still, b.still) && isSame(a.nearby, b.nearby) && isSame(a.around, b.around) &&
           isSame(a.pull, b.pull) && a.isAsleep == b.isAsleep &&
           a.unbalancedFrames == b.unbalancedFrames;
}

bool isSame(const RememberedContact& a, const RememberedContact& b)
{
    return a.a == b.a && a.b == b.b && a.feature == b.feature && isSame(a.place, b.place) &&
           isSame(a.force, b.force) && isSame(a.couple, b.couple);
}

using ContactsOfPairs = std::map<std::pair<BodyId, BodyId>, std::vector<RememberedContact>>;

ContactsOfPairs byPair(const ContactMemory& memory)
{
    ContactsOfPairs pairs;
    for (const RememberedContact& contact : memory.contacts) {
        pairs[{contact.a, contact.b}].push_back(contact);
    }
    return pairs;
}

/// Notes the bodies of every pair of `a` that `b` has not, or remembers otherwise.
void noteOtherPairs(const ContactsOfPairs& a, const ContactsOfPairs& b, std::set<BodyId>& bodies)
{
    for (const auto& [pair, contacts] : a) {
        const auto other = b.find(pair);
        const bool isKnown =
            other != b.end() &&
            std::equal(contacts.begin(), contacts.end(), other->second.begin(), other->second.end(),
                       [](const auto& p, const auto& q) { return isSame(p, q); });
        if (!isKnown) bodies.insert({pair.first, pair.second});
    }
}

/// Bodies whose rest or contacts are remembered otherwise.
std::set<BodyId> remembersOtherwise(const ContactMemory& a, const ContactMemory& b)
{
    std::set<BodyId> bodies;
    const std::size_t count = std::max(a.rest.size(), b.rest.size());
    for (std::size_t i = 0; i < count; ++i) {
        const BodyRest none;
        const BodyRest& p = i < a.rest.size() ? a.rest[i] : none;
        const BodyRest& q = i < b.rest.size() ? b.rest[i] : none;
        if (!isSame(p, q)) bodies.insert(static_cast<BodyId>(i));
    }
    const ContactsOfPairs pairsA = byPair(a), pairsB = byPair(b);
    noteOtherPairs(pairsA, pairsB, bodies);
    noteOtherPairs(pairsB, pairsA, bodies);
    return bodies;
}

std::optional<TakeDifference> compareFrames(const FrameState& a, const FrameState& b,
                                            const TakeInfo& info)
{
    TakeDifference difference;
    const auto bornAt = [](const FrameState& state, std::size_t body) {
        return state.bornAt.empty() ? 0 : state.bornAt[body];
    };
    double farthest = -1.0;
    for (std::size_t i = 0; i < a.motion.size(); ++i) {
        if (isSame(a.motion[i], b.motion[i]) && bornAt(a, i) == bornAt(b, i)) continue;
        difference.bodies.push_back(info.bodies[i].name);
        const double apart = (a.motion[i].position - b.motion[i].position).norm();
        if (apart <= farthest) continue;
        farthest = difference.farthest = apart;
        difference.farthestBody = info.bodies[i].name;
        difference.largestTurn = a.motion[i].orientation.angularDistance(b.motion[i].orientation);
    }
    if (difference.bodies.empty()) {
        for (const BodyId body : remembersOtherwise(a.contactMemory, b.contactMemory)) {
            difference.bodies.push_back(info.bodies.at(static_cast<std::size_t>(body)).name);
        }
        difference.isMemoryOnly =
            !difference.bodies.empty() || a.contactMemory.dt != b.contactMemory.dt;
    }
    const bool isSame = difference.bodies.empty() && !difference.isMemoryOnly;
    if (isSame && a.order == b.order) return std::nullopt;
    difference.frame = a.scene.frame;
    difference.offset = firstOffset(a, b);
    return difference;
}

int stepsOf(const TakeReader& take, int frame)
{
    for (const FrameSummary& summary : take.stats()) {
        if (summary.frame == frame) return summary.steps;
    }
    return 0;
}

void noteSettings(const TakeReader& a, const TakeReader& b, TakeComparison& comparison)
{
    if (a.info().shotHash != b.info().shotHash) {
        comparison.notes.push_back(
            "their shots differ: the first has " +
            someDifferences(
                shotDifferences(a.info().resolvedShot, b.info().resolvedShot, "the second")));
    }
    if (a.info().programVersion != b.info().programVersion) {
        comparison.notes.push_back("made by scree " + a.info().programVersion + " and " +
                                   b.info().programVersion);
    }
    comparison.holdSameFrames = a.frames() == b.frames();
    if (!comparison.holdSameFrames) {
        comparison.notes.push_back("they hold " + std::to_string(a.frames().size()) + " and " +
                                   std::to_string(b.frames().size()) + " frames");
    }
}

}  // namespace

TakeComparison compareTakes(const TakeReader& a, const TakeReader& b,
                            const std::function<void()>& beforeFrame)
{
    requireSameBodies(a.info(), b.info());
    TakeComparison comparison;
    noteSettings(a, b, comparison);
    std::vector<int> frames;
    std::set_intersection(a.frames().begin(), a.frames().end(), b.frames().begin(),
                          b.frames().end(), std::back_inserter(frames));
    for (const int frame : frames) {
        if (beforeFrame) beforeFrame();
        const FrameState stateA = a.readState(frame), stateB = b.readState(frame);
        ++comparison.framesCompared;
        comparison.difference = compareFrames(stateA, stateB, a.info());
        if (!comparison.difference) continue;
        comparison.difference->stepsA = stepsOf(a, frame);
        comparison.difference->stepsB = stepsOf(b, frame);
        break;
    }
    return comparison;
}

}  // namespace scree
