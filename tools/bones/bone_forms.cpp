// Axes: x to the front, y up, z to the side; everything is symmetric in z. Lengths in metres.
#include "tools/bones/bone_forms.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace scree {
namespace {

Vec3 mirrored(const Vec3& p)
{
    return {p.x(), p.y(), std::abs(p.z())};
}

/// Union whose seam is filled to a radius of about `blend` [m].
double join(double a, double b, double blend)
{
    const double h = std::max(blend - std::abs(a - b), 0.0) / blend;
    return std::min(a, b) - 0.25 * h * h * blend;
}

/// What of `a` lies outside `b`, its rim rounded.
double cut(double a, double b, double blend)
{
    return -join(-a, b, blend);
}

double ball(const Vec3& p, const Vec3& centre, double radius)
{
    return (p - centre).norm() - radius;
}

/// Exact on the surface and right in sign everywhere; close to distance for round ones.
double ellipsoid(const Vec3& p, const Vec3& centre, const Vec3& radii)
{
    const Vec3 d = p - centre;
    const double k0 = d.cwiseQuotient(radii).norm();
    const double k1 = d.cwiseQuotient(radii.cwiseProduct(radii)).norm();
    if (k1 == 0.0) return -radii.minCoeff();
    return k0 * (k0 - 1.0) / k1;
}

struct Knot {
    Vec3 at;
    double radius;
};

/// A rod from knot to knot whose radius goes from one's to the other's.
double rod(const Vec3& p, const Knot& a, const Knot& b)
{
    const Vec3 along = b.at - a.at;
    const double t = std::clamp((p - a.at).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (p - a.at - t * along).norm() - (a.radius + t * (b.radius - a.radius));
}

double chain(const Vec3& p, std::initializer_list<Knot> knots)
{
    double phi = 1e9;
    for (const Knot* knot = knots.begin(); knot + 1 != knots.end(); ++knot) {
        phi = std::min(phi, rod(p, knot[0], knot[1]));
    }
    return phi;
}

double skull(const Vec3& q)
{
    const Vec3 p = mirrored(q);
    const Vec3 brain(-0.06, 0.06, 0.0);
    const double vault = ellipsoid(p, brain, {0.25, 0.20, 0.185});
    const double hollow = ellipsoid(p, brain, {0.19, 0.14, 0.125});

    // The face: brow, cheeks, upper jaw, and a jaw bone that hangs from two hinges.
    double phi = join(vault, ellipsoid(p, {0.11, -0.09, 0.0}, {0.125, 0.13, 0.135}), 0.08);
    phi = join(phi, rod(p, {{0.165, 0.02, 0.0}, 0.035}, {{0.13, 0.02, 0.12}, 0.03}), 0.04);
    phi = join(phi, ellipsoid(p, {0.17, -0.19, 0.0}, {0.07, 0.06, 0.085}), 0.05);
    const double arch = chain(p, {{{0.15, -0.09, 0.125}, 0.03},
                                  {{0.06, -0.085, 0.195}, 0.027},
                                  {{-0.07, -0.05, 0.175}, 0.03}});
    phi = join(phi, arch, 0.03);
    const double jaw = chain(p, {{{-0.02, -0.06, 0.15}, 0.03},
                                 {{0.00, -0.26, 0.135}, 0.034},
                                 {{0.14, -0.315, 0.085}, 0.036},
                                 {{0.21, -0.325, 0.0}, 0.04}});
    phi = join(phi, jaw, 0.03);

    // Everything that is open: brain case, eyes and nose into it, the way out below.
    phi = cut(phi, hollow, 0.02);
    phi = cut(phi, rod(p, {{0.27, -0.035, 0.098}, 0.058}, {{0.10, -0.01, 0.062}, 0.040}), 0.03);
    phi = cut(phi, rod(p, {{0.30, -0.130, 0.0}, 0.032}, {{0.08, -0.05, 0.0}, 0.028}), 0.02);
    phi = cut(phi, rod(p, {{-0.10, 0.0, 0.0}, 0.055}, {{-0.10, -0.30, 0.0}, 0.06}), 0.03);

    // Upper teeth.
    for (int i = 0; i < 4; ++i) {
        const double a = 0.30 * (i + 0.5);
        const Vec3 root(0.155 + 0.075 * std::cos(a), 0.0, 0.085 * std::sin(a));
        phi = join(phi, ball(p, root + Vec3(0.0, -0.235, 0.0), 0.024), 0.006);
    }
    return phi;
}

/// A plate of the sphere about `centre`, bounded by an ellipsoid.
double blade(const Vec3& p, const Vec3& centre, double radius, double thickness, double bound)
{
    const double sheet = std::abs((p - centre).norm() - radius) - 0.5 * thickness;
    return -join(-sheet, -bound, 0.04);
}

double pelvis(const Vec3& q)
{
    const Vec3 p = mirrored(q);

    // The brim, a ring tilted down to the front, closed by the sacrum behind.
    double phi = chain(p, {{{-0.17, 0.05, 0.0}, 0.05},
                           {{-0.15, 0.05, 0.10}, 0.045},
                           {{-0.06, 0.01, 0.165}, 0.04},
                           {{0.05, -0.06, 0.155}, 0.045},
                           {{0.13, -0.11, 0.08}, 0.032},
                           {{0.15, -0.125, 0.0}, 0.036}});
    const double sacrum = chain(p, {{{-0.17, 0.13, 0.0}, 0.065},
                                    {{-0.21, 0.03, 0.0}, 0.055},
                                    {{-0.215, -0.07, 0.0}, 0.04},
                                    {{-0.175, -0.15, 0.0}, 0.028}});
    phi = join(phi, sacrum, 0.05);

    // A wing on each side, a curved blade with a thick crest.
    const double outline = ellipsoid(p, {-0.03, 0.15, 0.20}, {0.19, 0.155, 0.14});
    phi = join(phi, blade(p, {0.10, 0.36, -0.06}, 0.325, 0.055, outline), 0.04);
    const double crest = chain(p, {{{-0.19, 0.16, 0.11}, 0.036},
                                   {{-0.16, 0.25, 0.17}, 0.03},
                                   {{-0.06, 0.29, 0.245}, 0.03},
                                   {{0.05, 0.235, 0.275}, 0.03},
                                   {{0.115, 0.12, 0.245}, 0.034}});
    phi = join(phi, crest, 0.04);

    // The seat: a loop below each hip that leaves a hole.
    const double seat = chain(p, {{{0.03, -0.08, 0.165}, 0.05},
                                  {{-0.07, -0.16, 0.165}, 0.036},
                                  {{-0.055, -0.265, 0.135}, 0.042},
                                  {{0.06, -0.245, 0.09}, 0.029},
                                  {{0.145, -0.15, 0.025}, 0.034}});
    phi = join(phi, seat, 0.03);

    // The socket of the hip.
    phi = join(phi, ball(p, {0.02, -0.055, 0.195}, 0.075), 0.03);
    return cut(phi, ball(p, {0.035, -0.075, 0.25}, 0.062), 0.015);
}

double femur(const Vec3& p)
{
    // Bowed to the front; the head looks to +z.
    double phi = chain(p, {{{0.0, 0.27, -0.02}, 0.046},
                           {{0.02, 0.12, -0.012}, 0.034},
                           {{0.028, -0.03, 0.0}, 0.032},
                           {{0.018, -0.18, 0.006}, 0.036},
                           {{-0.005, -0.30, 0.01}, 0.054}});
    phi = join(phi, rod(p, {{0.0, 0.265, -0.02}, 0.046}, {{0.0, 0.335, 0.075}, 0.033}), 0.04);
    phi = join(phi, ball(p, {0.0, 0.35, 0.098}, 0.062), 0.015);
    phi = join(phi, ellipsoid(p, {-0.012, 0.318, -0.045}, {0.044, 0.06, 0.034}), 0.03);
    phi = join(phi, ball(p, {-0.035, 0.215, 0.012}, 0.032), 0.03);

    // Two condyles with a groove between them, in front and behind.
    for (const double side : {-1.0, 1.0}) {
        const Vec3 knuckle(-0.022, -0.345, 0.01 + side * 0.052);
        phi = join(phi, ellipsoid(p, knuckle, {0.074, 0.058, 0.042}), 0.03);
    }
    phi = cut(phi, rod(p, {{-0.11, -0.37, 0.01}, 0.028}, {{-0.03, -0.42, 0.01}, 0.024}), 0.02);
    return cut(phi, rod(p, {{0.075, -0.30, 0.01}, 0.022}, {{0.04, -0.43, 0.01}, 0.03}), 0.02);
}

}  // namespace

std::vector<BoneForm> boneForms()
{
    return {{"skull", 3520, skull, {{-0.40, -0.45, -0.30}, {0.40, 0.35, 0.30}}},
            {"pelvis", 8680, pelvis, {{-0.40, -0.40, -0.40}, {0.30, 0.42, 0.40}}},
            {"femur", 8160, femur, {{-0.20, -0.50, -0.20}, {0.20, 0.50, 0.25}}}};
}

}  // namespace scree
