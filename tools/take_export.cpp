#include "tools/take_export.h"

#include <system_error>

#include "core/base/error.h"
#include "core/diagnostics/phase_timer.h"
#include "io/atomic_file.h"
#include "io/frame_writer.h"
#include "tools/command_line.h"
#include "tools/stop_signals.h"
#include "tools/take_painter.h"

namespace scree {
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
    Progress shown(console, progress, "export", frameCount);
    Stopwatch sinceLastWord;
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
        const bool isRecent =
            sinceLastWord.seconds() < static_cast<double>(kLongestSilence.count());
        if (progress != ProgressMode::none || isRecent) continue;
        sinceLastWord = {};
        console.info("still writing " + output.string() + ": frame " + std::to_string(frame) +
                     " of " + describeFrames(frames));
    }
    writer->finish();
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
