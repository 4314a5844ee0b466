// How far a long command is: one redrawn line on a terminal, lines for a farm elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "tools/console.h"

namespace scree {

enum class ProgressMode { automatic, tty, alf, json, none };

/// "auto", "tty", "alf", "json" or "none"; throws Error{usage}.
ProgressMode parseProgressMode(const std::string& word);

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

    /// A frame is done; `seconds` is what it cost.
    void frameDone(int frame, double seconds, const ProgressFigures& figures = {});

    /// Still inside `frame`, `share` of it done (0 … 1): keeps watchers from giving up on a long
    /// one.
    void insideFrame(int frame, double share);

private:
    using Time = std::chrono::steady_clock::time_point;

    void show(int frame, double done, bool isFrameDone);
    void showLine(int frame);
    std::string statusLine(int frame) const;
    std::string jsonLine(int frame) const;
    double secondsLeft() const;

    Console& console_;
    ProgressMode mode_;
    std::string what_;
    int frameCount_;
    int framesDone_;
    int percent_ = -1;
    double done_ = 0.0;             // frames, with the share of the present one
    double secondsPerFrame_ = 0.0;  // running mean, recent frames count more
    ProgressFigures figures_;
    Time shown_ = {};
};

}  // namespace scree
