// E7: rings rain on poles. [GBF03 figure 1]  The heap is judged by its poses alone.
#include <algorithm>
#include <cmath>

#include "core/math/rotation.h"
#include "io/take_reader.h"
#include "tools/stop_signals.h"
#include "tools/verify/experiments.h"
#include "tools/verify/heap_record.h"
#include "tools/verify/pose_judge.h"
#include "tools/verify/step_energy.h"

namespace scree::verify {
namespace {

using enum Weight;

constexpr double kTube = 0.5, kRing = 1.5, kPoleHeight = 20.0;  // of the shots [m]

bool isNamed(const HeapRecord& record, std::size_t body, const char* name)
{
    return record.scene.bodies[body].name.starts_with(name);
}

std::vector<std::size_t> bodiesNamed(const HeapRecord& record, const char* name)
{
    std::vector<std::size_t> bodies;
    for (std::size_t b = 0; b < record.scene.bodies.size(); ++b) {
        if (isNamed(record, b, name)) bodies.push_back(b);
    }
    return bodies;
}

/// Where the pole's axis meets the plane of the ring, if it does so within the pole's height and
/// the ring's hole.
bool isThreaded(const Pose& ring, const Pose& pole)
{
    const Vec3 normal = ring.orientation * Vec3::UnitY();
    const Vec3 axis = pole.orientation * Vec3::UnitY();
    if (std::abs(normal.dot(axis)) < 1e-9) return false;
    const double along = normal.dot(ring.position - pole.position) / normal.dot(axis);
    const Vec3 meeting = pole.position + along * axis;
    return std::abs(along) < 0.5 * kPoleHeight && (meeting - ring.position).norm() < kRing;
}

int threadedRings(const HeapRecord& record)
{
    int count = 0;
    for (std::size_t ring : bodiesNamed(record, "ring")) {
        for (std::size_t pole : bodiesNamed(record, "pole")) {
            count += isThreaded(record.frames.back().worldFromAsset[ring],
                                record.frames.back().worldFromAsset[pole]);
        }
    }
    return count;
}

/// Whether a point of the pole's axis is inside the ring's material.
bool axisCrosses(const PoseJudge& judge, const SceneFrame& frame, std::size_t ring,
                 std::size_t pole)
{
    const Pose& poleNow = frame.worldFromAsset[pole];
    const Vec3 toRing = frame.worldFromAsset[ring].position - poleNow.position;
    const Vec3 axis = poleNow.orientation * Vec3::UnitY();
    const double middle = toRing.dot(axis), reach = kRing + kTube;
    if ((toRing - middle * axis).norm() > reach) return false;
    for (double s = -reach; s <= reach; s += 0.1 * kTube) {
        if (std::abs(middle + s) > 0.5 * kPoleHeight) continue;
        if (judge.depthIn(frame, ring, poleNow.position + (middle + s) * axis) > 0.0) return true;
    }
    return false;
}

struct Depths {
    double rings = 0.0, poles = 0.0, floor = 0.0;  // deepest in any frame [m]
    int crossed = 0;                               // frames in which an axis crosses a ring
    Curve perFrame;
};

Depths judgeFrames(const HeapRecord& record)
{
    const PoseJudge judge(record.scene);
    const std::vector<std::size_t> rings = bodiesNamed(record, "ring");
    const std::vector<std::size_t> poles = bodiesNamed(record, "pole");
    Depths depths;
    for (std::size_t f = 0; f < record.frames.size(); ++f) {
        heedStop(kTakesAreKept);
        const SceneFrame& frame = record.frames[f];
        double deepest = 0.0;
        for (const Overlap& pair : judge.overlaps(frame)) {
            const bool hasPole = isNamed(record, pair.a, "pole") || isNamed(record, pair.b, "pole");
            const bool hasRings =
                isNamed(record, pair.a, "ring") && isNamed(record, pair.b, "ring");
            double& kind = hasRings ? depths.rings : hasPole ? depths.poles : depths.floor;
            kind = larger(kind, pair.depth);
            deepest = larger(deepest, pair.depth);
        }
        bool isCrossed = false;
        for (std::size_t ring : rings) {
            for (std::size_t pole : poles) {
                isCrossed = isCrossed || axisCrosses(judge, frame, ring, pole);
            }
        }
        depths.crossed += isCrossed;
        depths.perFrame.x.push_back(static_cast<double>(f) / record.scene.framesPerSecond);
        depths.perFrame.y.push_back(1000.0 * deepest);
    }
    return depths;
}

double heapHeight(const HeapRecord& record, std::size_t frame)
{
    std::vector<double> heights;
    for (std::size_t ring : bodiesNamed(record, "ring")) {
        heights.push_back(record.frames[frame].worldFromAsset[ring].position.y());
    }
    std::sort(heights.begin(), heights.end());
    return quantile(heights, 0.9);
}

void addDepthRows(const Context& context, const HeapRecord& record, const std::string& name,
                  Findings& findings)
{
    Depths depths = judgeFrames(record);
    findings.atMost(must, name + ": below the floor, any frame", depths.floor, 0.02, "m");
    findings.equal(must, name + ": frames in which a pole's axis crosses a ring", depths.crossed,
                   0);
    const Weight weight = context.method == "scree" ? must : goal;
    findings.atMost(weight, name + ": ring in ring, any frame", depths.rings, 0.1 * kTube, "m",
                    "dense samples; a tenth of the tube");
    findings.atMost(weight, name + ": ring in pole, any frame", depths.poles, 0.1 * kTube, "m");
    depths.perFrame.name = name;
    findings.plots.push_back({"Deepest overlap in a frame, by dense samples, " + name,
                              "time [s]",
                              "depth [mm]",
                              {depths.perFrame}});
}

/// Whether nothing but the level floor is near a ring. What rolls there rolls for ever: that it
/// keeps its speed is a must of E9.
bool isAlone(const std::vector<Pose>& poses, std::size_t ring,
             const std::vector<std::size_t>& rings, const std::vector<std::size_t>& poles)
{
    constexpr double kReach = kRing + kTube, kPole = 0.6;
    for (std::size_t other : rings) {
        const double away = (poses[other].position - poses[ring].position).norm();
        if (other != ring && away < 2.0 * kReach) return false;
    }
    for (std::size_t pole : poles) {
        Vec3 away = poses[pole].position - poses[ring].position;
        away.y() = 0.0;
        if (away.norm() < kReach + kPole) return false;
    }
    return true;
}

/// Of the rings in the last two seconds, all of them and those with others near them [m/s].
struct MeanSpeeds {
    double all = 0.0, inHeap = 0.0;
    double mostAlone = 0.0;  // how many are alone, at most
};

MeanSpeeds meanSpeeds(const HeapRecord& record)
{
    double all = 0.0, inHeap = 0.0, counted = 0.0, countedInHeap = 0.0;
    MeanSpeeds speeds;
    const std::vector<std::size_t> rings = bodiesNamed(record, "ring");
    const std::vector<std::size_t> poles = bodiesNamed(record, "pole");
    for (std::size_t f = record.lastPart(2.0); f < record.frames.size(); ++f) {
        double alone = 0.0;
        for (std::size_t ring : rings) {
            const double speed = speedOf(record, f, ring);
            all += speed;
            counted += 1.0;
            if (isAlone(record.frames[f].worldFromAsset, ring, rings, poles)) {
                alone += 1.0;
                continue;
            }
            inHeap += speed;
            countedInHeap += 1.0;
        }
        speeds.mostAlone = larger(speeds.mostAlone, alone);
    }
    speeds.all = all / counted;
    speeds.inHeap = countedInHeap > 0.0 ? inHeap / countedInHeap : 0.0;
    return speeds;
}

void addRestRows(const HeapRecord& record, const std::string& name, Findings& findings)
{
    const std::size_t first = record.lastPart(2.0), last = record.frames.size() - 1;
    double high = 0.0;
    for (std::size_t f = first; f <= last; ++f)
        high = larger(high, quantile(speedsAt(record, f), 0.95));
    const MeanSpeeds mean = meanSpeeds(record);
    findings.report(name + ": rings alone on the floor, last 2 s", mean.mostAlone, "");
    findings.atMost(must, name + ": mean speed in the last 2 s, of the others", mean.inHeap, 0.1,
                    "m/s");
    findings.atMost(departure, name + ": mean speed in the last 2 s, of all", mean.all, 0.1, "m/s",
                    "rings that have left the heap upright: without rolling friction nothing "
                    "brakes them on an endless floor, and a must of E9 forbids that anything does");
    findings.atMost(must, name + ": 95th percentile of the speed, last 2 s", high, 0.5, "m/s");
    findings.atMost(must, name + ": height of the heap's 90th percentile changes, last 2 s",
                    std::abs(heapHeight(record, last) / heapHeight(record, first) - 1.0), 0.01,
                    "of it");
    findings.atLeast(
        must, name + ": rings threaded on poles at the end", threadedRings(record), 10, "",
        "one ring in a hundred of an even draw begins straight above a pole; one or two "
        "more find one");
}

void addStepRow(const std::string& name, const StepEnergy& energy, Findings& findings)
{
    findings.atMost(must, name + ": energy rises in a step, of " + std::to_string(energy.steps),
                    energy.largestRise, 1e-3, "of (kinetic + m g l)", "work of push-out apart");
}

/// Of frames all along the take, each gone on from as a resumed run would.
void addRowsOfStates(const Context& context, const std::string& name, Findings& findings)
{
    constexpr std::size_t kEvery = 20;
    const TakeReader take(folderOfTake(context, name));
    const ShotRun built(context, "../" + name);
    StepEnergy energy(built.start, built.shot.settings.gravity);
    double speed = 0.0, spin = 0.0;
    for (std::size_t i = 0; i < take.frames().size(); i += kEvery) {
        const FrameState state = take.readState(take.frames()[i]);
        World world = built.start;
        world.motion = state.motion;
        world.order = state.order;
        world.clock = state.clock;
        world.contactMemory = state.contactMemory;
        for (std::size_t b = 0; b < world.bodyCount() && i == 0; ++b) {
            speed = larger(speed, world.motion[b].velocity.norm());
            spin = larger(spin, spinOf(world, static_cast<BodyId>(b)).norm());
        }
        energy.follow(world, built.shot, 1);
    }
    const std::string why = "the shot's rings start from rest";
    findings.atMost(must, name + ": start, speed", speed, 1.0, "m/s", why);
    findings.atMost(must, name + ": start, spin", spin, 1.0, "rad/s", why);
    addStepRow(name, energy, findings);
}

/// What the experiment demands of the shot itself: of its first frame and its length.
void addStartRows(const HeapRecord& record, const std::string& name, double height,
                  Findings& findings)
{
    const std::vector<std::size_t> rings = bodiesNamed(record, "ring");
    const std::vector<std::size_t> poles = bodiesNamed(record, "pole");
    const SceneFrame& start = record.frames.front();
    const auto trianglesOf = [&](std::size_t body) {
        return static_cast<double>(
            record.scene.meshes[record.scene.bodies[body].mesh].triangles.cols());
    };
    double radius = 0.0, low = 1e300, high = 0.0, tilt = 0.0;
    for (std::size_t ring : rings) {
        const Pose& pose = start.worldFromAsset[ring];
        const Vec3 axis = pose.orientation * Vec3::UnitY();
        radius = larger(radius, std::hypot(pose.position.x(), pose.position.z()));
        low = smaller(low, pose.position.y());
        high = larger(high, pose.position.y());
        tilt = larger(tilt, std::acos(std::min(1.0, std::abs(axis.y()))));
    }
    findings.equal(must, name + ": frames of the shot", record.framesOfShot, 720);
    findings.equal(must, name + ": poles", static_cast<double>(poles.size()), 25);
    findings.equal(must, name + ": triangles of a ring", trianglesOf(rings.front()), 320);
    findings.equal(must, name + ": triangles of a pole", trianglesOf(poles.front()), 880);
    findings.atMost(must, name + ": start, farthest from the axis", radius, 20.0, "m");
    findings.atLeast(must, name + ": start, lowest", low, 30.0, "m");
    findings.atMost(must, name + ": start, highest", high, 30.0 + height, "m");
    findings.atMost(must, name + ": start, tilt", tilt, 0.2, "rad");
    findings.atMost(must, name + ": start, overlap", PoseJudge(record.scene).deepestOverlap(start),
                    0.0, "m");
}

void largeShot(const Context& context, const std::string& name, double height, Findings& findings)
{
    const std::optional<HeapRecord> record = largeTake(context, name, findings);
    if (!record) return;
    addStartRows(*record, name, height, findings);
    addCommonRows(*record, name, must, findings);
    addRowsOfStates(context, name, findings);
    addDepthRows(context, *record, name, findings);
    addRestRows(*record, name, findings);
    addTakePictures(context, name, {0.15, 0.3, 0.5, 1.0}, false, name, findings);
}

/// Twelve rings and a pole; and the judge on a frame that has been spoilt.
void smallShot(const Context& context, Findings& findings)
{
    ShotRun run(context, "E07_rings");
    StepEnergy energy(run.start, run.shot.settings.gravity);
    const int every = context.isFull() ? 1 : 10;  // to take frames by steps takes twice their time
    HeapRecord record = recordRun(run, 60, [&](int frame) {
        if (frame % every == 0) energy.follow(run.world, run.shot, 1);
    });
    addCommonRows(record, "twelve rings", must, findings);
    addStepRow("twelve rings", energy, findings);
    addDepthRows(context, record, "twelve rings", findings);
    findings.atLeast(must, "twelve rings: threaded on the pole", threadedRings(record), 4, "");
    addPicture(context, run, "Twelve rings after 2.5 s", findings);

    SceneFrame& spoilt = record.frames.back();
    const std::vector<std::size_t> rings = bodiesNamed(record, "ring");
    spoilt.worldFromAsset[rings[0]] = spoilt.worldFromAsset[rings[1]];
    spoilt.worldFromAsset[rings[0]].position.y() += 2.0 * kTube - 0.1;
    const Vec3 tube(kRing, 0.0, 0.0);
    Pose& pierced = spoilt.worldFromAsset[rings[2]];
    pierced.orientation = Quat::Identity();
    pierced.position = Vec3(0.0, 12.0, 0.0) - tube;
    record.frames = {spoilt};
    const Depths seen = judgeFrames(record);
    findings.atLeast(control, "a frame spoilt by hand: the judge sees rings 10 cm in each other",
                     seen.rings, 0.05, "m");
    findings.equal(control, "a frame spoilt by hand: the judge sees a ring on the pole's axis",
                   seen.crossed, 1);
}

}  // namespace

void runRings(const Context& context, Findings& findings)
{
    smallShot(context, findings);
    if (!context.isFull()) return;
    largeShot(context, "rings_paper_500", 300.0, findings);
    largeShot(context, "rings_paper_1000", 600.0, findings);
}

}  // namespace scree::verify
