// E8: bones fall through a funnel into a pit. [GBF03 figures 2, 8, 9]  The heap is judged by its
// poses alone.
#include <algorithm>
#include <cmath>
#include <map>

#include "tools/stop_signals.h"
#include "tools/verify/experiments.h"
#include "tools/verify/heap_record.h"
#include "tools/verify/pose_judge.h"

namespace scree::verify {
namespace {

using enum Weight;

constexpr double kInnerWall = 3.0, kWallHeight = 2.5;  // of the shots, the height at least [m]

struct Judgement {
    std::vector<double> ratios;  // ascending: of overlaps of bones, of the shorter edge of the two
    int outside = 0;             // bones outside the walls or under the floor, in any frame
};

bool isOutside(const Vec3& position)
{
    const double far = std::max(std::abs(position.x()), std::abs(position.z()));
    return position.y() < 0.0 || (position.y() < kWallHeight && far > kInnerWall);
}

Judgement judgeFrames(const HeapRecord& record)
{
    const PoseJudge judge(record.scene);
    Judgement result;
    for (const SceneFrame& frame : record.frames) {
        heedStop(kTakesAreKept);
        for (const Overlap& pair : judge.overlaps(frame)) {
            double edge = 1e300;
            for (std::size_t body : {pair.a, pair.b}) {
                if (record.moves(body)) edge = smaller(edge, judge.shortestEdge(body));
            }
            result.ratios.push_back(pair.depth / edge);
        }
        for (std::size_t b = 0; b < record.scene.bodies.size(); ++b) {
            if (record.moves(b)) result.outside += isOutside(frame.worldFromAsset[b].position);
        }
    }
    std::sort(result.ratios.begin(), result.ratios.end());
    return result;
}

/// Where the funnel ends below.
double outletHeight(const HeapRecord& record)
{
    for (std::size_t b = 0; b < record.scene.bodies.size(); ++b) {
        if (record.scene.bodies[b].name != "funnel") continue;
        const Points& points = record.scene.meshes[record.scene.bodies[b].mesh].points;
        return record.frames.front().worldFromAsset[b].position.y() + points.row(1).minCoeff();
    }
    return 0.0;
}

/// Part of the bones that are below the outlet at the end.
double passed(const HeapRecord& record)
{
    const double outlet = outletHeight(record);
    double below = 0.0, all = 0.0;
    for (std::size_t b = 0; b < record.scene.bodies.size(); ++b) {
        if (!record.moves(b)) continue;
        all += 1.0;
        below += record.frames.back().worldFromAsset[b].position.y() < outlet;
    }
    return below / all;
}

void addOverlapRows(const Context& context, const HeapRecord& record, const std::string& name,
                    Findings& findings)
{
    const Judgement judgement = judgeFrames(record);
    const Weight weight = context.method == "scree" ? must : goal;
    findings.report(name + ": overlapping pairs seen in all frames",
                    static_cast<double>(judgement.ratios.size()), "");
    findings.atMost(must, name + ": overlap, 99 % of those pairs", quantile(judgement.ratios, 0.99),
                    0.02, "of the shortest edge", "dense samples");
    findings.atMost(weight, name + ": deepest overlap", quantile(judgement.ratios, 1.0), 0.1,
                    "of the shortest edge");
    findings.equal(must, name + ": bones outside the walls, any frame", judgement.outside, 0);
}

/// What the experiment demands of the shot itself. The paper: about 2.8 million triangles.
void addShotRows(const HeapRecord& record, const std::string& name, Findings& findings)
{
    std::map<Eigen::Index, int> bonesOf;  // by their triangles
    double largest = 0.0, narrowest = 1e300;
    for (std::size_t b = 0; b < record.scene.bodies.size(); ++b) {
        const SceneMesh& mesh = record.scene.meshes[record.scene.bodies[b].mesh];
        if (record.moves(b)) {
            const Vec3 size = mesh.points.rowwise().maxCoeff() - mesh.points.rowwise().minCoeff();
            largest = larger(largest, size.maxCoeff());
            ++bonesOf[mesh.triangles.cols()];
        } else if (record.scene.bodies[b].name == "funnel") {
            for (const auto& p : mesh.points.colwise())
                narrowest = smaller(narrowest, std::hypot(p.x(), p.z()));
        }
    }
    findings.equal(must, name + ": frames of the shot", record.framesOfShot, 240);
    for (const auto& [triangles, bones] : {std::pair{3520, 300}, {8680, 150}, {8160, 50}}) {
        findings.equal(must, name + ": bones of " + std::to_string(triangles) + " triangles",
                       bonesOf[triangles], bones);
    }
    findings.equal(must, name + ": sorts of bones", static_cast<double>(bonesOf.size()), 3);
    findings.atLeast(must, name + ": width of the outlet", 2.0 * narrowest / largest, 1.5,
                     "of the largest bone");
}

void largeShot(const Context& context, Findings& findings)
{
    const std::string name = "bones_500";
    const std::optional<HeapRecord> record = largeTake(context, name, findings);
    if (!record) return;
    addShotRows(*record, name, findings);
    addCommonRows(*record, name, goal, findings);
    findings.atLeast(must, name + ": passed the funnel", passed(*record), 0.9, "of them",
                     "a jam is no failure if overlaps are within limits; the picture shows it");
    addOverlapRows(context, *record, name, findings);
    addTakePictures(context, name, {0.2, 0.4, 0.7, 1.0}, false, "Figure 8: " + name, findings);
    addTakePictures(context, name, {0.4}, true, "Figure 9: " + name, findings);
}

void smallShot(const Context& context, Findings& findings)
{
    ShotRun run(context, "E08_bones");
    HeapRecord record = recordRun(run, context.isFull() ? 48 : 24);
    addOverlapRows(context, record, "six bones", findings);
    if (context.isFull()) {
        findings.atLeast(must, "six bones: passed the funnel", passed(record), 0.9, "of them");
    }
    addPicture(context, run, "Figure 8 in short: six bones under the funnel", findings);
    addPicture(context, run, "Figure 9 in short: the same as wireframe", findings, true);
    // The judge must see a bone that was put a fifth of itself into another.
    SceneFrame spoilt = record.frames.back();
    std::vector<std::size_t> bones;
    for (std::size_t b = 0; b < record.scene.bodies.size(); ++b) {
        if (record.moves(b)) bones.push_back(b);
    }
    spoilt.worldFromAsset[bones[0]] = spoilt.worldFromAsset[bones[3]];
    spoilt.worldFromAsset[bones[0]].position.y() += 0.1;
    record.frames = {spoilt};
    const std::vector<double> seen = judgeFrames(record).ratios;
    findings.atLeast(control, "a frame spoilt by hand: the judge sees bones in each other",
                     quantile(seen, 1.0), 0.02, "of the shortest edge");
}

}  // namespace

void runBones(const Context& context, Findings& findings)
{
    ShotRun still(context, "../bones_still");
    addPicture(context, still, "Figure 2: skull (3520 triangles), pelvis (8680), femur (8160)",
               findings);
    smallShot(context, findings);
    if (context.isFull()) largeShot(context, findings);
}

}  // namespace scree::verify
