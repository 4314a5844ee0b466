#include "tools/stoppable_build.h"

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <utility>

#include "tools/exit_code.h"
#include "tools/progress.h"
#include "tools/stop_signals.h"

namespace scree {
namespace {

using Clock = std::chrono::steady_clock;

/// Until it is told what takes so long.
constexpr std::chrono::seconds kUntilFirstWord{3};
/// A field of half a thousand voxels takes half a minute, and no part of it asks for signals: who
/// asked to stop would be killed before.
constexpr std::chrono::seconds kPatience{2};
constexpr std::chrono::milliseconds kBetweenLooks{100};

/// Passes on to a cache what is asked of it, by several threads.
class StoppableStore : public ShapeStore {
public:
    StoppableStore(ShapeCache& cache, Console& console, std::mutex& speaking)
        : cache_(cache), console_(console), speaking_(speaking)
    {
    }

    std::optional<DistanceField> findField(std::uint64_t key) override
    {
        heedSignals();
        return cache_.findField(key);
    }
    void keepField(std::uint64_t key, const DistanceField& field) override
    {
        cache_.keepField(key, field);
        heedSignals();
    }
    std::optional<TriMesh> findSolid(std::uint64_t key) override
    {
        heedSignals();
        return cache_.findSolid(key);
    }
    void keepSolid(std::uint64_t key, const TriMesh& solid) override
    {
        cache_.keepSolid(key, solid);
        heedSignals();
    }

private:
    void heedSignals()
    {
        const std::lock_guard guard(speaking_);
        heedEarlySignals(console_);
    }

    ShapeCache& cache_;
    Console& console_;
    std::mutex& speaking_;
};

/// Beside the threads that build: says that they still do, and ends the program when a request to
/// stop is not heeded soon. What stands on disk is whole at every instant.
class BuildWatch {
public:
    BuildWatch(Console& console, std::mutex& speaking)
        : console_(console), speaking_(speaking), thread_([this] { watch(); })
    {
    }
    ~BuildWatch()
    {
        {
            const std::lock_guard guard(ending_);
            isOver_ = true;
        }
        ended_.notify_one();
        thread_.join();
    }
    BuildWatch(const BuildWatch&) = delete;
    BuildWatch& operator=(const BuildWatch&) = delete;

private:
    void watch()
    {
        Clock::time_point nextWord = Clock::now() + kUntilFirstWord, stopBy = {};
        std::string word = "making the shapes of the shot";
        std::unique_lock lock(ending_);
        while (!ended_.wait_for(lock, kBetweenLooks, [this] { return isOver_; })) {
            const Clock::time_point now = Clock::now();
            if (stopRequested() && stopBy == Clock::time_point{}) stopBy = now + kPatience;
            if (stopBy != Clock::time_point{} && now > stopBy) end();
            if (now < nextWord) continue;
            nextWord = now + kLongestSilence;
            const std::lock_guard guard(speaking_);
            console_.info(std::exchange(word, "still making the shapes of the shot"));
        }
    }

    [[noreturn]] void end()
    {
        const std::lock_guard guard(speaking_);
        console_.info(kStoppedBeforeFrames);
        std::_Exit(kExitStopped);
    }

    Console& console_;
    std::mutex& speaking_;
    std::mutex ending_;
    std::condition_variable ended_;
    bool isOver_ = false;
    std::thread thread_;  // last: it begins with all of the above
};

}  // namespace

void heedEarlySignals(Console& console)
{
    heedStop();
    if (takeSaveRequest())
        console.answer("scree: still making the shapes; there is nothing to save yet");
}

World buildStoppably(const Shot& shot, ShapeCache& cache, Console& console)
{
    std::mutex speaking;
    StoppableStore store(cache, console, speaking);
    World world = [&] {
        const BuildWatch watch(console, speaking);
        return buildWorld(shot, &store);
    }();
    if (!cache.problem().empty()) console.warning("cache of shapes: " + cache.problem());
    heedEarlySignals(console);
    return world;
}

}  // namespace scree
