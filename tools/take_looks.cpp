#include "tools/take_looks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/math/point_box.h"
#include "io/nearest_word.h"
#include "io/text_forms.h"
#include "render/overlay.h"
#include "render/stage.h"
#include "tools/command_line.h"

namespace scree {
namespace {

/// Frames that are looked at to find the end of a scale.
constexpr int kScaleFrames = 24;

/// The longest force is drawn as long as this many radii of a typical body, the normal as one part.
constexpr double kForceRadii = 1.5, kNormalShare = 0.25;

/// This share of all contacts has a force below the end of the scale: a few blows of falling bodies
/// would else make the weight of a heap invisible.
constexpr double kForceQuantile = 0.95;

const std::array<std::pair<const char*, LookKind>, 8> kLookWords = {{
    {"shaded", LookKind::shaded},
    {"wireframe", LookKind::wireframe},
    {"speed", LookKind::speed},
    {"sleep", LookKind::sleep},
    {"id", LookKind::id},
    {"levels", LookKind::levels},
    {"overlap", LookKind::overlap},
    {"contacts", LookKind::contacts},
}};

const Look kStillLook = {{0.10, 0.22, 0.42}, 0.7}, kMovingLook = {{0.78, 0.30, 0.07}, 0.7};
const Look kFreeLook = {{0.30, 0.36, 0.30}, 0.7}, kPaleLook = {{0.42, 0.42, 0.42}, 0.9};

bool needsSteps(LookKind kind)
{
    return kind == LookKind::levels || kind == LookKind::overlap || kind == LookKind::contacts;
}

std::vector<std::string> lookNames()
{
    std::vector<std::string> names;
    for (const auto& [name, kind] : kLookWords) names.emplace_back(name);
    return names;
}

/// The next number at or above `value` that is 1, 2 or 5 times a power of ten.
double roundedUp(double value)
{
    double step = 1e-9;
    for (int i = 0; step < value && i < 90; ++i) step *= i % 3 == 1 ? 2.5 : 2.0;
    return step;
}

/// A colour that is unlike those of bodies nearby in the list.
Vec3 colorOfId(std::size_t body)
{
    const double hue = 6.0 * randomUnit(11, body), light = 0.25 + 0.45 * randomUnit(12, body);
    Vec3 color;
    for (int i = 0; i < 3; ++i) {
        const double turned = std::fmod(hue + 2.0 * i, 6.0);
        color[i] = light * (0.15 + 0.85 * std::clamp(std::abs(turned - 3.0) - 1.0, 0.0, 1.0));
    }
    return color;
}

Look scaleLook(double share)
{
    return {scaleColor(share).cast<double>(), 0.7};
}

std::vector<Look> materialLooks(const TakeInfo& info, const SceneDescription& scene)
{
    std::map<std::string, Look> byMaterial;
    for (const SceneMaterial& material : info.materials)
        byMaterial[material.name] = {material.color, material.roughness};
    std::vector<Look> looks;
    for (const SceneBody& body : scene.bodies) looks.push_back(byMaterial[body.material]);
    return variedLooks(scene, looks);
}

/// Half the diagonal of the box of a typical body.
double typicalSize(const TakeInfo& info, const SceneDescription& scene)
{
    std::vector<double> radii(scene.meshes.size(), 0.0);
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        if (info.bodies[body].isPlane) continue;
        const std::size_t mesh = scene.bodies[body].mesh;
        if (radii[mesh] > 0.0) continue;
        const Aabb box = boxOf(scene.meshes[mesh].points);
        if (!box.isEmpty()) radii[mesh] = 0.5 * box.diagonal();
    }
    return typicalRadius(scene, radii);
}

}  // namespace

LookKind parseLook(const std::string& word)
{
    for (const auto& [name, kind] : kLookWords)
        if (word == name) return kind;
    throw Error(ErrorKind::usage, "--look " + word + ": the looks are " + knownLooks() +
                                      didYouMean(word, lookNames()));
}

std::string TakeLooks::scaleText() const
{
    return isDiagnostic() ? formatted(", scale %.9g", most_) + formatted(" %.9g", markLength_) : "";
}

std::string knownLooks()
{
    return joined(lookNames());
}

TakeLooks::TakeLooks(const TakeReader& take, const SceneDescription& scene, LookKind kind)
    : take_(take), kind_(kind), materials_(materialLooks(take.info(), scene))
{
    for (const SceneBody& body : scene.bodies) isMovable_.push_back(body.moves);
    if (needsSteps(kind) && !take.info().hasContacts)
        throw Error(ErrorKind::missingInput,
                    "\"" + take.paths().root.string() +
                        "\" holds no contacts for this look; simulate it with [output] contacts = "
                        "true (--set output.contacts=true)");
    if (kind == LookKind::speed) chooseSpeedScale();
    if (kind == LookKind::sleep)
        legend_.entries = {{kMovingLook.color.cast<float>(), "moves"},
                           {kStillLook.color.cast<float>(), "stands still"}};
    if (!needsSteps(kind)) return;
    markLength_ = kForceRadii * typicalSize(take.info(), scene);
    chooseStepScale();
}

void TakeLooks::chooseSpeedScale()
{
    double fastest = 1e-3;
    take_.forWholeFrames(spreadFrames(take_.frames(), kScaleFrames),
                         [&](int, const SceneFrame& frame) {
                             for (const Vec3& velocity : frame.velocity)
                                 if (velocity.allFinite())
                                     fastest = std::max(fastest, velocity.norm());
                         });
    most_ = roundedUp(fastest);
    legend_.title = "units/s";
    legend_.scaleEnd = most_;
}

void TakeLooks::chooseStepScale()
{
    // Look for the highest level, the deepest overlap and the forces of the shot.
    int highest = 1;
    double deepest = 0.0;
    std::vector<double> forces = {0.0};
    take_.forWholeFrames(spreadFrames(take_.frames(), kScaleFrames),
                         [&](int number, const SceneFrame&) {
                             const std::optional<StepSeen> step = take_.readLastStep(number);
                             if (!step) return;
                             for (const std::int32_t level : step->level)
                                 highest = std::max(highest, level);
                             for (const double overlap : step->overlap)
                                 deepest = std::max(deepest, overlap);
                             for (const ContactSeen& contact : step->contacts)
                                 forces.push_back(contact.impulse.norm() / step->dt);
                         });
    const auto common = forces.begin() + static_cast<std::ptrdiff_t>(
                                             kForceQuantile * static_cast<double>(forces.size()));
    std::nth_element(forces.begin(), common, forces.end());

    // Say it in the legend.
    if (kind_ == LookKind::levels) {
        most_ = highest;
        legend_.entries = {{kFreeLook.color.cast<float>(), "rests on nothing"}};
        legend_.title = "levels";
        legend_.scaleEnd = most_;
    } else if (kind_ == LookKind::overlap) {
        most_ = roundedUp(deepest);
        legend_.title = "m overlap";
        legend_.scaleEnd = most_;
    } else {
        most_ = roundedUp(*common);
        char longest[64];
        std::snprintf(longest, sizeof longest, "force, full length %g N", most_);
        legend_.entries = {
            {kContactColor, "contact"}, {kNormalColor, "normal"}, {kForceColor, longest}};
    }
}

Look TakeLooks::lookOf(std::size_t body, const SceneFrame& frame,
                       const std::optional<StepSeen>& step) const
{
    switch (kind_) {
        case LookKind::speed:
            return scaleLook(frame.velocity[body].norm() / most_);
        case LookKind::sleep:
            return frame.velocity[body].isZero(0.0) && frame.angularVelocity[body].isZero(0.0)
                       ? kStillLook
                       : kMovingLook;
        case LookKind::id:
            return {colorOfId(body), 0.7};
        case LookKind::levels:
            return step && step->level[body] > 0 ? scaleLook(step->level[body] / most_) : kFreeLook;
        case LookKind::overlap:
            return scaleLook(step ? step->overlap[body] / most_ : 0.0);
        case LookKind::contacts:
            return kPaleLook;
        case LookKind::shaded:
        case LookKind::wireframe:
            break;
    }
    return materials_[body];
}

std::vector<Look> TakeLooks::looksAt(const SceneFrame& frame) const
{
    std::optional<StepSeen> step;
    if (needsSteps(kind_)) step = take_.readLastStep(frame.frame);
    std::vector<Look> looks = materials_;
    for (std::size_t body = 0; body < looks.size(); ++body) {
        if (isMovable_[body])
            looks[body] = lookOf(body, frame, step);
        else
            looks[body].color = Vec3::Constant(0.35 * looks[body].color.mean() + 0.1);
    }
    return looks;
}

void TakeLooks::drawOver(Image& image, const Camera& camera, int frame) const
{
    if (kind_ == LookKind::contacts) {
        std::vector<ContactMark> marks;
        if (const std::optional<StepSeen> step = take_.readLastStep(frame)) {
            for (const ContactSeen& contact : step->contacts) {
                // Show what holds up, whichever of the two bodies comes first.
                const double side = contact.normal.dot(camera.up) < 0.0 ? -1.0 : 1.0;
                const double share = contact.impulse.norm() / step->dt / most_;
                const double shown = share > 1.0 ? 1.0 / share : 1.0;
                marks.push_back(
                    {contact.point / take_.info().metresPerUnit,
                     side * kNormalShare * markLength_ * contact.normal,
                     side * shown * markLength_ / (step->dt * most_) * contact.impulse});
            }
        }
        drawContacts(image, camera, marks);
    }
    drawLegend(image, legend_);
}

}  // namespace scree
