#include "tools/verify/controls.h"

#include "core/dynamics/collision_pass.h"
#include "core/dynamics/contact_graph.h"
#include "core/dynamics/contact_pass.h"
#include "core/dynamics/forces.h"
#include "core/dynamics/integrator.h"

namespace scree::verify {

namespace {

void addGravity(World& world, const StepSettings& settings, double dt)
{
    std::vector<AppliedForce> forces;
    findForces(world, settings, dt, forces);
    addForces(world, forces, dt);
}

/// Collision and contact with velocities that have felt gravity: what is predicted has it in it.
void resolveAfterGravity(World& world, const StepSettings& settings, double dt)
{
    StepSettings here = settings;
    here.gravity.setZero();
    StepScratch scratch;
    findPairs(world, here, dt, scratch);
    beginStep(world, here, dt, scratch);
    resolveCollisions(world, here, dt, scratch);
    const ContactGraph graph = buildContactGraph(world, here, dt, scratch);
    resolveContacts(world, graph, here, dt, scratch);
}

}  // namespace

void textbookStep(World& world, const StepSettings& settings, double dt)
{
    addGravity(world, settings, dt);
    advancePositions(world, settings, dt);
    resolveAfterGravity(world, settings, dt);
}

void gravityFirstStep(World& world, const StepSettings& settings, double dt)
{
    addGravity(world, settings, dt);
    resolveAfterGravity(world, settings, dt);
    advancePositions(world, settings, dt);
}

}  // namespace scree::verify
