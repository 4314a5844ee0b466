#include "io/keys_between.h"

#include <algorithm>

namespace scree {
namespace {

constexpr double kStray = 1.0 / 200.0;    // of the way; an arc of 2.3 degrees strays so far
constexpr double kRounding = 1e-5;        // relative; of products of single precision
constexpr double kRoundingOfTurn = 1e-3;  // [rad]; of the same
constexpr int kMostHalvings = 8;          // a half turn between two keys needs seven

/// The angle between two orientations that are near each other [rad].
double angleBetween(const Quat& a, const Quat& b)
{
    return 2.0 * std::min((a.coeffs() - b.coeffs()).norm(), (a.coeffs() + b.coeffs()).norm());
}

/// Where one is that goes steadily from a to b, at half time.
Pose halfWay(const Pose& a, const Pose& b)
{
    const double sign = a.orientation.dot(b.orientation) < 0.0 ? -1.0 : 1.0;
    const Quat sum(a.orientation.coeffs() + sign * b.orientation.coeffs());
    return {0.5 * (a.position + b.position), sum.normalized()};
}

class Filling {
public:
    explicit Filling(const std::function<Pose(double)>& poseAt) : poseAt_(poseAt) {}

    /// Adds what lies between two keys.
    void fill(const ImportedKey& from, const ImportedKey& to, int halvings)
    {
        const ImportedKey middle{halfTime(from, to), poseAt_(halfTime(from, to)), true};
        // A way that crosses the straight one half way is found a quarter of the way along.
        const Pose half = halfWay(from.fileFromNode, to.fileFromNode);
        const Pose quarter = halfWay(from.fileFromNode, half);
        const double quarterTime = halfTime(from, middle);
        const bool strays = isAway(middle.fileFromNode, half, from, to) ||
                            isAway(poseAt_(quarterTime), quarter, from, to);
        if (!strays || halvings == 0) return;
        fill(from, middle, halvings - 1);
        keys.push_back(middle);
        fill(middle, to, halvings - 1);
    }

    std::vector<ImportedKey> keys;

private:
    static double halfTime(const ImportedKey& from, const ImportedKey& to)
    {
        return 0.5 * (from.seconds + to.seconds);
    }

    /// Whether the pose between two keys is another than the straight way has it.
    static bool isAway(const Pose& is, const Pose& straight, const ImportedKey& from,
                       const ImportedKey& to)
    {
        const Vec3 &a = from.fileFromNode.position, &b = to.fileFromNode.position;
        const double way = (is.position - a).norm() + (b - is.position).norm();
        const double turn = angleBetween(from.fileFromNode.orientation, is.orientation) +
                            angleBetween(is.orientation, to.fileFromNode.orientation);
        return (is.position - straight.position).norm() >
                   std::max(kStray * way, kRounding * (a.norm() + b.norm())) ||
               angleBetween(is.orientation, straight.orientation) >
                   std::max(kStray * turn, kRoundingOfTurn);
    }

    const std::function<Pose(double)>& poseAt_;
};

}  // namespace

std::vector<ImportedKey> keysAlong(const std::set<double>& moments,
                                   const std::function<Pose(double)>& poseAt)
{
    Filling filling(poseAt);
    for (const double moment : moments) {
        const ImportedKey key{moment, poseAt(moment)};
        if (!filling.keys.empty()) {
            const ImportedKey before = filling.keys.back();
            filling.fill(before, key, kMostHalvings);
        }
        filling.keys.push_back(key);
    }
    return filling.keys;
}

}  // namespace scree
