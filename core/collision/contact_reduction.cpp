// Symbols: n common normal, d a direction across it, on two axes.
#include "core/collision/contact_reduction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/math/rotation.h"

namespace scree {
namespace {

/// So many of one normal are no burden.
constexpr std::size_t kFew = 8;
/// Cosine of the angle between normals that are one.
constexpr double kOneNormal = 0.995;
/// Where more than so many are left, all around in a nested bowl or plate, those within 20° are
/// about one too. A shelf of crockery had two hundred for each pair, and has fifty: it takes 313
/// instead of 535 ms a frame while that tips, overlaps by as little, and lies still as soon.
constexpr std::size_t kMany = 48;
constexpr double kAboutOneNormal = 0.94;

/// The first direction lies this far off an axis of the body: along one, two corners of a regular
/// body would be as far, and rounding would choose [rad].
constexpr double kOffAxis = 0.15;
/// The lower hull is looked for in these directions, and from so steep that what stands on a boss
/// is seen, to so flat that gaps do not count: lengths per gap. What turns by a sixth of a radian
/// in the step comes down on what is farthest at six: of stones that rolled one in thirty sank by
/// more than half a per cent without, the worst by 2.5 %.
constexpr int kDirections = 8;
constexpr std::array<double, 4> kLengthsPerGap = {1000.0, 30.0, 6.0, 0.0};
/// Gaps that differ by less than this share of the body are one: what lies still must not choose
/// anew for every hair it sinks. But what is deeper by more is pushed out (kSlop): with five times
/// as much a row of corners on the bent underside of a spoon was told at one end only, pushed up
/// there, and then told at the other; a heap of these never lay still.
constexpr double kSameGap = 1e-4;

std::array<Eigen::Vector2d, kDirections> makeDirections()
{
    std::array<Eigen::Vector2d, kDirections> directions;
    for (int k = 0; k < kDirections; ++k) {
        const double angle = kOffAxis + 2.0 * kPi * k / kDirections;
        sinCos(angle, directions[k].y(), directions[k].x());
    }
    return directions;
}

/// A contact among those of its normal.
struct Place {
    std::size_t contact;
    Eigen::Vector2d across;  // [m]
    double height;           // of its gap above the lowest [m]
};

/// A contact that is in no group yet.
struct Ungrouped {
    std::size_t contact;
    Vec3 normal;
};

/// Marks what the contacts of one normal need.
void markHull(const std::vector<GapContact>& contacts, std::vector<Place>& group,
              const Mat3& worldFromBody, double size, std::vector<char>& isKept)
{
    static const std::array<Eigen::Vector2d, kDirections> kAround = makeDirections();
    const Vec3& n = contacts[group[0].contact].normal;
    const int axis = std::abs(worldFromBody.col(0).dot(n)) < 0.8 ? 0 : 1;
    const Vec3 along = worldFromBody.col(axis);
    const Vec3 first = (along - along.dot(n) * n).normalized(), second = n.cross(first);
    std::size_t nearest = group[0].contact;
    for (const Place& place : group) {
        if (contacts[place.contact].gap < contacts[nearest].gap) nearest = place.contact;
    }
    isKept[nearest] = 1;
    const double low = contacts[nearest].gap + kSameGap * size;
    for (Place& place : group) {
        const GapContact& contact = contacts[place.contact];
        place.across = {first.dot(contact.rA), second.dot(contact.rA)};
        place.height = std::max(contact.gap - low, 0.0);
    }
    for (const Eigen::Vector2d& d : kAround) {
        for (const double lengthPerGap : kLengthsPerGap) {
            const Place* farthest = nullptr;
            double most = -std::numeric_limits<double>::infinity();
            for (const Place& place : group) {
                const double reach = d.dot(place.across) - lengthPerGap * place.height;
                if (reach <= most) continue;
                most = reach;
                farthest = &place;
            }
            isKept[farthest->contact] = 1;
        }
    }
}

/// Keeps what is needed of each group of contacts whose normals are about one.
void keepOfGroups(std::vector<GapContact>& contacts, std::size_t first, const Mat3& worldFromBody,
                  double size, double oneNormal)
{
    thread_local std::vector<char> isKept;
    thread_local std::vector<Place> group;
    thread_local std::vector<Ungrouped> left;
    isKept.assign(contacts.size(), 0);
    left.clear();
    for (std::size_t i = first; i < contacts.size(); ++i) left.push_back({i, contacts[i].normal});
    while (!left.empty()) {
        const auto [leader, normal] = left.front();
        group.assign(1, {leader, Eigen::Vector2d::Zero(), 0.0});
        std::size_t stay = 0;
        for (const Ungrouped& one : std::span(left).subspan(1)) {
            if (normal.dot(one.normal) < oneNormal)
                left[stay++] = one;
            else
                group.push_back({one.contact, Eigen::Vector2d::Zero(), 0.0});
        }
        left.resize(stay);
        if (group.size() > kFew) {
            markHull(contacts, group, worldFromBody, size, isKept);
        } else {
            for (const Place& place : group) isKept[place.contact] = 1;
        }
    }
    std::size_t end = first;
    for (std::size_t i = first; i < contacts.size(); ++i) {
        if (isKept[i]) contacts[end++] = contacts[i];
    }
    contacts.resize(end);
}

}  // namespace

void reduceContacts(std::vector<GapContact>& contacts, std::size_t first, const Mat3& worldFromBody,
                    double size)
{
    if (contacts.size() - first <= kFew) return;
    keepOfGroups(contacts, first, worldFromBody, size, kOneNormal);
    if (contacts.size() - first > kMany)
        keepOfGroups(contacts, first, worldFromBody, size, kAboutOneNormal);
}

}  // namespace scree
