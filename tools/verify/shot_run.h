// One run of a shot file, built as `scree sim` builds it, and what is measured of it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/dynamics/step_figures.h"
#include "core/dynamics/stepper.h"
#include "core/picture/scene_description.h"
#include "core/scene/world.h"
#include "io/shot.h"
#include "tools/verify/experiment.h"

namespace scree::verify {

/// A shot of the folder with TOML laid over it, as a file that extends it would: what overrides
/// cannot, add shapes.
struct ChangedShot {
    std::string name, changes;
};

class ShotRun {
public:
    /// Reads shots/verify/NAME.toml with overrides as after --set, the method and the seed of the
    /// context last.
    /// `change` reaches the settings that no key of a shot does: for controls.
    ShotRun(const Context& context, const std::string& name,
            const std::vector<std::string>& overrides = {},
            const std::function<void(StepSettings&)>& change = {});

    ShotRun(const Context& context, const ChangedShot& changed,
            const std::vector<std::string>& overrides = {});

    /// Advances by `seconds` in steps of 1/stepsPerSecond; `look` after each, with its report and
    /// the time since the start of this call [s]. Throws Error{qualityLimit} when a body is no
    /// longer finite, and Stopped at a request to stop, as the next does.
    void advance(double seconds, double stepsPerSecond,
                 const std::function<void(const StepReport&, double)>& look = {});

    /// A whole number of frames with the steps that the shot's settings choose; `lookAtStep` after
    /// each step, with the time since its frame began [s].
    void advanceFrames(int count, const std::function<void(const FrameReport&)>& look = {},
                       const std::function<void(const World&, double)>& lookAtStep = {});

    /// The scene, and where it is now, as takes and pictures hold them.
    SceneDescription describe() const;
    SceneFrame capture() const;

    /// The body of that name. Throws Error{internal} when the shot has none.
    BodyId body(const std::string& name) const;
    const BodyMotion& motion(const std::string& name) const { return world.motion[body(name)]; }

    Shot shot;
    World world;
    World start;  ///< the world as it was built
    Stepper stepper;

private:
    explicit ShotRun(Shot asRead);
};

/// What the context's method is called in the core.
Method methodOf(const Context& context);

/// Overrides that let a shot of fixed steps choose its own, as shots do by default.
const std::vector<std::string>& withDefaultSteps();

/// Overrides that let these shapes of a shot collide as their exact solids.  [A9]
std::vector<std::string> asExactSolids(const std::vector<std::string>& shapes);

/// "key=[x, y, z]" with all digits: an override that moves things.
std::string setVector(const std::string& key, const Vec3& value);
std::string setNumber(const std::string& key, double value);

Vec3 spinOf(const World& world, BodyId body);

/// Largest displacement of any vertex of the body between two worlds [m].
double largestVertexShift(const World& before, const World& after, BodyId body);

/// Height of the body's lowest vertex [m].
double lowestVertex(const World& world, BodyId body);

/// Runs a frame and answers the levels of the movable bodies in its last step, in their order, as
/// digits.
std::string levelsInAFrame(ShotRun& run);

/// A picture of the run as it stands, through the shot's first camera; none unless the context
/// wants pictures.
void addPicture(const Context& context, const ShotRun& run, const std::string& caption,
                Findings& findings, bool isWireframe = false);

}  // namespace scree::verify
