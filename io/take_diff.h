// Where two takes part: the first frame, sample and body that differ.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/take_reader.h"

namespace scree {

struct TakeDifference {
    int frame = 0;
    std::optional<double> offset;     ///< of the first sub-frame sample that differs [frames after
                                      ///< the frame before]; when both takes hold the same samples
    int stepsA = 0, stepsB = 0;       ///< of that frame; 0: unknown
    std::vector<std::string> bodies;  ///< that differ in that frame, in the order of the takes
    std::string farthestBody;         ///< of them, the one whose centre is farthest off
    double farthest = 0.0;            ///< by how much [m]
    double largestTurn = 0.0;         ///< between its two orientations [rad]
    bool isMemoryOnly = false;        ///< all stand and move alike, but remember other contacts or
                                      ///< rest: what follows will differ
};

struct TakeComparison {
    std::vector<std::string> notes;  ///< what else differs: frames, settings, program
    bool holdSameFrames = true;
    int framesCompared = 0;
    std::optional<TakeDifference> difference;  ///< of the states, to the last bit
    /// What shots ask for besides, as pictures and sub-frames, makes no other motion.
    bool isSame() const { return holdSameFrames && !difference; }
};

/// Compares the state of every frame that both takes hold, in order, up to the first that differs.
/// `beforeFrame` is called before each and may throw to break off. Throws Error{badInput} when
/// their bodies are not the same.
TakeComparison compareTakes(const TakeReader& a, const TakeReader& b,
                            const std::function<void()>& beforeFrame = {});

}  // namespace scree
