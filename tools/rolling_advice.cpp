#include "tools/rolling_advice.h"

#include <cstdio>
#include <map>

namespace scree {
namespace {

/// What a barrel is to lose of its speed in each second [m/s²]: on a lawn it does.
constexpr double kBraking = 1.0 / 3.0;

bool resistsRolling(const Material& material)
{
    return material.rolling.rolling > 0.0 || material.rolling.rawRolling > 0.0;
}

/// A pair takes the larger of what its two materials have.  [A49]
bool doesAnythingFixedBrake(const World& world)
{
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        if (world.massWhenFree(body) == 0.0 && resistsRolling(world.materialOf(body))) return true;
    }
    return false;
}

/// Of what is round, about an axis where its turns do not show [m].
double radiusOf(const Shape& shape)
{
    Eigen::Index axis = 0;
    shape.turnsThatShow.minCoeff(&axis);
    return 0.5 * shape.box.size()[(axis + 1) % 3];
}

bool isRoundAndUnbraked(const World& world, BodyId body)
{
    return world.massWhenFree(body) > 0.0 && !world.shapeOf(body).showsAllTurns() &&
           !resistsRolling(world.materialOf(body));
}

}  // namespace

bool rollsOn(const World& world, BodyId body)
{
    return isRoundAndUnbraked(world, body) && !doesAnythingFixedBrake(world);
}

std::vector<std::string> rollingAdvice(const Shot& shot, const World& world)
{
    const double gravity = shot.settings.gravity.norm();
    if (gravity == 0.0 || doesAnythingFixedBrake(world)) return {};
    std::map<std::string, std::map<std::string, double>> radii;  // by material and shape [m]
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        if (!isRoundAndUnbraked(world, body)) continue;
        const Shape& shape = world.shapeOf(body);
        radii[world.materialOf(body).name][shape.name] = radiusOf(shape);
    }
    std::vector<std::string> sentences;
    for (const auto& [material, shapes] : radii) {
        const auto& [shape, radius] = *shapes.begin();
        char number[32];
        // Of a solid cylinder, which turns with half of its mass as well.
        const double arm = 1.5 * kBraking / gravity * radius;
        std::snprintf(number, sizeof number, "%.2g", arm / shot.metresPerUnit);
        const std::string others =
            shapes.size() > 1 ? " and " + std::to_string(shapes.size() - 1) + " more" : "";
        sentences.push_back("once it rolls, '" + shape + "'" + others + " of material '" +
                            material + "' rolls on for ever: nothing has a rolling_friction; " +
                            number + " takes 1 m/s from it in three seconds");
    }
    return sentences;
}

}  // namespace scree
