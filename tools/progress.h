// How far a long command is: one redrawn line on a terminal, lines for a farm elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "tools/console.h"

namespace scree {

/// Between two words of what takes long: a farm takes a minute of silence for a hang.
inline constexpr std::chrono::seconds kLongestSilence{45};

enum class ProgressMode { automatic, tty, alf, json, none };

/// "auto", "tty", "alf", "json" or "none"; throws Error{usage}.
ProgressMode parseProgressMode(const std::string& word);

/// What "automatic" comes to: a redrawn line on a terminal, lines for a farm elsewhere, JSON among
/// messages in JSON, nothing where all is quiet. A dumb terminal gets lines whoever asks for what.
ProgressMode chosenMode(ProgressMode mode, const Console& console);

/// What is told of a frame besides its number; pictures have neither bodies nor contacts.
struct ProgressFigures {
    int bodiesAwake = -1;
    std::int64_t contacts = -1;
};

/// Frames are counted, not numbered: `frameCount` in all, of which `framesDone` were there before.
class Progress {
public:
    Progress(Console& console, ProgressMode mode, const std::string& what, int frameCount,
             int framesDone = 0);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// A frame is done; `seconds` is what `share` of it (0 … 1) cost: of one that was begun in an
    /// earlier sitting only the rest was timed.
    void frameDone(int frame, double seconds, const ProgressFigures& figures = {},
                   double share = 1.0);

    /// Still inside `frame`, `share` of it done (0 … 1): keeps watchers from giving up on a long
    /// one.
    void insideFrame(int frame, double share);

private:
    using Time = std::chrono::steady_clock::time_point;

    void show(int frame, double done, bool isFrameDone);
    void showLine(int frame);
    std::string statusLine(int frame) const;
    std::string jsonLine(int frame) const;
    std::string barFor(std::size_t otherColumns) const;
    double secondsLeft() const;

    Console& console_;
    ProgressMode mode_;
    std::string what_;
    int frameCount_;
    int framesDone_;
    int percent_ = -1;
    double done_ = 0.0;                      // frames, with the share of the present one
    std::optional<double> secondsPerFrame_;  // running mean, recent frames count more
    std::size_t columns_ = 0;                // of the terminal
    ProgressFigures figures_;
    Time shown_ = {};
};

}  // namespace scree
