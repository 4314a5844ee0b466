#include "core/collision/feature_memory.h"

#include <algorithm>
#include <utility>

#include "core/base/fetch.h"
#include "core/collision/edge_lanes.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// How much farther than asked a look reaches, so that it need not be repeated at once. Only time
/// depends on it.
constexpr double kLookAhead = 0.3;        // times the reach
constexpr double kLeastLookAhead = 0.03;  // times the bounding radius of the smaller body

constexpr double kFarAway = 1e15;  // [m]; its square is a float

/// Lower bound of the distance between what the spheres hold and the field.
double apartAtLeast(const DistanceLanes& field, const std::vector<SphereLanes>& cover)
{
    FloatLanes atLeast = floatLanesOf(std::numeric_limits<float>::infinity());
    for (const SphereLanes& spheres : cover) atLeast = minOf(atLeast, field.apartAtLeast(spheres));
    return leastOf(atLeast);
}

/// The second shape asked about features of the first.
DistanceLanes fieldOfSecond(const RelativePair& pair)
{
    return {pair.second.distance, pair.rotation, pair.translation, pair.first.boundingRadius};
}

/// Calls leaf(thing, distance) for all of a tree that may come within `clearance` of the field, in
/// the order of the tree, where what is near each other is next to each other; with a lower bound
/// of its distance. Answers one of all the others [m].
template <class Leaf>
float findNear(const SphereLaneTree& tree, const DistanceLanes& field, double clearance,
               const Leaf& leaf)
{
    const FloatLanes within = floatLanesOf(clearance);
    const FloatLanes never = floatLanesOf(std::numeric_limits<float>::infinity());
    FloatLanes apart = never, atLeast = never;
    tree.visit(
        [&](const SphereLanes& spheres) {
            atLeast = field.apartAtLeast(spheres);
            const IntLanes isNear = atLeast < within;
            apart = minOf(apart, isNear ? never : atLeast);
            return bitsOf(isNear);
        },
        [&](std::uint32_t thing, int lane) { leaf(thing, atLeast[lane]); });
    return leastOf(apart);
}

/// Edges of the first shape.
float findEdgesNear(const RelativePair& pair, double clearance, std::vector<std::int32_t>& near)
{
    near.clear();
    return findNear(pair.first.features.edgeTree(), fieldOfSecond(pair), clearance,
                    [&](std::uint32_t e, float) { near.push_back(static_cast<std::int32_t>(e)); });
}

/// Lanes that are left over repeat the last edge.
void inEights(const std::vector<EdgeLine>& lines, const std::vector<std::int32_t>& chosen,
              std::vector<FacingLanes>& eights)
{
    eights.clear();
    for (std::size_t first = 0; first < chosen.size(); first += kFloatLanes) {
        EightEdges edges;
        for (std::size_t i = 0; i < edges.size(); ++i)
            edges[i] = &lines[chosen[std::min(first + i, chosen.size() - 1)]];
        eights.emplace_back(edges);
    }
}

/// A sphere around each eight, eight of these side by side; lanes that are left over hold nothing.
void inSpheres(const std::vector<FacingLanes>& eights, std::vector<SphereLanes>& spheres)
{
    spheres.assign((eights.size() + kFloatLanes - 1) / kFloatLanes, {{}, floatLanesOf(-kFarAway)});
    for (std::size_t i = 0; i < eights.size(); ++i) {
        const Ball around = eights[i].around();
        SphereLanes& eight = spheres[i / kFloatLanes];
        const int lane = static_cast<int>(i % kFloatLanes);
        eight.centre.set(lane, around.centre);
        eight.radius[lane] = static_cast<float>(around.radius);
    }
}

/// Those eights with anything within `farthest` of an edge: of two bones three in ten.
void findEightsNear(const FacingLanes& edge, const std::vector<SphereLanes>& spheres,
                    double farthest, std::vector<std::size_t>& near)
{
    near.clear();
    const FloatLanes reach = edge.half + floatLanesOf(farthest);
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const FloatLanes3 way = spheres[i].centre - edge.middle;
        const FloatLanes most = reach + spheres[i].radius;
        unsigned bits = bitsOf((dot(way, way) <= most * most) & (most > 0.0f));
        for (; bits; bits &= bits - 1)
            near.push_back(kFloatLanes * i + static_cast<std::size_t>(std::countr_zero(bits)));
    }
}

/// Whether the way of a pair is that of its second body as the first one sees it, and not the other
/// way round. No distance between the two changes faster than the points of one move in the frame
/// of the other, and the smaller one turns on the shorter lever: what spins on a large floor is far
/// from the middle of that.
bool isWayOfSecond(const RelativePair& pair)
{
    return pair.first.isPlane ||
           (!pair.second.isPlane && pair.second.boundingRadius < pair.first.boundingRadius);
}

/// Where that body is.
Vec3 placeOnWay(const RelativePair& pair)
{
    return isWayOfSecond(pair) ? pair.reversed().translation : pair.translation;
}

/// Of the points that turn in the frame of the other body [m].
double leverOf(const RelativePair& pair)
{
    return (isWayOfSecond(pair) ? pair.second : pair.first).boundingRadius;
}

/// What an odometer counts of a way, at the least: the points of the smaller body turn with the
/// larger on a longer lever than that has itself. Planes have no edges that might cross.
double countedOfWay(const RelativePair& pair)
{
    if (pair.first.isPlane || pair.second.isPlane) return 1.0;
    const auto [smaller, larger] =
        std::minmax(pair.first.boundingRadius, pair.second.boundingRadius);
    return std::min(1.0, larger / (smaller + pair.translation.norm()));
}

/// What the way of a pair may be at least, of one that has to take its edges `outside` of each
/// other across: told of the points of the first, in the frame of which directions of the second
/// turn. It matters no farther apart than twice `deepest` [m].
double outsideShare(const RelativePair& pair, double deepest)
{
    return isWayOfSecond(pair) ? 1.0 / (1.0 + 2.0 * deepest / pair.second.boundingRadius) : 1.0;
}

/// Of places of both bodies in the frame of the second, told in single precision [m].
double roundingOf(const RelativePair& pair)
{
    return kSinglePrecision *
           (pair.first.boundingRadius + pair.translation.norm() + pair.second.boundingRadius);
}

/// The next free lane of eights that are filled one lane after the other.
template <class Eight>
std::pair<Eight&, std::size_t> nextLane(std::vector<Eight>& eights, std::size_t& filled)
{
    const std::size_t lane = filled++ % kFloatLanes;
    if (lane == 0) eights.emplace_back();
    return {eights.back(), lane};
}

}  // namespace

double apartAtLeast(const RelativePair& pair, const RelativePair& back)
{
    const ContactFeatures &first = pair.first.features, &second = back.first.features;
    const DistanceLanes ofSecond = fieldOfSecond(pair), ofFirst = fieldOfSecond(back);
    double atLeast = std::min(apartAtLeast(ofSecond, first.cornerTree().cover()),
                              apartAtLeast(ofFirst, second.cornerTree().cover()));
    if (!second.edges().empty())
        atLeast = std::min(atLeast, apartAtLeast(ofSecond, first.edgeTree().cover()));
    return atLeast;
}

double lookAhead(const RelativePair& pair, double reach, double pace)
{
    const double ahead =
        std::max(kLookAhead * reach, kLeastLookAhead * smallerRadius(pair.first, pair.second));
    // Who passes that from one step to the next looks anew in any case, and is told no more by it.
    // Bones that pour take three quarters of the time so.
    return pace < ahead ? ahead : 0.0;
}

bool FeatureMemory::isStaleAt(const RelativePair& pair, double reach)
{
    const Vec3 place = placeOnWay(pair);
    pace_ = (place - place_).norm() + chordOfTurn(rotation_, pair.rotation) * leverOf(pair);
    moved_ += pace_;
    rotation_ = pair.rotation;
    place_ = place;
    return moved_ > window_ || reach + moved_ > clearance_;
}

double FeatureMemory::lookAtCorners(const RelativePair& pair, std::vector<NearCorners>& near) const
{
    thread_local std::vector<NearCorners> found;
    found.clear();
    const ContactFeatures& features = pair.first.features;
    std::size_t count = 0;
    const double apart = findNear(features.cornerTree(), fieldOfSecond(pair), clearance_,
                                  [&](std::uint32_t i, float atLeast) {
                                      auto [eight, free] = nextLane(found, count);
                                      eight.farUntil[free] = atLeast;
                                      eight.corner[free] = features.corners()[i];
                                  });
    near.assign(found.begin(), found.end());
    return found.empty() ? apart : clearance_;
}

double FeatureMemory::lookAtEdges(const RelativePair& pair, const RelativePair& back, double reach,
                                  std::vector<NearEdges>& found) const
{
    found.clear();
    const ContactFeatures &first = pair.first.features, &second = pair.second.features;
    if (first.edges().empty() || second.edges().empty()) return kInfinity;
    thread_local std::vector<std::int32_t> nearA, nearB;
    thread_local std::vector<FacingLanes> eightsOfA, eightsOfB;
    const double clearance = clearance_ + reachOfBlades(pair);
    const double apartA = findEdgesNear(pair, clearance, nearA);
    if (nearA.empty()) return apartA;
    const double apartB = findEdgesNear(back, clearance, nearB);
    if (nearB.empty()) return apartB;
    inEights(first.lines(), nearA, eightsOfA);
    inEights(second.lines(), nearB, eightsOfB);

    const FacingReach facing{std::max(reach, deepestEdges(pair)), window_ + 2.0 * roundingOf(pair),
                             window_ / leverOf(pair) + kSinglePrecision};
    for (FacingLanes& eight : eightsOfA) eight = eight.placed(pair.rotation, pair.translation);
    thread_local std::vector<SphereLanes> spheresOfB;
    thread_local std::vector<std::size_t> nearEights;
    inSpheres(eightsOfB, spheresOfB);
    std::size_t count = 0;
    for (std::size_t a = 0; a < nearA.size(); ++a) {
        const FacingLanes edge = eightsOfA[a / kFloatLanes].all(static_cast<int>(a % kFloatLanes));
        findEightsNear(edge, spheresOfB, facing.touching + facing.way, nearEights);
        for (const std::size_t eight : nearEights) {
            unsigned bits = mayFace(edge, eightsOfB[eight], facing);
            for (; bits; bits &= bits - 1) {
                const std::size_t b =
                    kFloatLanes * eight + static_cast<std::size_t>(std::countr_zero(bits));
                if (b >= nearB.size()) break;
                auto [edges, free] = nextLane(found, count);
                edges.farUntil[free] = edges.outsideUntil[free] = 0.0f;
                edges.ofA[free] = nearA[a];
                edges.ofB[free] = nearB[b];
            }
        }
    }
    return clearance_;
}

std::vector<FeatureMemory::NearEdges>& FeatureMemory::foundEdges()
{
    thread_local std::vector<NearEdges> found;
    return found;
}

double FeatureMemory::look(const RelativePair& pair, const RelativePair& back, double reach,
                           double window)
{
    moved_ = 0.0;
    rotation_ = pair.rotation;
    place_ = placeOnWay(pair);
    window_ = window;
    clearance_ = reach + window_;
    return std::min({lookAtCorners(pair, cornersOfA_), lookAtCorners(back, cornersOfB_),
                     lookAtEdges(pair, back, reach, foundEdges())});
}

void FeatureMemory::measureEdges(const RelativePair& pair, double reach,
                                 std::vector<NearEdges>& near,
                                 std::vector<EdgePair>& mayTouch) const
{
    if (near.empty()) return;
    const double deepest = deepestEdges(pair);
    const double rounding = roundingOf(pair);
    const FloatLanes outsideOfWay = floatLanesOf(outsideShare(pair, deepest));
    const std::vector<EdgeLine>& first = pair.first.features.lines();
    const std::vector<EdgeLine>& second = pair.second.features.lines();
    const RotationLanes rotation(pair.rotation);
    const FloatLanes3 translation = FloatLanes3::all(pair.translation);
    const FloatLanes moved = floatLanesOf(roundedDown(moved_));
    EightEdges ofFirst, ofSecond;
    std::array<std::pair<NearEdges*, int>, kFloatLanes> asked;
    std::size_t filled = 0;
    const auto flush = [&] {
        for (std::size_t idle = filled; idle < kFloatLanes; ++idle) {
            ofFirst[idle] = ofFirst[0];
            ofSecond[idle] = ofSecond[0];
        }
        LineLanes a(ofFirst);
        a.place(rotation, translation);
        const EdgeGaps gaps = edgeGaps(a, LineLanes(ofSecond), deepest, reach, rounding);
        const FloatLanes farUntil = moved + gaps.distance;
        const FloatLanes outsideUntil = fma(gaps.outside, outsideOfWay, moved);
        const unsigned touching = bitsOf(gaps.mayTouch);
        for (std::size_t i = 0; i < filled; ++i) {
            const auto [eight, lane] = asked[i];
            eight->farUntil[lane] = farUntil[i];
            eight->outsideUntil[lane] = outsideUntil[i];
            if (touching >> i & 1u) mayTouch.push_back({eight->ofA[lane], eight->ofB[lane]});
        }
        filled = 0;
    };
    const FloatLanes needed = floatLanesOf(roundedUp(reach + moved_));
    const FloatLanes hasMoved = floatLanesOf(roundedUp(moved_));
    for (NearEdges& eight : near) {
        unsigned bits = bitsOf((eight.farUntil < needed) | (eight.outsideUntil <= hasMoved));
        for (; bits; bits &= bits - 1) {
            const int lane = std::countr_zero(bits);
            ofFirst[filled] = &first[eight.ofA[lane]];
            ofSecond[filled] = &second[eight.ofB[lane]];
            asked[filled++] = {&eight, lane};
            if (filled == kFloatLanes) flush();
        }
    }
    if (filled > 0) flush();
}

/// Of the pairs of edges found those that may matter before the next look.
void FeatureMemory::keep(const std::vector<NearEdges>& found, double reach)
{
    thread_local std::vector<NearEdges> kept;
    kept.clear();
    const FloatLanes needed = floatLanesOf(roundedUp(reach + window_));
    const FloatLanes window = floatLanesOf(roundedUp(window_));
    std::size_t count = 0;
    for (const NearEdges& eight : found) {
        unsigned bits = bitsOf((eight.farUntil < needed) | (eight.outsideUntil <= window));
        for (; bits; bits &= bits - 1) {
            const int lane = std::countr_zero(bits);
            auto [keeping, free] = nextLane(kept, count);
            keeping.farUntil[free] = eight.farUntil[lane];
            keeping.outsideUntil[free] = eight.outsideUntil[lane];
            keeping.ofA[free] = eight.ofA[lane];
            keeping.ofB[free] = eight.ofB[lane];
        }
    }
    edges_.assign(kept.begin(), kept.end());
}

void FeatureMemory::findEdges(const RelativePair& pair, double reach, bool isNew,
                              std::vector<EdgePair>& mayTouch)
{
    mayTouch.clear();
    measureEdges(pair, reach, isNew ? foundEdges() : edges_, mayTouch);
    if (isNew) keep(foundEdges(), reach);
}

double FeatureMemory::farFor(const RelativePair& pair) const
{
    FloatLanes farUntil = kNever, outsideUntil = kNever;
    for (const std::vector<NearCorners>* near : {&cornersOfA_, &cornersOfB_}) {
        for (const NearCorners& eight : *near) farUntil = minOf(farUntil, eight.farUntil);
    }
    for (const NearEdges& eight : edges_) {
        farUntil = minOf(farUntil, eight.farUntil);
        outsideUntil = minOf(outsideUntil, eight.outsideUntil);
    }
    const double far = std::min({clearance_, window_, double{leastOf(farUntil)}}) - moved_;
    const double outside = (leastOf(outsideUntil) - moved_) * countedOfWay(pair);
    return std::min(far, outside);
}

void FeatureMemory::prefetchLists() const
{
    fetchItems(cornersOfA_);
    fetchItems(cornersOfB_);
    fetchItems(edges_);
}

}  // namespace scree
