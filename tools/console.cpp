#include "tools/console.h"

#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>

namespace scree {
namespace {

constexpr const char* kClearLine = "\r\033[K";

std::string timeNow()
{
    const std::time_t now = std::time(nullptr);
    std::tm utc = {};
    ::gmtime_r(&now, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

/// One write for the whole line, so that lines of several processes do not mix.
void writeNow(const std::string& text)
{
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

}  // namespace

void Console::detail(const std::string& message)
{
    if (isVerbose) log("detail", "", message);
}

void Console::info(const std::string& message)
{
    if (!isQuiet) log("info", "", message);
}

void Console::warning(const std::string& message)
{
    log("warning", "Warning: ", message);
}

void Console::error(const std::string& message)
{
    log("error", "Error: ", message);
}

void Console::answer(const std::string& message)
{
    log("info", "", message);
}

void Console::redraw(const std::string& status)
{
    status_ = status;
    writeNow(kClearLine + status_);
}

void Console::clearStatus()
{
    if (!status_.empty()) writeNow(kClearLine);
    status_.clear();
}

void Console::line(const std::string& text)
{
    writeNow(text + "\n");
}

void Console::log(const char* level, const char* prefix, const std::string& message)
{
    std::string text = prefix + message;
    if (format == LogFormat::json) {
        const nlohmann::ordered_json json = {
            {"time", timeNow()}, {"level", level}, {"message", message}};
        text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    }
    if (status_.empty())
        line(text);
    else
        writeNow(kClearLine + text + "\n" + status_);
}

}  // namespace scree
