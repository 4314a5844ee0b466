// Variation of looks within a heap.
#include "render/look.h"

#include <cmath>
#include <numbers>

#include "core/base/check.h"
#include "core/base/hash.h"
#include "core/base/random.h"

namespace scree {
namespace {

constexpr double kLightnessSpread = 0.32;  // relative, either way
constexpr double kTintSpread = 0.11;       // relative to the mean of the three channels

/// Darkens or lightens and pushes the colour off its hue, at right angles to grey.
Look varied(const Look& look, const std::string& name, double strength)
{
    const std::uint64_t id = hashText(name);
    const double lightness = 1.0 + strength * kLightnessSpread * (2.0 * randomUnit(id, 0) - 1.0);
    const double hue = 2.0 * std::numbers::pi * randomUnit(id, 1);
    const double push = strength * kTintSpread * look.color.mean() * randomUnit(id, 2);

    const Vec3 redToCyan = Vec3(2.0, -1.0, -1.0) / std::sqrt(6.0);
    const Vec3 greenToBlue = Vec3(0.0, 1.0, -1.0) / std::sqrt(2.0);
    const Vec3 tinted =
        look.color + push * (std::cos(hue) * redToCyan + std::sin(hue) * greenToBlue);
    Look result = look;
    result.color = (lightness * tinted).cwiseMax(0.0).cwiseMin(1.0);
    return result;
}

}  // namespace

std::vector<Look> variedLooks(const SceneDescription& scene, const std::vector<Look>& looks,
                              double strength)
{
    SCREE_CHECK(looks.size() == scene.bodies.size(), "one look per body is needed");
    std::vector<Look> result = looks;
    for (std::size_t i = 0; i < looks.size(); ++i)
        if (scene.bodies[i].moves) result[i] = varied(looks[i], scene.bodies[i].name, strength);
    return result;
}

}  // namespace scree
