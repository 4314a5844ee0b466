// E10: mass properties against closed forms. [A2, A3]  Meshes are built in code; what is refused,
// and cavities, are told by tests/core/mass_properties_test.cpp.
#include <cmath>

#include "core/geometry/mass_properties.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tools/verify/experiments.h"

namespace scree::verify {
namespace {

using enum Weight;

const Vec3 kSize(1.0, 2.0, 3.0);

/// Ascending moments of the box of kSize and density 1, about its centre.
Vec3 boxMoments()
{
    return kSize.prod() / 12.0 * Vec3(1.0 + 4.0, 1.0 + 9.0, 4.0 + 9.0);
}

void boxes(Findings& findings)
{
    const TriMesh box = makeBox(kSize, {1, 2, 3});
    const MassProperties here = massProperties(box);
    findings.near(must, "box: volume", here.volume, 6.0, 6e-13, "m^3");
    findings.atMost(must, "box: error of the moments",
                    (here.moments - boxMoments()).norm() / boxMoments().norm(), 1e-13, "of them");
    const Vec3 far(1e6, -1e6, 1e6);
    const MassProperties there = massProperties(transformed(box, {far, Quat::Identity()}));
    findings.atMost(must, "box 1000 km away: error of the moments",
                    (there.moments - boxMoments()).norm() / boxMoments().norm(), 1e-9, "of them");
    const Quat turn = exponentialMap({0.3, -1.1, 0.7});
    const MassProperties turned = massProperties(transformed(box, {Vec3::Ones(), turn}));
    double axes = 0.0;
    for (int k = 0; k < 3; ++k) {
        const Vec3 expected = turn * (here.meshFromPrincipal * Vec3::Unit(k));
        const Vec3 axis = turned.meshFromPrincipal * Vec3::Unit(k);
        axes = std::max(axes, axis.cross(expected).norm());
    }
    findings.atMost(must, "box, turned: error of the moments",
                    (turned.moments - boxMoments()).norm() / boxMoments().norm(), 1e-12, "of them");
    findings.atMost(must, "box, turned: its axes are off", axes, 1e-9, "rad");
    const Quat ofCube = massProperties(makeBox(Vec3::Ones(), {2, 2, 2})).meshFromPrincipal;
    findings.atMost(must, "cube, three equal moments: turned from the artist's axes",
                    ofCube.vec().norm(), 1e-12, "rad");
}

/// Error of volume, moment about the axis and moment across of a ring of so many quads.
Vec3 torusError(int refinement)
{
    const double major = 1.0, minor = 0.25;
    const MassProperties torus =
        massProperties(makeTorus(major, minor, {16 * refinement, 10 * refinement}));
    const double volume = 2.0 * kPi * kPi * major * minor * minor;
    return {torus.volume / volume - 1.0,
            torus.moments[2] / (volume * (major * major + 0.75 * minor * minor)) - 1.0,
            torus.moments[0] / (volume * (0.5 * major * major + 0.625 * minor * minor)) - 1.0};
}

}  // namespace

void runMassProperties(const Context&, Findings& findings)
{
    boxes(findings);
    const Vec3 coarse = torusError(4), fine = torusError(8);
    const char* const names[] = {"volume", "moment about the axis", "moment across"};
    for (int k = 0; k < 3; ++k) {
        findings.near(must,
                      std::string("ring: error of the ") + names[k] + ", over at twice as fine",
                      coarse[k] / fine[k], 4.0, 0.4, "-");
    }
}

}  // namespace scree::verify
