#include "tools/take_export.h"

#include <cmath>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/diagnostics/phase_timer.h"
#include "io/atomic_file.h"
#include "io/frame_writer.h"
#include "io/text_forms.h"
#include "tools/command_line.h"
#include "tools/stop_signals.h"
#include "tools/take_painter.h"

namespace scree {
namespace {

/// Of an export: what its writer does at the end counts as so many frames more, so that all is done
/// where 100 % is said.
class ExportProgress {
public:
    ExportProgress(Console& console, ProgressMode mode, std::filesystem::path output,
                   const std::vector<int>& frames, double finishCost)
        : console_(console),
          isSilent_(mode == ProgressMode::none),
          output_(std::move(output)),
          frames_(frames),
          framesAtTheEnd_(
              static_cast<int>(std::lround(finishCost * static_cast<double>(frames.size())))),
          shown_(console, mode, "export", static_cast<int>(frames.size()) + framesAtTheEnd_)
    {
    }

    void frameDone(int frame, double seconds)
    {
        shown_.frameDone(frame, seconds);
        tellNowAndThen("frame " + std::to_string(frame) + " of " + describeFrames(frames_));
    }

    /// `share` of what the writer does at the end is done.
    void finishing(double share)
    {
        const int done = static_cast<int>(share * framesAtTheEnd_) - toldAtTheEnd_;
        const double seconds = done > 0 ? atTheEnd_.seconds() / done : 0.0;
        for (int i = 0; i < done; ++i) shown_.frameDone(frames_.back(), seconds);
        if (done > 0) atTheEnd_ = {};
        toldAtTheEnd_ += done;
        shown_.insideFrame(frames_.back(), 0.0);
        tellNowAndThen("all frames are read, " + percent(share) + " of the rest is done");
    }

    void finished() { finishing(1.0); }

private:
    /// Where no progress is shown; that of a simulation has reached its end and must not go back.
    void tellNowAndThen(const std::string& place)
    {
        if (!isSilent_ || sinceLastWord_.seconds() < static_cast<double>(kLongestSilence.count()))
            return;
        sinceLastWord_ = {};
        console_.info("still writing " + output_.string() + ": " + place);
    }

    Console& console_;
    bool isSilent_;
    std::filesystem::path output_;
    const std::vector<int>& frames_;
    int framesAtTheEnd_, toldAtTheEnd_ = 0;
    Progress shown_;
    Stopwatch sinceLastWord_, atTheEnd_;
};

}  // namespace

bool exportTake(const TakeReader& take, const std::vector<int>& frames,
                const std::filesystem::path& output, Console& console, ProgressMode progress)
{
    if (frames.empty())
        throw Error(ErrorKind::missingInput,
                    "\"" + take.paths().root.string() + "\" has no frames to export");
    const int frameCount = static_cast<int>(frames.size());
    if (frames.back() - frames.front() + 1 != frameCount)
        throw Error(ErrorKind::usage,
                    "an export needs frames without gaps, not " + describeFrames(frames));

    const std::unique_ptr<FrameWriter> writer = makeFrameWriter(output);
    createFolderOf(output, console);
    SceneDescription scene = take.describe();
    // A cache shows what the previews show, from where they show it.
    if (scene.cameras.empty()) scene.cameras.push_back(viewOfAction(take, scene, scene.aspect));
    for (const std::string& loss : writer->losses(scene))
        console.warning("\"" + output.string() + "\": " + loss);
    ExportProgress shown(console, progress, output, frames, writer->finishCost());
    const bool withSubframes = writer->holdsSubframes();
    writer->begin(scene, frames.front(), frameCount,
                  withSubframes ? take.offsets() : std::vector<double>{0.0});
    for (const int frame : frames) {
        if (stopRequested()) return false;
        const Stopwatch watch;
        if (withSubframes)
            for (const SceneFrame& sample : take.readSamples(frame)) writer->write(sample);
        else
            writer->write(take.readFrame(frame));
        shown.frameDone(frame, watch.seconds());
    }
    try {
        writer->finish([&](double share) {
            heedStop();
            shown.finishing(share);
        });
    } catch (const Stopped&) {
        return false;
    }
    shown.finished();
    return true;
}

std::filesystem::path defaultExport(const TakeReader& take, const std::string& ending)
{
    const std::string& name = take.info().name;
    const char* number = isFrameSequence(name + "." + ending) ? ".####." : ".";
    return take.paths().root / "exports" / (name + number + ending);
}

void createFolderOf(const std::filesystem::path& file, Console& console)
{
    refuseTakeFile(file);
    std::error_code code;
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), code);
    if (code)
        throw Error(
            ErrorKind::cannotCreate,
            "cannot create the folder \"" + file.parent_path().string() + "\": " + code.message());
    if (const int count = removeAbandoned(file); count > 0) {
        console.info("removed " + std::to_string(count) + (count == 1 ? " file" : " files") +
                     " that killed runs had left half written of \"" + file.string() + "\"");
    }
}

}  // namespace scree
