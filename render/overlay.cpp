#include "render/overlay.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace scree {
namespace {

using Vec2 = Eigen::Vector2d;

/// Closer to the eye than this share of the distance to the target, nothing is drawn.
constexpr double kNearest = 1e-3;

/// Lines of more pixels than a few pictures come from marks almost beside the eye.
constexpr double kFarOutside = 4.0;

class Projection {
public:
    Projection(const Image& image, const Camera& camera)
        : width_(image.width), height_(image.height), viewFromWorld_(viewFromWorld(camera))
    {
        const double distance = std::max((camera.eye - camera.target).norm(), 1e-6);
        nearest_ = kNearest * distance;
        clipFromView_ =
            clipFromView(camera, static_cast<double>(width_) / height_, {nearest_, 1e3 * distance});
    }

    /// Where a point is in the picture [pixels, y downwards]; nothing for points behind the eye.
    std::optional<Vec2> pixelOf(const Vec3& point) const
    {
        const Eigen::Vector4d view = viewFromWorld_ * point.homogeneous();
        if (-view.z() < nearest_) return {};
        const Vec3 clip = (clipFromView_ * view).hnormalized();
        const Vec2 pixel(0.5 * (1.0 + clip.x()) * width_, 0.5 * (1.0 - clip.y()) * height_);
        const double reach = kFarOutside * (width_ + height_);
        if (!(pixel.cwiseAbs().maxCoeff() < reach)) return {};
        return pixel;
    }

private:
    int width_, height_;
    double nearest_ = 0.0;
    Mat4 viewFromWorld_, clipFromView_;
};

/// Width of a line in a picture of this size [pixels].
double lineWidth(const Image& image)
{
    return std::max(1.2, image.height / 450.0);
}

double distanceToSegment(const Vec2& p, const Vec2& from, const Vec2& to)
{
    const Vec2 along = to - from;
    const double squared = along.squaredNorm();
    const double share =
        squared > 0.0 ? std::clamp((p - from).dot(along) / squared, 0.0, 1.0) : 0.0;
    return (p - from - share * along).norm();
}

}  // namespace

void drawLine(Image& image, const Vec2& from, const Vec2& to, double width, const Color& color)
{
    const double reach = 0.5 * width + 0.5;
    const Vec2 low = from.cwiseMin(to).array() - reach, high = from.cwiseMax(to).array() + reach;
    const int top = std::max(0, static_cast<int>(std::floor(low.y())));
    const int bottom = std::min(image.height - 1, static_cast<int>(std::ceil(high.y())));
    const int left = std::max(0, static_cast<int>(std::floor(low.x())));
    const int right = std::min(image.width - 1, static_cast<int>(std::ceil(high.x())));
    for (int y = top; y <= bottom; ++y) {
        for (int x = left; x <= right; ++x) {
            const double away = distanceToSegment({x + 0.5, y + 0.5}, from, to);
            const double cover = std::clamp(reach - away, 0.0, 1.0);
            if (cover <= 0.0) continue;
            const auto opacity = static_cast<float>(cover);
            image.set(x, y, (1.0f - opacity) * image.at(x, y) + opacity * color);
        }
    }
}

void drawContacts(Image& image, const Camera& camera, const std::vector<ContactMark>& marks)
{
    const Projection projection(image, camera);
    const double width = lineWidth(image);
    const auto drawVectors = [&](Vec3 ContactMark::*vector, const Color& color) {
        for (const ContactMark& mark : marks) {
            const auto from = projection.pixelOf(mark.point);
            const auto to = projection.pixelOf(mark.point + mark.*vector);
            if (from && to) drawLine(image, *from, *to, width, color);
        }
    };
    drawVectors(&ContactMark::normal, kNormalColor);
    drawVectors(&ContactMark::force, kForceColor);
    for (const ContactMark& mark : marks)
        if (const auto pixel = projection.pixelOf(mark.point))
            drawLine(image, *pixel, *pixel, 2.5 * width, kContactColor);
}

}  // namespace scree
