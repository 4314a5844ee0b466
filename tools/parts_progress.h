// How far a command is that works on no frames but on a few parts, of which one may last for
// minutes: a heap that is estimated, an experiment, a film that another program makes.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "tools/console.h"
#include "tools/progress.h"

namespace scree {

/// Lines for a farm, in the form of Progress. A thread says the last one again while a part lasts,
/// since nobody who works on it knows how long that will be. Most such commands are soon done:
/// unless lines are asked for the first comes when a farm would begin to wonder. On a terminal
/// nothing is said.
class PartsProgress {
public:
    PartsProgress(Console& console, ProgressMode mode, int partCount,
                  std::chrono::milliseconds longestSilence = kLongestSilence);
    ~PartsProgress();
    PartsProgress(const PartsProgress&) = delete;
    PartsProgress& operator=(const PartsProgress&) = delete;

    /// Whether lines are written.
    bool isShown() const { return mode_ == ProgressMode::alf || mode_ == ProgressMode::json; }

    /// By any thread.
    void partDone();

private:
    void beat();
    void say();

    Console& console_;
    ProgressMode mode_;
    int partCount_, partsDone_ = 0;
    std::chrono::milliseconds longestSilence_;
    std::mutex lock_;
    std::condition_variable wake_;
    std::chrono::steady_clock::time_point said_ = std::chrono::steady_clock::now();
    bool isAwaited_;  // by someone who asked for it, or who has heard the first line
    bool isOver_ = false;
    std::thread thread_;  // last: it begins with all of the above
};

}  // namespace scree
