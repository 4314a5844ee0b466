// Scan conversion of triangles into depths, and what is read off a map of them.
#include "render/depth_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/check.h"

namespace scree {
namespace {

/// A corner of a triangle: x and y in texels, texel centres at whole numbers; z depth.
using Corner = Eigen::Vector3f;

/// From the clip cube to texels and depths.
Mat4 texelFromClip(int size)
{
    Mat4 texel = Mat4::Identity();
    texel(0, 0) = texel(1, 1) = 0.5 * size;
    texel(0, 3) = texel(1, 3) = 0.5 * size - 0.5;
    texel(2, 2) = texel(2, 3) = 0.5;
    return texel;
}

/// Twice the signed area, positive for corners in counter-clockwise order.
float signedArea(const Corner& a, const Corner& b, const Corner& c)
{
    return (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
}

/// A value that changes linearly over the map.
struct Ramp {
    float atOrigin = 0.0f, perX = 0.0f, perY = 0.0f;

    float at(int x, int y) const
    {
        return atOrigin + perX * static_cast<float>(x) + perY * static_cast<float>(y);
    }
};

/// Positive to the left of the way from a to b.
Ramp edgeRamp(const Corner& a, const Corner& b)
{
    const float perX = a.y() - b.y(), perY = b.x() - a.x();
    return {-(perX * a.x() + perY * a.y()), perX, perY};
}

/// The depth of the triangle's plane, and how it changes.
Ramp depthRamp(const Corner& a, const Corner& b, const Corner& c, float area)
{
    const Corner u = b - a, v = c - a;
    const float perX = (u.z() * v.y() - v.z() * u.y()) / area;
    const float perY = (v.z() * u.x() - u.z() * v.x()) / area;
    return {a.z() - perX * a.x() - perY * a.y(), perX, perY};
}

/// Texels of a row that are drawn at once, as many as a register holds.
constexpr int kBlock = kFewestMapTexels;

float leastOf(float a, float b, float c)
{
    return std::min(a, std::min(b, c));
}

float greatestOf(float a, float b, float c)
{
    return std::max(a, std::max(b, c));
}

void drawTriangle(DepthMap& map, const Corner& a, Corner b, Corner c, float area, float slopeBias)
{
    const int last = map.size - 1;
    const auto clamped = [&](float value) {
        return static_cast<int>(std::clamp(value, -1.0f, static_cast<float>(map.size)));
    };
    const int firstX = std::max(clamped(std::ceil(leastOf(a.x(), b.x(), c.x()))), 0);
    const int lastX = std::min(clamped(std::floor(greatestOf(a.x(), b.x(), c.x()))), last);
    const int firstY = std::max(clamped(std::ceil(leastOf(a.y(), b.y(), c.y()))), 0);
    const int lastY = std::min(clamped(std::floor(greatestOf(a.y(), b.y(), c.y()))), last);
    if (firstX > lastX || firstY > lastY) return;
    if (area < 0.0f) {
        std::swap(b, c);
        area = -area;
    }

    // A texel belongs to every triangle that touches its centre: no edge leaves a gap.
    const std::array<Ramp, 3> edges = {edgeRamp(a, b), edgeRamp(b, c), edgeRamp(c, a)};
    const Ramp depth = depthRamp(a, b, c, area);
    const float bias = slopeBias * std::max(std::abs(depth.perX), std::abs(depth.perY));
    // Far from the triangle's own corners a steep plane is nowhere: its depths stay among theirs.
    const float least = std::max(leastOf(a.z(), b.z(), c.z()), 0.0f);
    for (int y = firstY; y <= lastY; ++y) {
        float* row = map.depths.data() + static_cast<std::size_t>(y) * map.size;
        const float e0 = edges[0].at(0, y), e1 = edges[1].at(0, y), e2 = edges[2].at(0, y);
        const float z0 = depth.at(0, y);
        // Whole blocks, the last one moved back into the row: most triangles are narrower than a
        // block, and what is done twice or outside the triangle changes nothing.
        for (int x = firstX; x <= lastX; x += kBlock) {
            const int begin = std::min(x, map.size - kBlock);
            for (int k = begin; k < begin + kBlock; ++k) {
                const float place = static_cast<float>(k);
                const float inside = leastOf(e0 + edges[0].perX * place, e1 + edges[1].perX * place,
                                             e2 + edges[2].perX * place);
                const float z = std::max(z0 + depth.perX * place, least) + bias;
                row[k] = inside >= 0.0f ? std::min(row[k], z) : row[k];
            }
        }
    }
}

/// The points of a mesh in texels and depths. Only a camera's projection divides.
std::vector<Corner> cornersOf(const ShadedMesh& mesh, const Mat4& texelFromAsset)
{
    const Eigen::Matrix4f single = texelFromAsset.cast<float>();
    const Eigen::RowVector4f last = single.row(3);
    const bool isParallel = last == Eigen::RowVector4f(0.0f, 0.0f, 0.0f, 1.0f);
    std::vector<Corner> corners(mesh.points.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = single.topLeftCorner<3, 3>() * mesh.points[i] + single.topRightCorner<3, 1>();
        if (!isParallel) corners[i] /= last.head<3>().dot(mesh.points[i]) + last.w();
    }
    return corners;
}

/// Whether no texel around the corners, and one more each way against rounding, is as deep as the
/// nearest of them.
bool isHidden(const DepthMap& map, const std::vector<Corner>& corners)
{
    Corner least = Corner::Constant(std::numeric_limits<float>::max()), greatest = -least;
    for (const Corner& corner : corners) {
        least = least.cwiseMin(corner);
        greatest = greatest.cwiseMax(corner);
    }
    const auto texel = [&](float place) {
        return static_cast<int>(std::clamp(place, -2.0f, static_cast<float>(map.size) + 1.0f));
    };
    const int firstX = std::max(texel(std::floor(least.x())), 0);
    const int lastX = std::min(texel(std::ceil(greatest.x())), map.size - 1);
    const int firstY = std::max(texel(std::floor(least.y())), 0);
    const int lastY = std::min(texel(std::ceil(greatest.y())), map.size - 1);
    bool isSeen = false;
    for (int y = firstY; y <= lastY && !isSeen; ++y) {
        const float* row = map.depths.data() + static_cast<std::size_t>(y) * map.size;
        for (int x = firstX; x <= lastX; ++x) isSeen |= row[x] > least.z();
    }
    return !isSeen;
}

/// The weights of the blur; their sum is 1.
constexpr int kReach = 5;

std::array<float, 2 * kReach + 1> blurWeights()
{
    constexpr double kSigma = 2.2;  // in taps
    std::array<double, 2 * kReach + 1> weights;
    double sum = 0.0;
    for (int k = -kReach; k <= kReach; ++k) {
        weights[k + kReach] = std::exp(-k * k / (2.0 * kSigma * kSigma));
        sum += weights[k + kReach];
    }
    std::array<float, 2 * kReach + 1> result;
    for (std::size_t k = 0; k < weights.size(); ++k)
        result[k] = static_cast<float>(weights[k] / sum);
    return result;
}

/// Blurs along x or along y. Outside the map its border goes on.
void blurAlong(const std::vector<float>& source, std::vector<float>& target, int size, int stride,
               bool alongX)
{
    static const std::array<float, 2 * kReach + 1> weights = blurWeights();
    target.assign(source.size(), 0.0f);
    for (int k = -kReach; k <= kReach; ++k) {
        const float weight = weights[k + kReach];
        for (int y = 0; y < size; ++y) {
            const int fromY = alongX ? y : std::clamp(y + k * stride, 0, size - 1);
            const float* from = source.data() + static_cast<std::size_t>(fromY) * size * 2;
            float* to = target.data() + static_cast<std::size_t>(y) * size * 2;
            for (int x = 0; x < size; ++x) {
                const int fromX = alongX ? std::clamp(x + k * stride, 0, size - 1) : x;
                to[2 * x] += weight * from[2 * fromX];
                to[2 * x + 1] += weight * from[2 * fromX + 1];
            }
        }
    }
}

}  // namespace

void clearDepths(DepthMap& map, int size)
{
    SCREE_CHECK(size >= kFewestMapTexels, "a map of " + std::to_string(size) + " texels");
    map.size = size;
    map.depths.assign(static_cast<std::size_t>(size) * size, 1.0f);
}

bool drawDepths(DepthMap& map, const ShadedMesh& mesh, const Mat4& clipFromAsset, double slopeBias)
{
    const std::vector<Corner> corners = cornersOf(mesh, texelFromClip(map.size) * clipFromAsset);
    if (isHidden(map, corners)) return false;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Corner &a = corners[mesh.indices[i]], &b = corners[mesh.indices[i + 1]],
                     &c = corners[mesh.indices[i + 2]];
        const float area = signedArea(a, b, c);
        if (mesh.isClosed ? area > 0.0f : area != 0.0f)
            drawTriangle(map, a, b, c, area, static_cast<float>(slopeBias));
    }
    return true;
}

void drawPlaneDepths(DepthMap& map, const PlaneSurface& plane, const Mat4& clipFromWorld)
{
    // In the clip cube the plane is n · x = d; the light looks along +z.
    const Mat4 texelFromWorld = texelFromClip(map.size) * clipFromWorld;
    const Mat3 linear = texelFromWorld.topLeftCorner<3, 3>();
    const Vec3 n = linear.inverse().transpose() * plane.normal;
    const Vec3 point = linear * plane.point + texelFromWorld.topRightCorner<3, 1>();
    if (!(n.z() < 0.0) || !n.allFinite() || !point.allFinite()) return;
    for (int y = 0; y < map.size; ++y) {
        float* row = map.depths.data() + static_cast<std::size_t>(y) * map.size;
        for (int x = 0; x < map.size; ++x) {
            const double z =
                point.z() - (n.x() * (x - point.x()) + n.y() * (y - point.y())) / n.z();
            row[x] = std::min(row[x], static_cast<float>(std::clamp(z, 0.0, 1.0)));
        }
    }
}

DepthBounds boundDepths(const DepthMap& map)
{
    constexpr int kTile = DepthBounds::kTileTexels;
    const int size = (map.size + kTile - 1) / kTile;
    std::vector<float> tiles(static_cast<std::size_t>(size) * size * 2);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            float least = 1.0f, greatest = 0.0f;
            for (int row = y * kTile; row < std::min((y + 1) * kTile, map.size); ++row) {
                const float* depths = map.depths.data() + static_cast<std::size_t>(row) * map.size;
                for (int column = x * kTile; column < std::min((x + 1) * kTile, map.size);
                     ++column) {
                    least = std::min(least, depths[column]);
                    greatest = std::max(greatest, depths[column]);
                }
            }
            tiles[2 * (static_cast<std::size_t>(y) * size + x)] = least;
            tiles[2 * (static_cast<std::size_t>(y) * size + x) + 1] = greatest;
        }
    }

    // Widen by a tile each way; beyond the map nothing is.
    DepthBounds bounds{size, tiles};
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const std::size_t here = 2 * (static_cast<std::size_t>(y) * size + x);
            const bool isAtBorder = x == 0 || y == 0 || x == size - 1 || y == size - 1;
            float least = 1.0f, greatest = isAtBorder ? 1.0f : 0.0f;
            for (int row = std::max(y - 1, 0); row <= std::min(y + 1, size - 1); ++row) {
                for (int column = std::max(x - 1, 0); column <= std::min(x + 1, size - 1);
                     ++column) {
                    const std::size_t tile = 2 * (static_cast<std::size_t>(row) * size + column);
                    least = std::min(least, tiles[tile]);
                    greatest = std::max(greatest, tiles[tile + 1]);
                }
            }
            bounds.values[here] = least;
            bounds.values[here + 1] = greatest;
        }
    }
    return bounds;
}

DepthMoments momentsOf(const DepthMap& map)
{
    DepthMoments moments{map.size, std::vector<float>(map.depths.size() * 2)};
    for (std::size_t i = 0; i < map.depths.size(); ++i) {
        moments.values[2 * i] = map.depths[i];
        moments.values[2 * i + 1] = map.depths[i] * map.depths[i];
    }
    return moments;
}

DepthMoments blurred(const DepthMoments& moments, int stride)
{
    DepthMoments rows{moments.size, {}}, result{moments.size, {}};
    blurAlong(moments.values, rows.values, moments.size, stride, true);
    blurAlong(rows.values, result.values, moments.size, stride, false);
    return result;
}

}  // namespace scree
