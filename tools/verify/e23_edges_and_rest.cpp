// E23: edge against edge. [A8]  E25: dropped with all defaults, props come to rest. [A16, A44]
#include <algorithm>
#include <cmath>

#include "tools/verify/experiments.h"
#include "tools/verify/pose_judge.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {

using enum Weight;

void runEdgeAgainstEdge(const Context& context, Findings& findings)
{
    ShotRun run(context, "E23_beams");
    const PoseJudge judge(run.describe());
    double deepest = 0.0;
    run.advanceFrames(48, {}, [&](const World&, double) {
        deepest = larger(deepest, judge.deepestOverlap(run.capture()));
    });
    const BodyMotion& upper = run.motion("upper");
    findings.atMost(must, "overlap in any step", deepest, 1e-3, "m", "the beams are 1 m long");
    findings.near(must, "height at which it rests", upper.position.y(), 0.1 * std::sqrt(2.0), 1e-3,
                  "m");
    findings.atMost(must, "speed after 2 s", upper.velocity.norm(), 1e-3, "m/s");
    addPicture(context, run, "The upper beam at rest on the edge of the lower", findings);

    ShotRun blind(context, "E23_beams", {"shape.beam.edge_samples=false"});
    blind.advanceFrames(48);
    findings.atMost(context.controlOfPaper(), "with vertex samples alone: height after 2 s",
                    blind.motion("upper").position.y(), -0.5, "m", "it falls through");
}

namespace {

/// The prop stands on the floor from the start, as it was modelled, and has no reason to move.
void startInContact(const Context& context, const std::string& name, Findings& findings)
{
    const std::string file = "E25_" + name, upright = "body.prop.rotation=[0, 0, 0]";
    const ShotRun measured(context, file, {upright});
    const BodyId prop = measured.body("prop");
    Vec3 place = measured.shot.bodies[static_cast<std::size_t>(prop)].worldFromAsset.position;
    place.y() -= lowestVertex(measured.world, prop);
    ShotRun run(context, file, {upright, setVector("body.prop.position", place)});
    double moved = 0.0;
    run.advanceFrames(48, {}, [&](const World& now, double) {
        moved = larger(moved, largestVertexShift(run.start, now, prop));
    });
    findings.atMost(must, name + " started in exact contact: motion over 48 frames", moved, 1e-9,
                    "m");
}

}  // namespace

void runDropToRest(const Context& context, Findings& findings)
{
    const double allowed = context.method == "scree" ? 2e-4 : 1e-3;
    for (const char* name : {"cube", "ring", "wedge"}) {
        const std::string file = std::string("E25_") + name;
        const ShotRun measured(context, file);
        const BodyId prop = measured.body("prop");
        // Half a metre of air, whatever the pose.
        Vec3 place = measured.shot.bodies[static_cast<std::size_t>(prop)].worldFromAsset.position;
        place.y() += 0.5 - lowestVertex(measured.world, prop);
        ShotRun run(context, file, {setVector("body.prop.position", place)});
        const double size = run.world.shapeOf(prop).box.longestEdge();
        const double moved = 1e-6 * size;
        int still = 0, longestStill = 0;
        Vec3 before = run.world.motion[prop].position;
        run.advanceFrames(72, [&](const FrameReport&) {
            const bool isAbove = lowestVertex(run.world, prop) > allowed * size;
            const Vec3 now = run.world.motion[prop].position;
            still = isAbove && (now - before).norm() < moved ? still + 1 : 0;
            longestStill = std::max(longestStill, still);
            before = now;
        });
        const double gap = lowestVertex(run.world, prop) / size;
        findings.atMost(must, std::string(name) + ": speed after 3 s",
                        run.world.motion[prop].velocity.norm(), 1e-6, "m/s");
        findings.atMost(must, std::string(name) + ": spin after 3 s",
                        spinOf(run.world, prop).norm(), 1e-6, "rad/s");
        findings.atMost(must, std::string(name) + ": gap or overlap at rest", std::abs(gap),
                        allowed, "of its size");
        findings.atMost(must, std::string(name) + ": frames without motion above the floor",
                        longestStill, 2, "frames");
        addPicture(context, run, std::string("A ") + name + " at rest after 3 s", findings);
    }
    for (const char* name : {"cube", "ring", "wedge"}) startInContact(context, name, findings);
}

}  // namespace scree::verify
