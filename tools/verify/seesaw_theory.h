// The see-saw of E5 as a planar problem of two unknowns: how far the plank has tilted, rolling on
// its pivot, and how far the heavy block has slid along it.
//
// Seven and a half degrees are less than the angle of friction, and yet the block slides from the
// first moment: to go along it would have to be pushed outwards, since it stands above the pivot,
// by 1.4 m of the 3.5 m that it sinks, and it is too light on the plank for that. After half a
// second the plank has tilted 1.7 % more than if all were one body, and that 1.2 % more than at the
// acceleration it began with.
#pragma once

namespace scree::verify {

/// Tilt after so many seconds, heavy side down, of steps of equal length that move by their new
/// velocities, as the method's do; until the block slides off [degrees].
double seeSawTilt(double seconds, double stepsPerSecond);

}  // namespace scree::verify
