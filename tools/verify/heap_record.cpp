#include "tools/verify/heap_record.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/build_world.h"
#include "io/take_reader.h"
#include "render/png_writer.h"
#include "tools/take_painter.h"

namespace scree::verify {
namespace {

constexpr std::array<int, 2> kPictureSize = {960, 540};

FrameFigures figuresOf(const FrameSummary& summary)
{
    const nlohmann::json line = nlohmann::json::parse(summary.line);
    return {summary.steps,
            summary.wallSeconds,
            summary.cpuSeconds,
            summary.kineticEnergy,
            line.value("potential_energy_J", 0.0),
            line.value("push_out_work_J", 0.0)};
}

double mean(const std::vector<double>& values)
{
    double sum = 0.0;
    for (double value : values) sum += value;
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// What m g ℓ of all bodies is: an overlap of a body's own thickness, lifted.
double weightScale(const HeapRecord& record)
{
    double sum = 0.0;
    for (const SceneBody& body : record.scene.bodies) {
        const Points& points = record.scene.meshes[body.mesh].points;
        const Vec3 size = points.rowwise().maxCoeff() - points.rowwise().minCoeff();
        sum += 9.8 * body.mass * size.minCoeff();
    }
    return sum;
}

}  // namespace

std::size_t HeapRecord::lastPart(double seconds) const
{
    const auto count = static_cast<std::size_t>(std::lround(seconds * scene.framesPerSecond));
    return frames.size() > count + 1 ? frames.size() - count : 1;
}

HeapRecord readTake(const std::filesystem::path& folder)
{
    const TakeReader take(folder);
    HeapRecord record;
    record.scene = take.describe();
    record.framesOfShot = take.info().lastFrame - take.info().firstFrame + 1;
    const std::vector<FrameSummary> stats = take.stats();
    for (int frame : take.frames()) {
        if (frame != take.info().firstFrame + static_cast<int>(record.frames.size())) break;
        record.frames.push_back(take.readFrame(frame));
        record.figures.emplace_back();
        for (const FrameSummary& summary : stats) {
            if (summary.frame == frame) record.figures.back() = figuresOf(summary);
        }
    }
    return record;
}

HeapRecord recordRun(ShotRun& run, int frames, const std::function<void(int)>& look)
{
    HeapRecord record;
    record.scene = run.describe();
    record.framesOfShot = frames + 1;
    record.frames.push_back(run.capture());
    record.figures.emplace_back();
    for (int frame = 0; frame < frames; ++frame) {
        if (look) look(frame);
        run.advanceFrames(1, [&](const FrameReport& report) {
            record.frames.push_back(run.capture());
            record.figures.push_back({report.steps, 0.0, 0.0, report.kineticEnergy,
                                      report.potentialEnergy, report.sum.pushOutWork});
        });
    }
    return record;
}

std::filesystem::path folderOfTake(const Context& context, const std::string& name)
{
    return context.takes / (name + "_" + context.method);
}

std::optional<HeapRecord> largeTake(const Context& context, const std::string& name,
                                    Findings& findings)
{
    const std::filesystem::path folder = folderOfTake(context, name);
    const std::filesystem::path shot = context.shots.parent_path() / (name + ".toml");
    if (context.simulate) context.simulate(shot, context.method, folder);
    std::string why = "no take is there";
    if (std::filesystem::exists(folder / "take.json")) {
        HeapRecord record = readTake(folder);
        // Speeds are told by two poses.
        if (record.frames.size() >= 2) return record;
        why = "the take has fewer than two frames";
    }
    findings.notRun(Weight::must, name,
                    why + ": scree sim " + shot.string() + " --set solver.method=" +
                        context.method + " -o " + folder.string() + " --resume");
    return {};
}

double speedOf(const HeapRecord& record, std::size_t frame, std::size_t body)
{
    const Vec3 moved = record.frames[frame].worldFromAsset[body].position -
                       record.frames[frame - 1].worldFromAsset[body].position;
    return moved.norm() * record.scene.framesPerSecond;
}

std::vector<double> speedsAt(const HeapRecord& record, std::size_t frame)
{
    std::vector<double> speeds;
    for (std::size_t b = 0; b < record.scene.bodies.size(); ++b) {
        if (record.moves(b)) speeds.push_back(speedOf(record, frame, b));
    }
    std::sort(speeds.begin(), speeds.end());
    return speeds;
}

double quantile(const std::vector<double>& ascending, double part)
{
    if (ascending.empty()) return 0.0;
    const double place = part * static_cast<double>(ascending.size() - 1);
    return ascending[static_cast<std::size_t>(std::lround(place))];
}

void addCommonRows(const HeapRecord& record, const std::string& name, Weight energyWeight,
                   Findings& findings)
{
    findings.equal(Weight::must, name + ": frames", static_cast<double>(record.frames.size()),
                   record.framesOfShot);
    const double scale = weightScale(record);
    double rise = 0.0;
    std::vector<double> wall, cpu;
    for (std::size_t f = 2; f < record.figures.size(); ++f) {
        const FrameFigures &before = record.figures[f - 1], &now = record.figures[f];
        const double gained = now.kineticEnergy + now.potentialEnergy - before.kineticEnergy -
                              before.potentialEnergy - now.pushOutWork;
        rise = larger(rise, gained / (now.kineticEnergy + scale));
        wall.push_back(now.wallSeconds);
        cpu.push_back(now.cpuSeconds);
    }
    findings.atMost(energyWeight, name + ": energy rises in a frame", rise, 1e-3,
                    "of (kinetic + m g l)", "work of push-out apart");
    if (mean(cpu) == 0.0) return;
    findings.report(name + ": processor time of a frame, mean", mean(cpu), "s");
    findings.report(name + ": processor time of a frame, longest",
                    *std::max_element(cpu.begin(), cpu.end()), "s");
    findings.report(name + ": wall time of a frame, mean", mean(wall), "s");
}

void addTakePictures(const Context& context, const std::string& name,
                     const std::vector<double>& parts, bool isWireframe, const std::string& caption,
                     Findings& findings)
{
    if (!context.wantsPictures) return;
    const TakeReader take(folderOfTake(context, name));
    PaintSettings settings;
    if (isWireframe) settings.look = LookKind::wireframe;
    TakePainter painter(take, "", kPictureSize, settings);
    for (double part : parts) {
        const double last = static_cast<double>(take.frames().size() - 1);
        const int frame = take.frames()[static_cast<std::size_t>(std::lround(part * last))];
        const double seconds = (frame - take.info().firstFrame) / take.info().framesPerSecond;
        findings.pictures.push_back(
            {caption + ", " + shortNumber(seconds) + " s", encodePng(painter.paint(frame))});
    }
}

}  // namespace scree::verify
