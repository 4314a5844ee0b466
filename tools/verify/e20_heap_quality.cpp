// E20: a heap of mixed nonconvex bodies comes to rest in a bin. A goal: the full form takes long.
#include <algorithm>

#include "tools/verify/experiments.h"
#include "tools/verify/heap_record.h"
#include "tools/verify/pose_judge.h"

namespace scree::verify {
namespace {

using enum Weight;

double energyOf(const FrameFigures& figures)
{
    return figures.kineticEnergy + figures.potentialEnergy;
}

/// Largest gain of energy over any second of the second half, when the heap has settled.
double largestGain(const HeapRecord& record)
{
    const auto second = static_cast<std::size_t>(record.scene.framesPerSecond);
    double gain = 0.0;
    for (std::size_t f = record.frames.size() / 2; f + second < record.frames.size(); ++f) {
        gain = std::max(gain, energyOf(record.figures[f + second]) - energyOf(record.figures[f]));
    }
    return gain;
}

double deepestAtTheEnd(const HeapRecord& record)
{
    const PoseJudge judge(record.scene);
    double deepest = 0.0;
    for (const Overlap& pair : judge.overlaps(record.frames.back())) {
        double edge = 1e300;
        for (std::size_t body : {pair.a, pair.b}) {
            if (record.moves(body)) edge = std::min(edge, judge.shortestEdge(body));
        }
        deepest = std::max(deepest, pair.depth / edge);
    }
    return deepest;
}

}  // namespace

void runHeapQuality(const Context& context, Findings& findings)
{
    const int bodies = context.isFull() ? 200 : 16, frames = context.isFull() ? 480 : 72;
    ShotRun run(context, "E20_heap", {"emitter.prop.count=" + std::to_string(bodies)});
    const HeapRecord record = recordRun(run, frames);
    const std::string name =
        std::to_string(bodies) + " bodies, " + std::to_string(frames / 24) + " s: ";
    findings.atMost(goal, name + "energy gained over any second of the second half",
                    largestGain(record), 0.0, "J");
    findings.atMost(goal, name + "fastest body at the end",
                    quantile(speedsAt(record, record.frames.size() - 1), 1.0), 0.01, "m/s");
    findings.atMost(goal, name + "deepest overlap at the end", deepestAtTheEnd(record), 0.01,
                    "of the shortest edge", "dense samples");
    addPicture(context, run, name + "the heap at the end", findings);
    findings.notRun(goal, "catenary arch of 25 stones, card house, nut on a bolt",
                    "no shots of these stand under shots/verify yet");
}

}  // namespace scree::verify
