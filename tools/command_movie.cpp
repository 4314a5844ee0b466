// Pictures → MP4, by ffmpeg, which is a program of its own and is told so in one printed line.
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <optional>
#include <thread>

#include "core/base/parallel.h"
#include "io/atomic_file.h"
#include "io/file_bytes.h"
#include "io/frame_pattern.h"
#include "io/take_reader.h"
#include "io/text_forms.h"
#include "tools/command_line.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/parts_progress.h"
#include "tools/picture_file.h"
#include "tools/shell_line.h"
#include "tools/stop_signals.h"
#include "tools/take_export.h"
#include "tools/take_frames.h"

extern char** environ;

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kLookAtChild{20};

struct MovieOptions {
    std::string input, output, progress = "auto";
    double framesPerSecond = 0.0;
};

/// Pictures of a sequence, evenly spaced.
struct PictureSequence {
    fs::path pattern;  ///< with one place for the frame number
    std::vector<int> frames;
    std::optional<TakeInfo> take;  ///< whose pictures they are, where a take was named
    double framesPerSecond = 24.0;
};

/// The numbers for which the pattern names a file.
std::vector<int> findFrames(const fs::path& pattern)
{
    const fs::path folder = pattern.has_parent_path() ? pattern.parent_path() : fs::path(".");
    std::vector<int> frames;
    std::error_code code;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
        const auto frame = frameOf(pattern.filename().string(), entry.path().filename().string());
        if (frame) frames.push_back(*frame);
    }
    std::sort(frames.begin(), frames.end());
    return frames;
}

PictureSequence findPictures(const MovieOptions& options)
{
    PictureSequence sequence;
    if (const std::string obstacle = obstacleTo(options.input); !obstacle.empty())
        throw Error(ErrorKind::missingInput,
                    "\"" + options.input + "\" cannot be reached: " + obstacle);
    std::error_code code;
    if (fs::exists(TakePaths{options.input}.info(), code)) {
        const TakeReader take(options.input);
        sequence.pattern = take.paths().root / "images" / (take.info().name + ".####.png");
        sequence.framesPerSecond = take.info().framesPerSecond;
        sequence.take = take.info();
        sequence.frames = findFrames(sequence.pattern);
        if (sequence.frames.empty())
            throw Error(ErrorKind::missingInput, "\"" + options.input +
                                                     "\" has no pictures yet: scree render " +
                                                     options.input + " draws them");
    } else if (hasFramePattern(options.input)) {
        sequence.pattern = options.input;
        sequence.frames = findFrames(sequence.pattern);
    } else {
        throw Error(ErrorKind::missingInput,
                    "\"" + options.input + "\" is neither a take nor a pattern like name.####.png");
    }
    if (sequence.frames.empty())
        throw Error(ErrorKind::missingInput, "no picture fits \"" + options.input + "\"");
    if (options.framesPerSecond > 0.0) sequence.framesPerSecond = options.framesPerSecond;
    return sequence;
}

/// Distance of the pictures in frames; throws when it changes, for then the motion would stutter.
int spacingOf(const PictureSequence& sequence)
{
    const std::vector<int>& frames = sequence.frames;
    if (frames.size() < 2) return 1;
    const int spacing = frames[1] - frames[0];
    for (std::size_t i = 2; i < frames.size(); ++i)
        if (frames[i] - frames[i - 1] != spacing)
            throw Error(ErrorKind::missingInput,
                        "the pictures have gaps: " + describeFrames(frames) +
                            "; render the missing ones first");
    return spacing;
}

/// Who names a take wants the whole shot on film; who names a pattern wants the pictures that are
/// there.
TakeFrames tellMissingPictures(const MovieOptions& options, const PictureSequence& sequence,
                               Console& console)
{
    TakeFrames chosen{sequence.frames, ""};
    if (!sequence.take) return chosen;
    // Of every n-th picture the last stands for the frames up to the next one.
    const int between = spacingOf(sequence) - 1;
    chosen.missing = framesBeyond(*sequence.take, sequence.frames.front() - between,
                                  sequence.frames.back() + between);
    if (!chosen.missing.empty())
        console.warning("\"" + options.input + "\" has no pictures of frames " + chosen.missing +
                        "; " + shellLine({"scree", "render", options.input}) +
                        " draws those that are simulated, the pattern " +
                        sequence.pattern.string() + " asks for these alone");
    return chosen;
}

/// ffmpeg passes over pictures that are damaged: the film would be a frame short, or show one half
/// grey.
void requireWholePictures(const PictureSequence& sequence)
{
    if (sequence.pattern.extension() != ".png") return;
    setThreadCount(threadsToUse(std::nullopt));
    parallelFor(sequence.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && !stopRequested(); ++i)
            requireWholePngFile(expandFramePattern(sequence.pattern.string(), sequence.frames[i]));
    });
}

/// What ffmpeg takes for a file whatever letters it has: "a:b.png" is one of a protocol called a,
/// and "-a.mp4" an option.
std::string plainFile(const std::string& path)
{
    return path.starts_with('/') ? path : "./" + path;
}

/// In ffmpeg's patterns % begins a number; in its globs * ? [ ] \ have a meaning.
std::string escaped(const std::string& text, const char* special, char escape)
{
    std::string result;
    for (const char letter : text) {
        if (std::strchr(special, letter)) result += escape;
        result += letter;
    }
    return result;
}

/// The pictures one by one, as a single stream; empty where ffmpeg cannot be told them so.
std::vector<std::string> listedInput(const PictureSequence& sequence)
{
    constexpr std::size_t kLongestArgument = 120'000;  // the system takes no more in one piece
    std::string list = "concat:";
    for (const int frame : sequence.frames) {
        const std::string name = expandFramePattern(sequence.pattern.string(), frame);
        list += (list.ends_with(':') ? "file:" : "|file:") + name;
        if (name.find('|') != std::string::npos || !name.ends_with(".png") ||
            list.size() >= kLongestArgument)
            return {};
    }
    return {"-f",         "png_pipe",
            "-framerate", formatted("%.10g", sequence.framesPerSecond / spacingOf(sequence)),
            "-i",         list};
}

/// Every picture by a numbered pattern. Others one by one: ffmpeg counts -7 as one digit more than
/// we do, and its globs sort it before -12, and 10000 before 9990, and take what is no picture of
/// the sequence. For a list that is too long a glob has to do, if it sorts as the numbers do.
std::vector<std::string> inputArguments(const PictureSequence& sequence)
{
    const int spacing = spacingOf(sequence);
    const SplitPattern split = splitFramePattern(sequence.pattern.string());
    if (spacing == 1 && sequence.frames.front() >= 0) {
        return {"-framerate",
                formatted("%.10g", sequence.framesPerSecond),
                "-start_number",
                std::to_string(sequence.frames.front()),
                "-i",
                plainFile(escaped(split.head, "%", '%')) + "%0" + std::to_string(split.digits) +
                    "d" + escaped(split.tail, "%", '%')};
    }
    const std::vector<std::string> listed = listedInput(sequence);
    if (!listed.empty()) return listed;
    const auto lengthOf = [&](int frame) {
        return expandFramePattern(sequence.pattern.string(), frame).size();
    };
    const std::size_t length = lengthOf(sequence.frames.front());
    if (sequence.frames.front() < 0 || length != lengthOf(sequence.frames.back()))
        throw Error(ErrorKind::usage,
                    "\"" + sequence.pattern.string() +
                        "\": ffmpeg cannot be told these pictures, whose numbers are below 0 or of "
                        "several lengths; give them others, or shorter names that end in .png");
    const char* special = "*?[]\\{}";
    const std::string number(length - split.head.size() - split.tail.size(), '?');
    return {"-framerate",
            formatted("%.10g", sequence.framesPerSecond / spacing),
            "-pattern_type",
            "glob",
            "-i",
            plainFile(escaped(split.head, special, '\\')) + number +
                escaped(split.tail, special, '\\')};
}

/// Files that hold H.264 and that -movflags knows.
struct Container {
    const char *ending, *muxer;
};
constexpr Container kContainers[] = {{"mp4", "mp4"}, {"m4v", "mp4"}, {"mov", "mov"}};

/// ffmpeg's name of the container that the ending asks for.
std::string muxerOf(const std::string& name)
{
    const std::string ending = endingOf(name);
    std::string known;
    for (const Container& container : kContainers) {
        if (ending == container.ending) return container.muxer;
        known += (known.empty() ? "." : ", .") + std::string(container.ending);
    }
    throw Error(
        ErrorKind::usage,
        "\"" + name + "\" is no film that can be written; expected a name ending in " + known);
}

/// Plays everywhere: H.264, even sizes, 4:2:0, and says which colours it means.
std::vector<std::string> makeCommand(const PictureSequence& sequence, const std::string& muxer,
                                     const std::string& output)
{
    std::vector<std::string> command = {"ffmpeg",  "-nostdin", "-hide_banner", "-loglevel", "error",
                                        "-xerror", "-y"};
    for (const std::string& argument : inputArguments(sequence)) command.push_back(argument);
    for (const char* argument :
         {"-vf",
          "scale=trunc(iw/2)*2:trunc(ih/2)*2:out_color_matrix=bt709:out_range=tv,format=yuv420p",
          "-c:v", "libx264", "-preset", "medium", "-crf", "18", "-color_range", "tv",
          "-color_primaries", "bt709", "-color_trc", "bt709", "-colorspace", "bt709", "-movflags",
          "+faststart", "-f"})
        command.push_back(argument);
    command.push_back(muxer);
    command.push_back(plainFile(output));
    return command;
}

/// Waits for the child; passes on a request to stop, which may have reached this process alone.
int waitFor(pid_t child)
{
    int status = 0;
    bool isStopping = false;
    while (true) {
        const pid_t ended = ::waitpid(child, &status, WNOHANG);
        if (ended == child) return status;
        if (ended < 0 && errno != EINTR)
            throw Error(ErrorKind::inputOutput,
                        std::string("cannot learn how ffmpeg ended: ") + std::strerror(errno));
        if (stopRequested() && !isStopping) isStopping = ::kill(child, SIGTERM) == 0;
        std::this_thread::sleep_for(kLookAtChild);
    }
}

/// Runs a program found along PATH and waits for it. Its words go to stderr.
void runProgram(const std::vector<std::string>& command)
{
    std::vector<char*> arguments;
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
    pid_t child = 0;
    const int problem =
        ::posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (problem != 0)
        throw Error(ErrorKind::missingInput, command[0] + " cannot be started (" +
                                                 std::strerror(problem) +
                                                 "); on Debian: apt-get install " + command[0]);
    const int status = waitFor(child);
    if (stopRequested()) return;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw Error(ErrorKind::inputOutput,
                    command[0] + " failed; the command was: " + shellLine(command));
}

int runMovie(const MovieOptions& options, Console& console)
{
    const ProgressMode mode = parseProgressMode(options.progress);
    const std::string muxer = muxerOf(options.output);
    const PictureSequence sequence = findPictures(options);
    const TakeFrames chosen = tellMissingPictures(options, sequence, console);
    const fs::path named = options.output;
    createFolderOf(named, console);
    // Says now, with its own error, when nothing can be created there; of a link it tells where to.
    const fs::path output = AtomicFile{named}.target();
    console.info(shellLine(makeCommand(sequence, muxer, named.string())));

    // ffmpeg does not tell how far it is.
    PartsProgress progress(console, mode, 2);
    requireWholePictures(sequence);
    progress.partDone();

    // Under another name first, such as AtomicFile gives: an interrupted ffmpeg leaves half a film.
    const fs::path temporary = output.parent_path() / ("." + output.filename().string() + "." +
                                                       std::to_string(::getpid()) + "-0.tmp");
    std::error_code code;
    try {
        runProgram(makeCommand(sequence, muxer, temporary.string()));
        heedStop("no film was made");
        fs::rename(temporary, output, code);
        if (code)
            throw Error(ErrorKind::cannotCreate,
                        "cannot create \"" + output.string() + "\": " + code.message());
    } catch (...) {
        fs::remove(temporary, code);
        throw;
    }
    progress.partDone();
    std::printf("%s\n", named.c_str());
    return finishTakeFrames(chosen, named.string(), console);
}

}  // namespace

Command addMovieCommand(CLI::App& program)
{
    auto options = std::make_shared<MovieOptions>();
    CLI::App* command = program.add_subcommand("movie", "Make an MP4 of pictures, with ffmpeg");
    command
        ->add_option("INPUT", options->input,
                     "A take whose pictures are drawn, or a pattern like name.####.png")
        ->required()
        ->type_name("TAKE|PATTERN");
    command->add_option("-o,--output", options->output, "The film to write: out.mp4 or out.mov")
        ->required();
    command->add_option("--fps", options->framesPerSecond, "Frames per second [of the shot, or 24]")
        ->check(complaintIfNotFinite)
        ->check(CLI::Range(0.01, 10000.0));
    addProgress(*command, options->progress);
    command->footer(
        "Of a take whose pictures end before its shot it makes what it can and ends with 66; a "
        "pattern "
        "means\nthe pictures that are there, at even distances.\nExample:\n  scree movie "
        "takes/rings_100 -o "
        "rings.mp4");
    return {command, [options](Console& console) { return runMovie(*options, console); }};
}

}  // namespace scree
