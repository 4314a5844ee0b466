// What is known of a pair from one step to the next: how far its bodies have moved since, and
// contacts that go along with them instead of being sought anew.  [A25; algorithm 14: lagged
// geometry]
//
// What moves by a thousandth of its size in a step touches where it did: of a heap that settles a
// tenth of the time of a step went into finding that out. Contacts that have gone along are in no
// checkpoint, so that every so many steps, and where a frame begins, all are sought anew.
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Notes how every body has moved since the last step.
void followBodies(const World& world, GapScratch& scratch);

/// Notes that the bodies of a pair are at least so far apart where they are now [m].
void seeApart(const World& world, const GapScratch& scratch, double distance, NearPair& pair);

/// How far they are apart now at least, by what was seen then [m]: what falls side by side stays
/// as far apart as it was, however far it falls.
double apartAtLeast(const World& world, const GapScratch& scratch, const NearPair& pair);

/// Whether the step at this time seeks all contacts anew: a run may be cut before it.
bool isSoughtAnewAt(const Clock& clock);

/// How much farther than it has to a step of dt looks for the contacts of a pair, so that the next
/// ones may take them along [m].
double lookAheadToLag(const World& world, const GapScratch& scratch, BodyPair bodies, double dt);

/// Takes the contacts of a pair along with its bodies, if then all with gaps below `reach` [m] are
/// known; answers whether. Not in a step that seeks all anew.
bool takeContactsAlong(const World& world, const GapScratch& scratch, double reach, NearPair& pair);

}  // namespace scree
