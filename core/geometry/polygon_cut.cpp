// A diagonal that touches a corner on its way is none: a library that overlooked that covered the
// notch of an L whose inner corner lies on the line between two others. Corners that were on a line
// before they were rounded to single precision still are: a triangle cut from three of them would
// face anywhere.
#include "core/geometry/polygon_cut.h"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

using Vec2 = Eigen::Vector2d;
using Points2 = Eigen::Matrix<double, 2, Eigen::Dynamic>;

/// Twice the area of a triangle, positive if it turns to the left; 0 where its height is less than
/// `rounding` of its longest side.
double turnOf(const Vec2& a, const Vec2& b, const Vec2& c, double rounding)
{
    const double turn = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return std::abs(turn) > rounding * longest ? turn : 0.0;
}

/// As seen along the axis that it faces most, turning to the left: so coordinates stay what they
/// are, and what lies on a line in them still does.
Points2 flattened(const Points& corners)
{
    Vec3 normal = Vec3::Zero();
    for (Eigen::Index i = 1; i + 1 < corners.cols(); ++i) {
        normal += (corners.col(i) - corners.col(0)).cross(corners.col(i + 1) - corners.col(0));
    }
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    Eigen::Index right = (axis + 1) % 3, up = (axis + 2) % 3;
    if (normal[axis] < 0.0) std::swap(right, up);
    Points2 flat(2, corners.cols());
    flat << corners.row(right), corners.row(up);
    return flat;
}

class EarCutter {
public:
    EarCutter(const Points& corners, double rounding)
        : flat_(flattened(corners)), rounding_(rounding)
    {
        for (int i = 0; i < static_cast<int>(flat_.cols()); ++i) left_.push_back(i);
    }

    std::vector<int> cut()
    {
        std::vector<int> triangles;
        std::size_t at = 1, refused = 0;
        while (left_.size() > 3) {
            at %= left_.size();
            if (isEar(at)) {
                triangles.insert(triangles.end(), {before(at), left_[at], after(at)});
                left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
                refused = 0;
                continue;
            }
            ++at;
            if (++refused > left_.size()) return {};
        }
        if (left_.size() < 3 || !(turnAt(1) > 0.0)) return {};
        triangles.insert(triangles.end(), left_.begin(), left_.end());
        return triangles;
    }

private:
    int before(std::size_t at) const { return left_[(at + left_.size() - 1) % left_.size()]; }
    int after(std::size_t at) const { return left_[(at + 1) % left_.size()]; }
    Vec2 point(int corner) const { return flat_.col(corner); }
    double turnOf(const Vec2& a, const Vec2& b, const Vec2& c) const
    {
        return scree::turnOf(a, b, c, rounding_);
    }
    double turnAt(std::size_t at) const
    {
        return turnOf(point(before(at)), point(left_[at]), point(after(at)));
    }

    /// Whether its triangle has an area, and no corner inside or on its edge but such as lie where
    /// its own do, as those of a slit to a hole.
    bool isEar(std::size_t at) const
    {
        const Vec2 a = point(before(at)), b = point(left_[at]), c = point(after(at));
        if (!(turnOf(a, b, c) > 0.0)) return false;
        for (std::size_t i = 0; i < left_.size(); ++i) {
            if (i == at) continue;
            const Vec2 p = point(left_[i]);
            if (p == a || p == b || p == c) continue;
            if (turnOf(a, b, p) >= 0.0 && turnOf(b, c, p) >= 0.0 && turnOf(c, a, p) >= 0.0)
                return false;
        }
        return true;
    }

    Points2 flat_;
    double rounding_;
    std::vector<int> left_;  // corners that no triangle has cut off yet
};

}  // namespace

std::vector<int> cutPolygon(const Points& corners)
{
    constexpr double kRounding = 1e-6;
    std::vector<int> triangles = EarCutter(corners, kRounding).cut();
    return triangles.empty() ? EarCutter(corners, 0.0).cut() : triangles;
}

}  // namespace scree
