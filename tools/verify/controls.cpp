#include "tools/verify/controls.h"

#include "core/dynamics/collision_pass.h"
#include "core/dynamics/contact_graph.h"
#include "core/dynamics/contact_pass.h"
#include "core/dynamics/integrator.h"

namespace scree::verify {

void textbookStep(World& world, const StepSettings& settings, double dt)
{
    addGravity(world, settings, dt);
    advancePositions(world, settings, dt);

    // Gravity is in the velocities already: what is predicted from here on has felt it.
    StepSettings here = settings;
    here.gravity.setZero();
    StepScratch scratch;
    std::int64_t capped = 0;
    findPairs(world, here, dt, scratch);
    beginStep(world, here, dt, scratch);
    resolveCollisions(world, here, dt, scratch, capped);
    const ContactGraph graph = buildContactGraph(world, here, dt, scratch);
    resolveContacts(world, graph, here, dt, scratch, capped);
}

}  // namespace scree::verify
