// What each file of this room holds, for the one table in catalogue.cpp.
#pragma once

#include "tools/verify/experiment.h"

namespace scree::verify {

void runBlockAtRest(const Context& context, Findings& findings);        // e01
void runSliding(const Context& context, Findings& findings);            // e02
void runBilliards(const Context& context, Findings& findings);          // e03
void runStackAndPlank(const Context& context, Findings& findings);      // e04
void runSeeSaw(const Context& context, Findings& findings);             // e05
void runContactGraph(const Context& context, Findings& findings);       // e06
void runRings(const Context& context, Findings& findings);              // e07
void runBones(const Context& context, Findings& findings);              // e08
void runMassProperties(const Context& context, Findings& findings);     // e10
void runHeapQuality(const Context& context, Findings& findings);        // e20
void runDistanceField(const Context& context, Findings& findings);      // e21
void runRolling(const Context& context, Findings& findings);            // e09
void runFastAndThin(const Context& context, Findings& findings);        // e12
void runAcceleratedFrames(const Context& context, Findings& findings);  // e17
void runVariants(const Context& context, Findings& findings);           // e22
void runNoMissedBounce(const Context& context, Findings& findings);     // e24
void runPushOut(const Context& context, Findings& findings);            // e11
void runImpulses(const Context& context, Findings& findings);           // e15
void runDeterminism(const Context& context, Findings& findings);        // e19
void runWhatShockBuys(const Context& context, Findings& findings);      // e26
void runTallAndHeavy(const Context& context, Findings& findings);       // e26
void runFreeFlight(const Context& context, Findings& findings);         // e13
void runTumbling(const Context& context, Findings& findings);           // e13
void runBounce(const Context& context, Findings& findings);             // e16
void runBounceHeight(const Context& context, Findings& findings);       // e16
void runFreeCluster(const Context& context, Findings& findings);        // e18
void runEdgeAgainstEdge(const Context& context, Findings& findings);    // e23
void runDropToRest(const Context& context, Findings& findings);         // e23

}  // namespace scree::verify
