// Hooks for those who want to see what a step does: for drawing and debugging, none by default. An
// observer sees and changes nothing; the bits are the same with and without.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/math/types.h"
#include "core/scene/body.h"

namespace scree {

/// What one step applied between two bodies at one place. Of the shock propagation of method
/// `paper`, which holds what is below in place, only A or only B has felt its part.
struct ContactSeen {
    BodyId a = 0, b = 0;          ///< a < b
    Vec3 point = Vec3::Zero();    ///< where it acted, world [m]
    Vec3 normal = Vec3::Zero();   ///< from B to A
    Vec3 impulse = Vec3::Zero();  ///< on A [N s]
};

/// One step, after it was taken.
struct StepSeen {
    double dt = 0.0;                    ///< [s]
    std::vector<ContactSeen> contacts;  ///< sorted by bodies; the same for any number of threads
    std::vector<std::int32_t> level;    ///< per body, of the contact graph; 0: rests on nothing
    std::vector<double> overlap;        ///< per body: how deep it is in its deepest overlap [m]

    /// Both bodies of a pair are as deep as the pair is.
    void deepen(BodyId a, BodyId b, double depth)
    {
        for (const BodyId body : {a, b}) overlap[body] = std::max(overlap[body], depth);
    }
};

class StepObserver {
public:
    virtual ~StepObserver() = default;
    virtual void stepDone(const StepSeen& step) = 0;
};

/// Keeps the step it was shown last.
class LastStep : public StepObserver {
public:
    void stepDone(const StepSeen& step) override { seen = step; }
    StepSeen seen;
};

}  // namespace scree
