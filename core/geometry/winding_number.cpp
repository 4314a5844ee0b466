// Symbols: a, b, c corners of a triangle seen from the point.
#include "core/geometry/winding_number.h"

#include <algorithm>
#include <cmath>

#include "core/math/rotation.h"

namespace scree {
namespace {

constexpr int kMostInLeaf = 8;
constexpr double kFarRadii = 3.0;  // a cluster farther off than this counts as one flux

}  // namespace

/// Many angles, each that of a vector, taken together: directions multiply like complex numbers,
/// and how often they have gone around is counted. With an arc tangent for each triangle a lattice
/// of a million nodes took 8 s.
class WindingNumber::AngleSum {
public:
    /// The angle of (x, y) from +x; y is not 0.
    void add(double x, double y)
    {
        const double nextX = x_ * x - y_ * y, nextY = x_ * y + y_ * x;
        if (y_ >= 0.0 && y > 0.0 && nextY < 0.0) ++turns_;
        if (y_ < 0.0 && y < 0.0 && nextY >= 0.0) --turns_;
        const double size = std::abs(nextX) + std::abs(nextY);
        if (!(size > 0.0)) return;
        x_ = nextX / size;
        y_ = nextY / size;
    }

    double total() const
    {
        double angle = 0.5 * kPi;
        if (x_ > 0.0) angle = arcTangent(std::abs(y_) / x_);
        if (x_ < 0.0) angle = kPi - arcTangent(std::abs(y_) / -x_);
        return 2.0 * kPi * turns_ + (y_ < 0.0 ? -angle : angle);
    }

private:
    double x_ = 1.0, y_ = 0.0;
    int turns_ = 0;
};

WindingNumber::WindingNumber(const TriMesh& mesh)
    : mesh_(mesh), centroids_(3, mesh.triangles.cols()), order_(mesh.triangles.cols())
{
    for (int f = 0; f < static_cast<int>(order_.size()); ++f) {
        order_[f] = f;
        Vec3 sum = Vec3::Zero();
        for (int k = 0; k < 3; ++k) sum += mesh.points.col(mesh.triangles(k, f));
        centroids_.col(f) = sum / 3.0;
    }
    if (!order_.empty()) build(0, static_cast<int>(order_.size()));
}

int WindingNumber::build(int begin, int end)
{
    Node node;
    node.begin = begin;
    node.end = end;
    Vec3 low = centroids_.col(order_[begin]), high = low, weighted = Vec3::Zero();
    double area = 0.0;
    for (int i = begin; i < end; ++i) {
        const Vec3 flux = cornersOf(mesh_, order_[i]).areaVector();
        const Vec3 centroid = centroids_.col(order_[i]);
        node.flux += flux;
        weighted += flux.norm() * centroid;
        area += flux.norm();
        low = low.cwiseMin(centroid);
        high = high.cwiseMax(centroid);
    }
    node.centre = area > 0.0 ? (weighted / area).eval() : (0.5 * (low + high)).eval();
    for (int i = begin; i < end; ++i) {
        for (int k = 0; k < 3; ++k) {
            const Vec3 corner = mesh_.points.col(mesh_.triangles(k, order_[i]));
            node.radius = std::max(node.radius, (corner - node.centre).norm());
        }
    }
    const int index = static_cast<int>(nodes_.size());
    nodes_.push_back(node);
    if (end - begin <= kMostInLeaf) return index;

    int axis = 0;
    (high - low).maxCoeff(&axis);
    const int middle = (begin + end) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](int f, int g) {
                         const double x = centroids_(axis, f), y = centroids_(axis, g);
                         return x < y || (x == y && f < g);
                     });
    const int left = build(begin, middle), right = build(middle, end);
    nodes_[index].left = left;
    nodes_[index].right = right;
    return index;
}

// Half of it. [OS83]
void WindingNumber::addSolidAngle(int triangle, const Vec3& point, AngleSum& sum) const
{
    const auto [a, b, c] = cornersOf(mesh_, triangle).seenFrom(point);
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    const double volume = a.dot(b.cross(c));
    const double rest = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    if (volume != 0.0) sum.add(rest, volume);
}

double WindingNumber::at(const Vec3& point) const
{
    if (nodes_.empty()) return 0.0;
    double far = 0.0;
    AngleSum near;
    thread_local std::vector<int> open;
    open.assign(1, 0);
    while (!open.empty()) {
        const Node& node = nodes_[open.back()];
        open.pop_back();
        const Vec3 way = node.centre - point;
        const double distance = way.norm();
        if (distance > kFarRadii * node.radius) {
            far += way.dot(node.flux) / (distance * distance * distance);
        } else if (node.left < 0) {
            for (int i = node.begin; i < node.end; ++i) addSolidAngle(order_[i], point, near);
        } else {
            open.push_back(node.right);
            open.push_back(node.left);
        }
    }
    return (far + 2.0 * near.total()) / (4.0 * kPi);
}

}  // namespace scree
