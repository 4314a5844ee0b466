// E10: mass properties against closed forms. [A2, A3]  Meshes are built in code; the words with
// which meshes that are no solid are refused are told by tests/io/torture_mesh_test.cpp.
#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/geometry/mass_properties.h"
#include "core/geometry/mesh_defects.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tools/verify/experiments.h"

namespace scree::verify {
namespace {

using enum Weight;

/// A solid of density 1 with flat faces, and what its closed form says.
struct Solid {
    std::string name;
    TriMesh mesh;
    double volume = 0.0;
    Vec3 centre = Vec3::Zero();
    Vec3 moments = Vec3::Zero();  // ascending
};

Vec3 ascending(Vec3 moments)
{
    std::sort(moments.begin(), moments.end());
    return moments;
}

Vec3 boxMoments(const Vec3& size)
{
    const Vec3 squares = size.cwiseProduct(size);
    return ascending(size.prod() / 12.0 * (Vec3::Constant(squares.sum()) - squares));
}

Solid box()
{
    const Vec3 size(1.0, 2.0, 3.0);
    return {"box", makeBox(size, {1, 2, 3}), 6.0, Vec3::Zero(), boxMoments(size)};
}

/// The corner of a unit cube: its second moments about its centre are 3/80 V on the diagonal and
/// -1/80 V off it: eigenvalues 4, 4 and 1 eightieths of V, and those of trace - matrix 5, 5 and 8.
Solid tetrahedron()
{
    TriMesh mesh;
    mesh.points.resize(3, 4);
    mesh.points << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
    mesh.triangles.resize(3, 4);
    mesh.triangles << 0, 0, 0, 1, 2, 1, 3, 2, 1, 3, 2, 3;
    const double volume = 1.0 / 6.0;
    return {"tetrahedron", mesh, volume, Vec3::Constant(0.25), volume / 80.0 * Vec3(5.0, 5.0, 8.0)};
}

/// A regular hexagon of circumradius 1 extruded by 2 along y: the mean of x² over a regular polygon
/// is R²/24 (1 + 2 cos²(pi/n)) · 2 = 5/24 R² for a hexagon, the same across.
Solid prism()
{
    const double radius = 1.0, height = 2.0;
    const double volume = 1.5 * std::sqrt(3.0) * radius * radius * height;
    const double across = 5.0 / 24.0 * radius * radius, along = height * height / 12.0;
    return {"prism of six sides", makeCylinder(radius, height, 6, 3), volume, Vec3::Zero(),
            ascending(volume * Vec3(across + along, 2.0 * across, across + along))};
}

TriMesh bothOf(const TriMesh& a, const TriMesh& b)
{
    TriMesh both;
    both.points.resize(3, a.points.cols() + b.points.cols());
    both.points << a.points, b.points;
    both.triangles.resize(3, a.triangles.cols() + b.triangles.cols());
    both.triangles << a.triangles,
        (b.triangles.array() + static_cast<int>(a.points.cols())).matrix();
    return both;
}

/// A box with a box cavity off its middle; the cavity's faces look into it, away from the material.
Solid hollowBox()
{
    const Vec3 outerSize(2.0, 2.4, 2.8), innerSize(1.0, 0.6, 0.8), shift(0.2, 0.0, 0.0);
    const TriMesh outer = makeBox(outerSize, {1, 1, 1});
    TriMesh inner = transformed(makeBox(innerSize, {1, 1, 1}), {shift, Quat::Identity()});
    inner.triangles.row(1).swap(inner.triangles.row(2));

    // Along the three axes, so that the axes stay principal: moments add up by Steiner's rule.
    const double whole = outerSize.prod(), hole = innerSize.prod(), volume = whole - hole;
    const Vec3 centre = -hole / volume * shift;
    const auto about = [&](const Vec3& size, const Vec3& from) -> Vec3 {
        const Vec3 squares = size.cwiseProduct(size) / 12.0 + from.cwiseProduct(from);
        return size.prod() * (Vec3::Constant(squares.sum()) - squares);
    };
    return {"box with a cavity", bothOf(outer, inner), volume, centre,
            ascending(about(outerSize, centre) - about(innerSize, shift - centre))};
}

double relativeError(const Vec3& measured, const Vec3& expected)
{
    return (measured - expected).norm() / expected.norm();
}

/// Largest angle between the axes of the turned solid and the turned axes; equal moments leave the
/// choice of axes open and are passed over [rad].
double axesOff(const MassProperties& here, const MassProperties& turned, const Quat& turn)
{
    double off = 0.0;
    for (int k = 0; k < 3; ++k) {
        double apart = here.moments[2];
        for (int other = 0; other < 3; ++other) {
            if (other == k) continue;
            apart = smaller(apart, std::abs(here.moments[other] - here.moments[k]));
        }
        if (apart < 1e-3 * here.moments[2]) continue;
        const Vec3 expected = turn * (here.meshFromPrincipal * Vec3::Unit(k));
        off = larger(off, (turned.meshFromPrincipal * Vec3::Unit(k)).cross(expected).norm());
    }
    return off;
}

void flatSolid(const Solid& solid, Findings& findings)
{
    const std::string name = solid.name + ": ";
    const MassProperties here = massProperties(solid.mesh);
    findings.atMost(must, name + "error of the volume", std::abs(here.volume / solid.volume - 1.0),
                    1e-13, "of it");
    findings.atMost(must, name + "error of the centre", (here.centre - solid.centre).norm(), 1e-13,
                    "m");
    findings.atMost(must, name + "error of the moments", relativeError(here.moments, solid.moments),
                    1e-13, "of them");

    const Vec3 far(1e6, -1e6, 1e6);
    const MassProperties there = massProperties(transformed(solid.mesh, {far, Quat::Identity()}));
    const double volumeThere = std::abs(there.volume / solid.volume - 1.0);
    const double centreThere = (there.centre - far - solid.centre).norm() / far.norm();
    findings.atMost(
        must, name + "1000 km away, error of volume, centre and moments",
        larger(larger(volumeThere, centreThere), relativeError(there.moments, solid.moments)), 1e-9,
        "of them");

    double momentsOff = 0.0, turnedAxes = 0.0;
    for (const Vec3& by : {Vec3(0.3, -1.1, 0.7), Vec3(2.0, 0.1, -0.4), Vec3(-0.9, 0.8, 1.9)}) {
        const Quat turn = exponentialMap(by);
        const MassProperties turned = massProperties(transformed(solid.mesh, {Vec3::Ones(), turn}));
        momentsOff = larger(momentsOff, relativeError(turned.moments, solid.moments));
        turnedAxes = larger(turnedAxes, axesOff(here, turned, turn));
    }
    findings.atMost(must, name + "turned, error of the moments", momentsOff, 1e-12, "of them");
    findings.atMost(must, name + "turned, its axes are off", turnedAxes, 1e-12, "rad");
}

/// Volume, moment about the axis and moment across, over those of the round solid, less one.
Vec3 roundError(const TriMesh& mesh, double volume, double axial, double across)
{
    const MassProperties found = massProperties(mesh);
    // The moment about the axis is the one that is farther from the other two.
    const bool isLast = found.moments[2] - found.moments[1] > found.moments[1] - found.moments[0];
    const double about = isLast ? found.moments[2] : found.moments[0];
    return {found.volume / volume - 1.0, about / axial - 1.0, found.moments[1] / across - 1.0};
}

void roundSolids(Findings& findings)
{
    const auto torus = [](int refinement) {
        const double major = 1.0, minor = 0.25, volume = 2.0 * kPi * kPi * major * minor * minor;
        return roundError(makeTorus(major, minor, {16 * refinement, 10 * refinement}), volume,
                          volume * (major * major + 0.75 * minor * minor),
                          volume * (0.5 * major * major + 0.625 * minor * minor));
    };
    const auto sphere = [](int subdivisions) {
        const double volume = 4.0 / 3.0 * kPi, moment = 0.4 * volume;
        return roundError(makeSphere(1.0, subdivisions), volume, moment, moment);
    };
    const auto cylinder = [](int sectors) {
        const double radius = 0.5, height = 2.0, volume = kPi * radius * radius * height;
        return roundError(makeCylinder(radius, height, sectors, 1), volume,
                          0.5 * volume * radius * radius,
                          volume * (0.25 * radius * radius + height * height / 12.0));
    };
    struct Case {
        const char* name;
        std::vector<Vec3> errors;  // each of a mesh twice as fine as the one before
    };
    const char* const quantities[] = {"volume", "moment about the axis", "moment across"};
    for (const Case& c :
         {Case{"ring", {torus(2), torus(4), torus(8)}},
          Case{"sphere", {sphere(2), sphere(3), sphere(4)}},
          Case{"cylinder", {cylinder(16), cylinder(32), cylinder(64), cylinder(128)}}}) {
        for (int k = 0; k < 3; ++k) {
            double farthest = 4.0;
            for (std::size_t i = 0; i + 1 < c.errors.size(); ++i) {
                const double ratio = c.errors[i][k] / c.errors[i + 1][k];
                if (!(std::abs(ratio - 4.0) <= std::abs(farthest - 4.0))) farthest = ratio;
            }
            findings.near(must,
                          std::string(c.name) + ": error of the " + quantities[k] +
                              ", over at twice as fine, farthest from theory",
                          farthest, 4.0, 0.4, "-");
        }
    }
}

/// [A3] Where moments are equal, noise must not choose the axes.
void equalMoments(Findings& findings)
{
    const auto turnedBy = [](const TriMesh& mesh) {
        return massProperties(mesh).meshFromPrincipal.vec().norm();
    };
    findings.atMost(must, "cube: turned from the artist's axes",
                    turnedBy(makeBox(Vec3::Ones(), {2, 2, 2})), 1e-12, "rad");
    findings.atMost(must, "sphere: turned from the artist's axes", turnedBy(makeSphere(1.0, 2)),
                    1e-12, "rad");
    // The ring is round about y: its axis goes last, the other two stay along the artist's.
    const Mat3 axes =
        massProperties(makeTorus(1.0, 0.25, {16, 10})).meshFromPrincipal.toRotationMatrix();
    findings.atMost(must, "ring: axes off the artist's",
                    (axes.cwiseAbs().colwise().maxCoeff().array() - 1.0).abs().maxCoeff(), 1e-9,
                    "-");
}

/// Two unit cubes, the second moved by `away`; points at the same place are one point.
TriMesh twoCubes(const Vec3& away)
{
    const TriMesh cube = makeBox(Vec3::Ones(), {1, 1, 1});
    TriMesh both = bothOf(cube, transformed(cube, {away, Quat::Identity()}));
    for (int& corner : both.triangles.reshaped()) {
        for (int first = 0; first < corner; ++first) {
            if (both.points.col(first) == both.points.col(corner)) corner = first;
        }
    }
    return both;
}

/// Whether a mesh is refused by name, for such a defect and with its place.
bool isRefused(const TriMesh& mesh, const std::string& defect)
{
    try {
        requireSolid(mesh, "thing");
    } catch (const Error& error) {
        const std::string words = error.what();
        const std::size_t at = words.find(defect);
        return words.find("'thing'") != std::string::npos && at != std::string::npos &&
               words.find(" at (", at) != std::string::npos;
    }
    return false;
}

/// [A1]  A mesh that is inverted as a whole is turned round before, which `scree check` tells.
void noSolids(Findings& findings)
{
    const TriMesh cube = makeBox(Vec3::Ones(), {1, 1, 1});
    TriMesh open = cube, inverted = cube, flat = cube, folded = tetrahedron().mesh, knotted = cube;
    open.triangles = cube.triangles.leftCols(11).eval();
    inverted.triangles.row(1).swap(inverted.triangles.row(2));
    flat.points.row(1).setZero();
    folded.points.col(0) = Vec3(0.25, 0.25, 0.5);  // a corner, pushed into the face across
    knotted.points.col(0) = Vec3(0.1, 0.05, 1.0);  // a corner, pulled through the far face
    struct Case {
        const char* name;
        TriMesh mesh;
        const char* defect;
    };
    for (const Case& c :
         {Case{"an open mesh", open, "open edge"}, Case{"an inverted mesh", inverted, "inside-out"},
          Case{"a mesh without volume", flat, "zero-area triangle"},
          Case{"a mesh without volume whose faces have area", folded, ""},
          Case{"a mesh that cuts itself", knotted, "face that pierces another"},
          Case{"a mesh that touches itself along an edge", twoCubes({1.0, 1.0, 0.0}),
               "non-manifold edge"}}) {
        findings.equal(must, std::string("refused with its place: ") + c.name,
                       isRefused(c.mesh, c.defect), 1);
    }
    findings.equal(departure, "refused with its place: a mesh that touches itself at a point",
                   isRefused(twoCubes(Vec3::Ones()), ""), 1,
                   "every edge has its two faces, and volume and distance are what they are");
}

}  // namespace

void runMassProperties(const Context&, Findings& findings)
{
    for (const Solid& solid : {box(), tetrahedron(), prism(), hollowBox()}) {
        flatSolid(solid, findings);
    }
    roundSolids(findings);
    equalMoments(findings);
    noSolids(findings);
}

}  // namespace scree::verify
