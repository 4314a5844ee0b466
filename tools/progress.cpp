#include "tools/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "tools/command_line.h"

namespace scree {
namespace {

constexpr int kBarWidth = 24;
constexpr double kRedrawSeconds = 0.1;   ///< a terminal
constexpr double kChattySeconds = 1.0;   ///< between lines for a farm inside one frame
constexpr double kSilentSeconds = 45.0;  ///< a farm takes a minute of silence for a hang
constexpr double kRecentWeight = 0.2;    ///< of the newest frame in the running mean

std::string bar(double share)
{
    const int filled = static_cast<int>(std::lround(kBarWidth * std::clamp(share, 0.0, 1.0)));
    return "[" + std::string(filled, '#') + std::string(kBarWidth - filled, '.') + "]";
}

}  // namespace

ProgressMode parseProgressMode(const std::string& word)
{
    if (word == "auto") return ProgressMode::automatic;
    if (word == "tty") return ProgressMode::tty;
    if (word == "alf") return ProgressMode::alf;
    if (word == "json") return ProgressMode::json;
    if (word == "none") return ProgressMode::none;
    throw Error(ErrorKind::usage,
                "--progress is auto, tty, alf, json or none, not \"" + word + "\"");
}

Progress::Progress(Console& console, ProgressMode mode, const std::string& what, int frameCount,
                   int framesDone)
    : console_(console), mode_(mode), what_(what), frameCount_(frameCount), framesDone_(framesDone)
{
    if (mode_ != ProgressMode::automatic) return;
    if (console_.isQuiet)
        mode_ = ProgressMode::none;
    else
        mode_ = ::isatty(STDERR_FILENO) ? ProgressMode::tty : ProgressMode::alf;
}

Progress::~Progress()
{
    console_.clearStatus();
}

void Progress::frameDone(int frame, double seconds, const ProgressFigures& figures)
{
    secondsPerFrame_ = secondsPerFrame_ == 0.0
                           ? seconds
                           : (1.0 - kRecentWeight) * secondsPerFrame_ + kRecentWeight * seconds;
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
    const bool isDue =
        mode_ == ProgressMode::tty ? silent > kRedrawSeconds || isFrameDone
        : mode_ == ProgressMode::json
            ? isFrameDone || silent > kSilentSeconds
            : (isNews && (isFrameDone || silent > kChattySeconds)) || silent > kSilentSeconds;
    percent_ = std::max(percent_, percent);
    if (!isDue) return;
    shown_ = now;
    showLine(frame);
}

void Progress::showLine(int frame)
{
    if (mode_ == ProgressMode::tty)
        console_.redraw(statusLine(frame));
    else if (mode_ == ProgressMode::json)
        console_.line(jsonLine(frame));
    else
        console_.line("ALF_PROGRESS " + std::to_string(percent_) + "%");
}

std::string Progress::statusLine(int frame) const
{
    std::string text = what_ + " " + bar(done_ / frameCount_) + " " + std::to_string(percent_) +
                       "%  frame " + std::to_string(frame);
    if (figures_.bodiesAwake >= 0) text += "  awake " + std::to_string(figures_.bodiesAwake);
    if (figures_.contacts >= 0) text += "  contacts " + std::to_string(figures_.contacts);
    if (secondsPerFrame_ > 0.0)
        text += "  " + describeDuration(secondsPerFrame_) + "/frame  left " +
                describeDuration(secondsLeft());
    return text;
}

std::string Progress::jsonLine(int frame) const
{
    nlohmann::ordered_json json = {{"progress", percent_}, {"frame", frame}};
    if (figures_.bodiesAwake >= 0) json["bodies_awake"] = figures_.bodiesAwake;
    if (figures_.contacts >= 0) json["contacts"] = figures_.contacts;
    json["seconds_per_frame"] = secondsPerFrame_;
    json["seconds_left"] = secondsLeft();
    return json.dump();
}

double Progress::secondsLeft() const
{
    return secondsPerFrame_ * std::max(frameCount_ - done_, 0.0);
}

}  // namespace scree
