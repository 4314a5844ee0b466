// How long bodies have stayed where they are, and how long that must be.  [algorithm 14]
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// A body lies still for so many frames at least before it sleeps, also where a second has a
/// thousand frames: a tower that is leaning has to show it.
inline constexpr std::int32_t kStillFrames = 12;

/// The time scale on which a body gives way to an acceleration, √(size / acceleration) [s];
/// infinite without any.
double unitOfTime(const World& world, BodyId body, double acceleration);

/// How long a body must lie still to fall asleep, in frames.
double framesToSleep(const World& world, BodyId body, double acceleration);

/// The turn of a body since it stood as `since` [rad], about the world's axes; of a solid of
/// revolution that of its axis, for turns about that do not show.
Vec3 shownTurn(const World& world, BodyId body, const Quat& since);

/// For how long a body has gone nowhere, though it may rock widely, in units of time; infinite for
/// what stands where it is, 0 for what a script moves and where nobody sleeps.
double unitsAround(const World& world, const GapScratch& scratch, BodyId body);

/// What has gone nowhere for so long should have come to rest: six seconds for a ring of 2.5 m, two
/// for a brick.
inline constexpr double kLongAround = 16.0;

/// Whether nearly all bodies of an island have stayed nearby for a while, or around for long: it is
/// about to come to rest, or should have.
bool isSettling(const World& world, const GapScratch& scratch, const GapIsland& island);

/// Whether what acts on a body is what did when it fell asleep, or in the frame before if it is
/// awake.
bool isPulledAsBefore(const BodyRest& rest, const AppliedForce& now);

/// At the end of a frame: notes of every body whether it has stayed where it was, or where it is
/// now. `forces`: on all bodies, in the frame; `rest` of the memory must have room for all.
void noteStays(World& world, const std::vector<AppliedForce>& forces);

}  // namespace scree
