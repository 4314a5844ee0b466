#include "core/dynamics/gaps/gap_grip.h"

#include <algorithm>

#include "core/base/sorted.h"

namespace scree {
namespace {

/// Overlap beyond this share of the smaller body is more than steps leave: push-out would have
/// taken it away if there were room. Then friction may hold so many times the weight of what is
/// squeezed for each further unit of that share, and at most so many times in all. As an impulse of
/// the contact itself it would throw what only one side overlaps.
constexpr double kSqueezed = 1e-3, kHeldWeights = 1e4, kMostWeights = 100.0;
/// That of the earth: jaws hold in a shot without gravity what they hold here [m/s²].
constexpr double kLeastGravity = 9.81;

}  // namespace

void gripSqueezed(const World& world, const StepSettings& settings, double dt,
                  const GapBlock& block, GapScratch& scratch)
{
    const double gravity = std::max(kLeastGravity, settings.gravity.norm());
    const auto excessOf = [&](const GapPair& pair) {
        const double smaller = smallerRadius(world, pair.bodies.a, pair.bodies.b);
        return scratch.nearPairs[pair.nearPair].depth / smaller - kSqueezed;
    };
    const auto isKeyed = [&](BodyId body) { return world.info[body].kind == BodyKind::keyed; };
    thread_local std::vector<std::size_t> squeezed;  // islands
    squeezed.clear();
    for (const std::size_t i : block.pairs) {
        const GapPair& pair = scratch.pairs[i];
        if ((isKeyed(pair.bodies.a) || isKeyed(pair.bodies.b)) && excessOf(pair) > 0.0)
            squeezed.push_back(pair.island);
    }
    sortUnique(squeezed);
    for (const std::size_t island : squeezed) {
        for (const std::size_t i : scratch.islands[island].pairs) {
            const GapPair& pair = scratch.pairs[i];
            const double weights = std::min(kHeldWeights * excessOf(pair), kMostWeights);
            if (weights <= 0.0) continue;
            const double mass = 1.0 / std::max(scratch.bodies[pair.bodies.a].inverseMass,
                                               scratch.bodies[pair.bodies.b].inverseMass);
            const double ofEach =
                dt * weights * mass * gravity / static_cast<double>(pair.rowCount());
            for (GapRow& row : scratch.rowsOf(pair)) {
                if (row.gap < 0.0) row.squeeze = ofEach;
            }
        }
    }
}

}  // namespace scree
