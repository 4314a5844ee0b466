// A folder in which the program is started, asked to stop and started again, as a farm does.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "io/take_folder.h"
#include "tests/support/program.h"
#include "tests/support/support.h"

namespace scree::test {

inline void wait(int milliseconds)
{
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

inline bool says(const Outcome& outcome, const std::string& words)
{
    return outcome.err.find(words) != std::string::npos;
}

class ProgramFixture : public testing::Test {
protected:
    std::string file(const std::string& name) const { return (folder / name).string(); }

    /// Writes a shot; answers with its path.
    std::string shotFile(const std::string& name, const std::string& text) const
    {
        std::ofstream(file(name)) << text;
        return file(name);
    }

    /// Waits until the running program has written the frame.
    bool waitForFrame(const std::string& take, int frame) const
    {
        const std::filesystem::path path = TakePaths{file(take)}.frame(frame);
        for (int i = 0; i < 20000 && !std::filesystem::exists(path); ++i) wait(1);
        return std::filesystem::exists(path);
    }

    /// Sends a signal to the command while it is at work, and answers with how it ended. On a quiet
    /// machine it may be done before, on a busy one not listening yet: then it is tried again,
    /// sooner or later in its life [ms].
    static Outcome signalled(const std::vector<std::string>& words, int number, int soon = 250)
    {
        Outcome outcome;
        for (int tries = 0; tries < 8; ++tries) {
            Program program(words);
            wait(soon);
            program.signal(number);
            outcome = program.wait();
            if (outcome.code == 75 || (outcome.code == 0 && says(outcome, "scree: "))) break;
            soon = outcome.code == 0 ? soon / 2 : 2 * soon;
        }
        return outcome;
    }

    /// How a run ended that was stopped again and again.
    struct Sittings {
        int stops = 0;
        Outcome last;
    };

    /// Starts the command until it ends by itself, each time a little later asked to stop, now and
    /// then to save before.
    static Sittings runInSittings(const std::vector<std::string>& words)
    {
        Sittings sittings;
        for (int tries = 0; tries < 200; ++tries) {
            Program program(words);
            wait(60 + 7 * tries);
            if (tries % 3 == 1) program.signal(SIGUSR1);
            program.signal(SIGTERM);
            sittings.last = program.wait();
            const bool isStopped = sittings.last.code == 75;
            // On a busy machine it is asked before it listens, which ends it.
            if (!isStopped && sittings.last.code >= 0) break;
            sittings.stops += isStopped;
        }
        return sittings;
    }

    TemporaryFolder folder;
};

}  // namespace scree::test
