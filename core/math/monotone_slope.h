// Curves through keys that go no farther than their keys do.
#pragma once

namespace scree {

/// The slope with which a smooth curve of one number passes a key between two stretches of mean
/// slopes `before` and `after` and of these lengths: none at a turn or beside a rest, else their
/// weighted harmonic mean, with which a cubic never overshoots.  [FB84]
inline double slopeBetween(double before, double lengthBefore, double after, double lengthAfter)
{
    if (before * after <= 0.0) return 0.0;
    const double w1 = 2.0 * lengthAfter + lengthBefore, w2 = lengthAfter + 2.0 * lengthBefore;
    return (w1 + w2) / (w1 / before + w2 / after);
}

}  // namespace scree
