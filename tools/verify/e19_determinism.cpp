// E19: same shot, same bits, whatever the threads and wherever it was cut in two. [A21]

#include "core/base/parallel.h"
#include "core/diagnostics/state_hash.h"
#include "tools/verify/experiments.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

std::vector<std::uint64_t> hashes(ShotRun& run, int frames, int threads)
{
    const int before = threadCount();
    setThreadCount(threads);
    std::vector<std::uint64_t> result;
    run.advanceFrames(frames,
                      [&](const FrameReport& report) { result.push_back(report.stateHash); });
    setThreadCount(before);
    return result;
}

double differingFrames(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b)
{
    double count = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b.at(i);
    return count;
}

/// Goes on from `broken` in a fresh world with only what a checkpoint holds: motion, order, clock
/// and, for method scree, what contacts remember.
void goOn(ShotRun& fresh, const ShotRun& broken)
{
    fresh.world.motion = broken.world.motion;
    fresh.world.order = broken.world.order;
    fresh.world.clock = broken.world.clock;
    fresh.world.contactMemory = broken.world.contactMemory;
}

void sameBits(const Context& context, const std::string& shot, int frames, Findings& findings)
{
    ShotRun first(context, shot), again(context, shot);
    const auto once = hashes(first, frames, 1);
    const std::string name = first.shot.name + ", " + std::to_string(frames) + " frames";
    findings.equal(must, name + ": frames that differ on repetition",
                   differingFrames(once, hashes(again, frames, 1)), 0);
    for (int threads : {2, 8}) {
        ShotRun run(context, shot);
        findings.equal(must,
                       name + ": frames that differ with " + std::to_string(threads) + " threads",
                       differingFrames(once, hashes(run, frames, threads)), 0);
    }
    ShotRun front(context, shot), back(context, shot);
    front.advanceFrames(frames / 2);
    goOn(back, front);
    back.advanceFrames(frames - frames / 2);
    findings.equal(must, name + ": a checkpoint in the middle changes the last state",
                   stateHash(back.world) != once.back(), 0);
    ShotRun other(context, shot, {"shot.seed=77"});
    const double unlike = differingFrames(once, hashes(other, frames, 1));
    const std::string seeds = name + ": frames that differ with another seed";
    if (context.method == "paper")
        findings.atLeast(control, seeds, unlike, 1.0, "");
    else
        findings.atLeast(departure, seeds, unlike, 1.0, "",
                         "this method draws nothing: its order is that of the heap");
}

/// Another seed draws another order, and must not matter to what is seen.
void anotherSeed(const Context& context, Findings& findings)
{
    Context other = context;
    other.form = Form::brief;
    other.seed = 77;
    const std::vector<std::string> ids =
        context.isFull() ? std::vector<std::string>{"1", "2", "3", "4", "5", "6"}
                         : std::vector<std::string>{"3", "5"};
    for (const Experiment* experiment : chooseExperiments(ids)) {
        Findings seen;
        runExperiment(*experiment, other, seen);
        double broken = 0.0;
        std::string first;
        for (const Measurement& row : seen.rows) {
            if (isBroken(row) && broken++ == 0.0) first = row.what;
        }
        findings.equal(must, std::string("another seed, ") + experiment->id + ": rows that fail",
                       broken, 0, first);
    }
}

}  // namespace

void runDeterminism(const Context& context, Findings& findings)
{
    sameBits(context, "E04_stack_10", context.isFull() ? 48 : 12, findings);
    sameBits(context, "../rings_100", context.isFull() ? 48 : 24, findings);
    anotherSeed(context, findings);
}

}  // namespace scree::verify
