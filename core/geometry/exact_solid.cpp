// Symbols: s excess, how far a point lies beyond a face; rho distance from the cylinder's axis.
#include "core/geometry/exact_solid.h"

#include <limits>

#include "core/base/check.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// Away from the cylinder's axis; +x on it.
Vec3 radial(const Vec3& point)
{
    const Vec3 across(point.x(), 0.0, point.z());
    const double rho = across.norm();
    return rho > 0.0 ? Vec3(across / rho) : Vec3(Vec3::UnitX());
}

/// The part [enter, leave] of a straight way that lies inside something convex, in units of the
/// way's parameter.
struct Interval {
    double enter = -std::numeric_limits<double>::infinity();
    double leave = std::numeric_limits<double>::infinity();

    void cutTo(double low, double high)
    {
        enter = std::max(enter, low);
        leave = std::min(leave, high);
    }
};

/// |start + t speed| ≤ half.
void cutToSlab(double start, double speed, double half, Interval& inside)
{
    if (speed == 0.0) {
        if (std::abs(start) > half) inside.cutTo(1.0, 0.0);
        return;
    }
    const double a = (-half - start) / speed, b = (half - start) / speed;
    inside.cutTo(std::min(a, b), std::max(a, b));
}

/// |start + t speed| ≤ radius for vectors.
void cutToBall(const Vec3& start, const Vec3& speed, double radius, Interval& inside)
{
    const double a = speed.squaredNorm(), b = start.dot(speed);
    const double c = start.squaredNorm() - radius * radius;
    if (a == 0.0) {
        if (c > 0.0) inside.cutTo(1.0, 0.0);
        return;
    }
    const double discriminant = b * b - a * c;
    if (discriminant <= 0.0) {
        inside.cutTo(1.0, 0.0);
        return;
    }
    const double root = std::sqrt(discriminant);
    inside.cutTo((-b - root) / a, (-b + root) / a);
}

}  // namespace

Aabb ExactSolid::box() const
{
    return form_ == Form::plane ? Aabb::everything() : Aabb{-half_, half_};
}

double ExactSolid::boundingRadius() const
{
    if (form_ == Form::sphere) return half_.x();
    return form_ == Form::box ? half_.norm()
                              : std::sqrt(half_.x() * half_.x() + half_.y() * half_.y());
}

MassProperties ExactSolid::massProperties() const
{
    SCREE_CHECK(form_ != Form::plane, "a plane has no mass");
    MassProperties mass;
    const double r = half_.x(), h = 2.0 * half_.y();
    const Vec3 squares = 4.0 * half_.cwiseAbs2();
    switch (form_) {
        case Form::sphere:
            mass.volume = 4.0 / 3.0 * kPi * r * r * r;
            mass.area = 4.0 * kPi * r * r;
            mass.moments = Vec3::Constant(0.4 * mass.volume * r * r);
            break;
        case Form::box:
            mass.volume = 8.0 * half_.prod();
            mass.area =
                8.0 * (half_.x() * half_.y() + half_.y() * half_.z() + half_.z() * half_.x());
            mass.moments = mass.volume / 12.0 * (Vec3::Constant(squares.sum()) - squares);
            break;
        default:
            mass.volume = kPi * r * r * h;
            mass.area = 2.0 * kPi * r * (r + h);
            const double across = mass.volume / 12.0 * (3.0 * r * r + h * h);
            mass.moments = {across, 0.5 * mass.volume * r * r, across};
    }
    return mass;
}

Vec3 ExactSolid::gradient(const Vec3& point) const
{
    if (form_ == Form::plane) return Vec3::UnitY();
    if (form_ == Form::sphere) {
        const double distance = point.norm();
        return distance > 0.0 ? Vec3(point / distance) : Vec3(Vec3::UnitY());
    }
    // Columns are the outward normals of the nearest faces, entries of s how far the point lies
    // beyond them.
    Mat3 normals;
    Vec3 s;
    if (form_ == Form::box) {
        normals = Vec3(std::copysign(1.0, point.x()), std::copysign(1.0, point.y()),
                       std::copysign(1.0, point.z()))
                      .asDiagonal();
        s = point.cwiseAbs() - half_;
    } else {
        normals.col(0) = radial(point);
        normals.col(1) = Vec3(0.0, std::copysign(1.0, point.y()), 0.0);
        normals.col(2) = Vec3::Zero();
        s = {normals.col(0).dot(point) - half_.x(), std::abs(point.y()) - half_.y(),
             -std::numeric_limits<double>::infinity()};
    }
    Eigen::Index nearest = 0;
    if (s.maxCoeff(&nearest) <= 0.0) return normals.col(nearest);
    return (normals * s.cwiseMax(0.0)).normalized();
}

double ExactSolid::meanCurvature(const Vec3& point) const
{
    if (form_ == Form::sphere) return 1.0 / half_.x();
    if (form_ != Form::cylinder) return 0.0;
    const double side = radial(point).dot(point) - half_.x();
    const double cap = std::abs(point.y()) - half_.y();
    // Contacts at a rim are a little inside: a barrel on its side was braked as if it stood.
    constexpr double kRim = 1e-3;
    if (std::abs(side - cap) < kRim * half_.x()) return std::numeric_limits<double>::infinity();
    return side >= cap ? 0.5 / half_.x() : 0.0;
}

std::optional<Vec3> ExactSolid::entry(const Vec3& from, const Vec3& to, double slack) const
{
    SCREE_CHECK(form_ != Form::plane, "no way enters a plane's shape");
    const double length = (to - from).norm();
    if (length < 1e-9 * slack) return std::nullopt;
    const Vec3 direction = (to - from) / length;
    const Vec3 start = from - slack * direction;
    Interval inside;
    if (form_ == Form::sphere) {
        cutToBall(start, direction, half_.x(), inside);
    } else if (form_ == Form::cylinder) {
        cutToSlab(start.y(), direction.y(), half_.y(), inside);
        cutToBall({start.x(), 0.0, start.z()}, {direction.x(), 0.0, direction.z()}, half_.x(),
                  inside);
    } else {
        for (int k = 0; k < 3; ++k) cutToSlab(start[k], direction[k], half_[k], inside);
    }
    const bool enters =
        inside.enter < inside.leave && inside.enter >= 0.0 && inside.enter <= length + 2.0 * slack;
    if (!enters) return std::nullopt;
    return start + inside.enter * direction;
}

void ExactSolid::facesNear(const Vec3& point, double tolerance, std::vector<NearFace>& faces) const
{
    const auto take = [&](double excess, const Vec3& normal) {
        if (std::abs(excess) <= tolerance) faces.push_back({normal, kPi, excess, std::abs(excess)});
    };
    switch (form_) {
        case Form::plane:
            take(point.y(), Vec3::UnitY());
            break;
        case Form::sphere:
            take(value(point), gradient(point));
            break;
        case Form::box:
            for (int k = 0; k < 3; ++k) {
                take(std::abs(point[k]) - half_[k], std::copysign(1.0, point[k]) * Vec3::Unit(k));
            }
            break;
        case Form::cylinder: {
            const Vec3 out = radial(point);
            take(out.dot(point) - half_.x(), out);
            take(std::abs(point.y()) - half_.y(), {0.0, std::copysign(1.0, point.y()), 0.0});
        }
    }
}

}  // namespace scree
