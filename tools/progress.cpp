#include "tools/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "io/nearest_word.h"
#include "tools/command_line.h"

namespace scree {
namespace {

constexpr std::size_t kLongestBar = 24, kShortestBar = 6;  ///< without its brackets
constexpr std::size_t kUsualColumns = 80;                  ///< where the terminal does not say
constexpr double kLeastShare = 0.1;     ///< of a frame that tells what a whole one costs
constexpr double kRedrawSeconds = 0.1;  ///< a terminal
constexpr double kChattySeconds = 1.0;  ///< between lines for a farm inside one frame
constexpr double kRecentWeight = 0.2;   ///< of the newest frame in the running mean

std::string bar(double share, std::size_t width)
{
    const auto filled = static_cast<std::size_t>(
        std::lround(static_cast<double>(width) * std::clamp(share, 0.0, 1.0)));
    return " [" + std::string(filled, '#') + std::string(width - filled, '.') + "]";
}

std::size_t terminalColumns()
{
    winsize size = {};
    const bool isTold = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return isTold ? size.ws_col : kUsualColumns;
}

/// A dumb terminal shows control codes as rubbish.
bool isDumb()
{
    const char* kind = std::getenv("TERM");
    return kind && std::string(kind) == "dumb";
}

}  // namespace

ProgressMode parseProgressMode(const std::string& word)
{
    if (word == "auto") return ProgressMode::automatic;
    if (word == "tty") return ProgressMode::tty;
    if (word == "alf") return ProgressMode::alf;
    if (word == "json") return ProgressMode::json;
    if (word == "none") return ProgressMode::none;
    throw Error(ErrorKind::usage, "--progress is auto, tty, alf, json or none, not \"" + word +
                                      "\"" +
                                      didYouMean(word, {"auto", "tty", "alf", "json", "none"}));
}

ProgressMode chosenMode(ProgressMode mode, const Console& console)
{
    if (mode == ProgressMode::tty && isDumb()) return ProgressMode::alf;
    if (mode != ProgressMode::automatic) return mode;
    if (console.isQuiet) return ProgressMode::none;
    // Who reads the log as JSON could not read other lines.
    if (console.format == LogFormat::json) return ProgressMode::json;
    return ::isatty(STDERR_FILENO) && !isDumb() ? ProgressMode::tty : ProgressMode::alf;
}

Progress::Progress(Console& console, ProgressMode mode, const std::string& what, int frameCount,
                   int framesDone)
    : console_(console),
      mode_(chosenMode(mode, console)),
      what_(what),
      frameCount_(frameCount),
      framesDone_(framesDone)
{
}

Progress::~Progress()
{
    console_.clearStatus();
}

void Progress::frameDone(int frame, double seconds, const ProgressFigures& figures, double share)
{
    if (share >= kLeastShare) {
        const double whole = seconds / share;
        secondsPerFrame_ = secondsPerFrame_
                               ? (1.0 - kRecentWeight) * *secondsPerFrame_ + kRecentWeight * whole
                               : whole;
    }
    figures_ = figures;
    ++framesDone_;
    show(frame, framesDone_, true);
}

void Progress::insideFrame(int frame, double share)
{
    show(frame, framesDone_ + std::clamp(share, 0.0, 1.0), false);
}

void Progress::show(int frame, double done, bool isFrameDone)
{
    if (mode_ == ProgressMode::none || frameCount_ <= 0) return;
    const Time now = std::chrono::steady_clock::now();
    const double silent = std::chrono::duration<double>(now - shown_).count();

    // A number that was said is never taken back.
    done_ = std::max(done_, std::min(done, static_cast<double>(frameCount_)));
    const int percent = static_cast<int>(100.0 * done_ / frameCount_);
    const bool isNews = percent > percent_;
    const bool isDue = mode_ == ProgressMode::tty ? silent > kRedrawSeconds || isFrameDone
                       : mode_ == ProgressMode::json
                           ? isFrameDone || silent > kLongestSilence.count()
                           : (isNews && (isFrameDone || silent > kChattySeconds)) ||
                                 silent > kLongestSilence.count();
    percent_ = std::max(percent_, percent);
    if (!isDue) return;
    shown_ = now;
    showLine(frame);
}

void Progress::showLine(int frame)
{
    if (mode_ == ProgressMode::tty) {
        columns_ = terminalColumns();  // each time: windows change their size
        console_.redraw(statusLine(frame));
    } else if (mode_ == ProgressMode::json) {
        console_.line(jsonLine(frame));
    } else {
        console_.line("ALF_PROGRESS " + std::to_string(percent_) + "%");
    }
}

/// Never wider than the terminal: a line that wraps cannot be redrawn. The bar gives way first,
/// then the figures of the frame.
std::string Progress::statusLine(int frame) const
{
    const std::string place = " " + std::to_string(percent_) + "%  frame " + std::to_string(frame);
    std::string awake, contacts, left;
    if (figures_.bodiesAwake >= 0) awake = "  awake " + std::to_string(figures_.bodiesAwake);
    if (figures_.contacts >= 0) contacts = "  contacts " + std::to_string(figures_.contacts);
    if (secondsPerFrame_)
        left = "  " + describeDuration(*secondsPerFrame_) + "/frame  left " +
               describeDuration(secondsLeft());
    const std::size_t needed = what_.size() + place.size() + left.size();
    if (needed + awake.size() + contacts.size() >= columns_) contacts.clear();
    if (needed + awake.size() + contacts.size() >= columns_) awake.clear();
    const std::string text =
        what_ + barFor(needed + awake.size() + contacts.size()) + place + awake + contacts + left;
    return text.substr(0, columns_ - 1);
}

/// As long as the rest of the line lets it be; the last column stays free.
std::string Progress::barFor(std::size_t otherColumns) const
{
    constexpr std::size_t kBrackets = 3;  // and the space before them
    if (otherColumns + kBrackets + kShortestBar >= columns_) return "";
    return bar(done_ / frameCount_, std::min(kLongestBar, columns_ - 1 - otherColumns - kBrackets));
}

std::string Progress::jsonLine(int frame) const
{
    nlohmann::ordered_json json = {{"progress", percent_}, {"frame", frame}};
    if (figures_.bodiesAwake >= 0) json["bodies_awake"] = figures_.bodiesAwake;
    if (figures_.contacts >= 0) json["contacts"] = figures_.contacts;
    // Nothing is known before a frame was timed, and 0 would say that it is done.
    json["seconds_per_frame"] = nullptr;
    json["seconds_left"] = nullptr;
    if (secondsPerFrame_) {
        json["seconds_per_frame"] = *secondsPerFrame_;
        json["seconds_left"] = secondsLeft();
    }
    return json.dump();
}

double Progress::secondsLeft() const
{
    return secondsPerFrame_.value_or(0.0) * std::max(frameCount_ - done_, 0.0);
}

}  // namespace scree
