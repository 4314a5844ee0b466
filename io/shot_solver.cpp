#include "io/shot_solver.h"

#include <string>

#include "io/shot_schema.h"
#include "io/shot_values.h"

namespace scree {
namespace {

CombineRule combineRuleOf(const std::string& word)
{
    if (word == "min") return CombineRule::minimum;
    if (word == "mean") return CombineRule::mean;
    if (word == "geometric") return CombineRule::geometric;
    if (word == "multiply") return CombineRule::multiply;
    return CombineRule::maximum;
}

/// The iterations and switches of the phases.
void readPhases(const ShotNode& table, StepSettings& settings)
{
    const auto whole = [&](const char* key) { return static_cast<int>(table.find(key)->integer); };
    settings.method = table.find("method")->text == "paper" ? Method::paper : Method::scree;
    settings.sleep = table.find("sleep")->boolean;
    settings.gapSweeps = whole("contact_sweeps");
    settings.collisionIterations = whole("collision_iterations");
    settings.collisionPairImpulses = whole("collision_pair_impulses");
    settings.contactIterations = whole("contact_iterations");
    settings.levelIterations = whole("level_iterations");
    settings.pairImpulses = whole("pair_impulses");
    settings.shockPropagation = table.find("shock_propagation")->boolean;
    settings.shockPairImpulses = whole("shock_pair_impulses");
    settings.pushOut = table.find("push_out")->boolean;
    settings.pushOutLevelIterations = whole("push_out_level_iterations");
    settings.pushOutPairImpulses = whole("push_out_pair_impulses");
    const std::string& orientation = table.find("orientation")->text;
    settings.orientation = orientation == "euler"          ? OrientationUpdate::euler
                           : orientation == "second_order" ? OrientationUpdate::secondOrder
                                                           : OrientationUpdate::symplectic;
    settings.collision = table.find("collision")->text == "lagged" ? CollisionVariant::lagged
                                                                   : CollisionVariant::reevolve;
    const ShotNode& combine = *table.find("combine");
    settings.frictionRule = combineRuleOf(combine.find("friction")->text);
    settings.restitutionRule = combineRuleOf(combine.find("restitution")->text);
    settings.maximumSpinPerStep = table.find("maximum_spin")->number * kRadiansPerDegree;
    settings.hoverLimit = table.find("hover")->number;
}

void readSubsteps(const ShotNode& table, StepSettings& settings, ProblemList& problems)
{
    const ShotNode& min = *table.find("min");
    settings.substeps.min = static_cast<int>(min.integer);
    settings.substeps.max = static_cast<int>(table.find("max")->integer);
    settings.substeps.safety = table.find("safety")->number;
    if (settings.substeps.min <= settings.substeps.max) return;
    problems.add(min.where,
                 "'min' sub-steps must not exceed 'max', " + std::to_string(settings.substeps.max));
}

void readPenetration(const ShotNode& table, Shot& shot, ProblemList& problems)
{
    shot.penetrationWarn = table.find("warn")->number;
    shot.penetrationFail = table.find("fail")->number;
    if (shot.penetrationWarn <= shot.penetrationFail) return;
    problems.add(table.find("warn")->where,
                 "'warn' must not exceed 'fail', " + toTomlText(shot.penetrationFail));
}

/// A number that nobody reads is turned in vain, and whoever turns it should hear so. One that has
/// its default may come from a resolved shot, which holds them all.
void warnOfOtherMethods(const ShotNode& table, ProblemList& problems)
{
    const std::string& method = table.find("method")->text;
    for (const ShotKey* key : keysInside("solver")) {
        if (!*key->method || key->method == method) continue;
        const ShotNode& value = *table.find(nameOf(*key));
        const bool isDefault = value.isNumeric() ? value.asNumber() == std::stod(key->byDefault)
                                                 : toTomlText(value) == key->byDefault;
        if (isDefault) continue;
        problems.warn(value.where, "'" + std::string(nameOf(*key)) +
                                       "' changes nothing: only method \"" + key->method +
                                       "\" reads it, and this shot has method \"" + method + "\"");
    }
}

}  // namespace

bool readSolver(const ShotNode& table, Shot& shot, ProblemList& problems)
{
    warnOfOtherMethods(table, problems);
    readPhases(table, shot.settings);
    readSubsteps(*table.find("substeps"), shot.settings, problems);
    readPenetration(*table.find("penetration"), shot, problems);
    const ShotNode& strict = *table.find("strict");
    if (!strict.boolean) return false;
    if (shot.settings.method != Method::paper) {
        problems.add(strict.where,
                     "'strict' is the paper without its repairs: it needs method = \"paper\"");
    }
    makeStrict(shot.settings);
    return true;
}

void readStart(const ShotNode& table, Shot& shot)
{
    const std::string& overlap = table.find("overlap")->text;
    shot.startOverlap = overlap == "warn"       ? StartOverlapRule::warn
                        : overlap == "separate" ? StartOverlapRule::separate
                                                : StartOverlapRule::error;
}

}  // namespace scree
