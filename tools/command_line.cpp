#include "tools/command_line.h"

#include <sched.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "core/base/error.h"
#include "io/nearest_word.h"
#include "io/text_forms.h"

namespace scree {
namespace {

/// More frames than any shot has: a slip of the keyboard, not a wish.
constexpr long kMostFrames = 1000000;

constexpr int kMostThreads = 1 << 16;

/// A flag that changes what an asset may hold.
struct LimitFlag {
    const char* flag;
    std::uint32_t ImportLimits::*value;
    const char* help;
};
constexpr LimitFlag kLimitFlags[] = {
    {"--import-points", &ImportLimits::points, "Points of a mesh, and triangles, at most"},
    {"--import-nodes", &ImportLimits::nodes, "Nodes of a file that show a mesh, at most"},
    {"--import-depth", &ImportLimits::depth, "Nodes nested in each other, at most"},
    {"--import-name", &ImportLimits::nameLength, "Letters in the name of a node, at most"},
};

[[noreturn]] void failFrames(const std::string& part)
{
    throw Error(ErrorKind::usage, "\"" + part +
                                      "\" is not a frame range; expected 1001, 1001-1240, "
                                      "1001-1240x2 or a list of these with commas");
}

long toNumber(const std::string& text, const std::string& part)
{
    long number = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
    if (result.ec != std::errc() || number < -kMostFrames * 10 || number > kMostFrames * 100)
        failFrames(part);
    return number;
}

std::optional<int> positiveNumber(const char* text)
{
    if (text == nullptr) return std::nullopt;
    int number = 0;
    const std::string value = text;
    const auto result = std::from_chars(value.data(), value.data() + value.size(), number);
    if (result.ec != std::errc() || number < 1) return std::nullopt;
    return number;
}

int affinityCount()
{
    cpu_set_t mask;
    CPU_ZERO(&mask);
    if (::sched_getaffinity(0, sizeof mask, &mask) != 0) return 1;
    return std::max(CPU_COUNT(&mask), 1);
}

/// Quota and period of one group: cpu.max of version 2, two files in version 1.
std::optional<double> quotaOfGroup(const std::filesystem::path& group)
{
    double quota = 0.0, period = 0.0;
    if (std::ifstream both(group / "cpu.max"); both) {
        both >> quota >> period;  // "max 100000" is no number: no limit
    } else {
        std::ifstream(group / "cpu.cfs_quota_us") >> quota;
        std::ifstream(group / "cpu.cfs_period_us") >> period;
    }
    if (quota <= 0.0 || period <= 0.0) return std::nullopt;
    return quota / period;
}

}  // namespace

std::vector<int> parseFrames(const std::string& text)
{
    static const std::regex kPart(R"(\s*(-?\d{1,9})(?:-(-?\d{1,9})(?:x(\d{1,9}))?)?\s*)");
    std::set<int> frames;
    std::istringstream list(text);
    std::string part;
    while (std::getline(list, part, ',')) {
        std::smatch match;
        if (!std::regex_match(part, match, kPart)) failFrames(part);
        const long first = toNumber(match[1], part);
        const long last = match[2].matched ? toNumber(match[2], part) : first;
        const long step = match[3].matched ? toNumber(match[3], part) : 1;
        if (last < first || step < 1 || (last - first) / step > kMostFrames) failFrames(part);
        for (long frame = first; frame <= last; frame += step)
            frames.insert(static_cast<int>(frame));
    }
    if (frames.empty() || text.ends_with(',')) failFrames(text);
    return {frames.begin(), frames.end()};
}

std::vector<int> chooseFrames(const std::string& text, const std::vector<int>& available)
{
    if (text.empty()) {
        for (std::size_t i = 1; i < available.size(); ++i) {
            if (available[i] == available[i - 1] + 1) continue;
            // A list with gaps is not for every command.
            throw Error(ErrorKind::missingInput,
                        "frame " + std::to_string(available[i - 1] + 1) +
                            " is not there; --frames " +
                            describeFrames({available.begin(), available.begin() + i}) +
                            " asks for those before it");
        }
        return available;
    }
    const std::vector<int> wanted = parseFrames(text);
    for (const int frame : wanted)
        if (!std::binary_search(available.begin(), available.end(), frame))
            throw Error(ErrorKind::missingInput,
                        "frame " + std::to_string(frame) + " is not there; the take has " +
                            (available.empty() ? "none" : describeFrames(available)));
    return wanted;
}

std::vector<int> spreadFrames(const std::vector<int>& frames, int count)
{
    const int total = static_cast<int>(frames.size());
    if (total <= count || count < 2)
        return {frames.begin(), frames.begin() + std::min(total, count)};
    std::vector<int> chosen;
    for (int i = 0; i < count; ++i)
        chosen.push_back(
            frames[(static_cast<std::size_t>(i) * (total - 1) + (count - 1) / 2) / (count - 1)]);
    return chosen;
}

std::array<int, 2> parseSize(const std::string& text)
{
    static const std::regex kSize(R"((\d{1,5})x(\d{1,5}))");
    std::smatch match;
    if (std::regex_match(text, match, kSize)) {
        const std::array<int, 2> size = {std::stoi(match[1]), std::stoi(match[2])};
        if (size[0] >= 1 && size[1] >= 1 && size[0] <= 16384 && size[1] <= 16384) return size;
    }
    throw Error(ErrorKind::usage,
                "\"" + text +
                    "\" is not a picture size; expected WIDTHxHEIGHT, at most 16384 each, "
                    "such as 1280x720");
}

std::string describeFrames(const std::vector<int>& frames)
{
    if (frames.empty()) return "";
    const std::string first = std::to_string(frames.front());
    if (frames.size() == 1) return first;
    const int step = frames[1] - frames[0];
    bool isEven = true;
    for (std::size_t i = 2; i < frames.size(); ++i) isEven &= frames[i] - frames[i - 1] == step;
    if (isEven)
        return first + "-" + std::to_string(frames.back()) +
               (step == 1 ? "" : "x" + std::to_string(step));
    // List the runs.
    std::string text;
    for (std::size_t i = 0; i < frames.size();) {
        std::size_t end = i + 1;
        while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
        if (!text.empty()) text += ",";
        text += std::to_string(frames[i]);
        if (end - i > 1) text += "-" + std::to_string(frames[end - 1]);
        i = end;
    }
    return text;
}

int threadsToUse(std::optional<int> asked)
{
    if (asked && *asked < 1) throw Error(ErrorKind::usage, "--threads must be at least 1");
    if (asked && *asked > kMostThreads)
        throw Error(ErrorKind::usage,
                    "--threads " + std::to_string(*asked) + ": no machine has so many processors");
    if (asked) return *asked;
    if (const auto slurm = positiveNumber(std::getenv("SLURM_CPUS_PER_TASK"))) return *slurm;
    const auto quota = processorQuota("/sys/fs/cgroup", "/proc/self/cgroup");
    return quota ? std::min(*quota, affinityCount()) : affinityCount();
}

std::optional<int> processorQuota(const std::filesystem::path& cgroupRoot,
                                  const std::filesystem::path& cgroupOfProcess)
{
    // Every group above ours limits us too. Lines read "0::/a/b" (version 2) or
    // "4:cpu,cpuacct:/a/b".
    std::optional<double> least;
    std::ifstream file(cgroupOfProcess);
    for (std::string line; std::getline(file, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        if (!controllers.empty() && ("," + controllers + ",").find(",cpu,") == std::string::npos)
            continue;
        const std::filesystem::path root = controllers.empty() ? cgroupRoot : cgroupRoot / "cpu";
        std::filesystem::path group = line.substr(std::min(second + 2, line.size()));
        for (bool isRoot = false; !isRoot; group = group.parent_path()) {
            isRoot = group.empty();
            if (const auto quota = quotaOfGroup(root / group))
                least = least ? std::min(*least, *quota) : *quota;
        }
    }
    if (!least) return std::nullopt;
    return std::max(static_cast<int>(std::ceil(*least)), 1);
}

void addOverrides(CLI::App& command, std::vector<std::string>& overrides)
{
    command.add_option("--set", overrides, "KEY=VALUE: override a key of the shot")
        ->type_name("KEY=VALUE")
        ->expected(1)
        ->take_all();
}

void addProgress(CLI::App& command, std::string& word)
{
    command.add_option("--progress", word, "auto, tty, alf, json or none");
}

void addNoCache(CLI::App& command, bool& noCache)
{
    command.add_flag("--no-cache", noCache,
                     "Make every distance field and repaired solid anew and keep none: else they "
                     "stay in ~/.cache/scree, up to 4 GiB of what was used last");
}

void addImportLimits(CLI::App& command, ImportLimits& limits)
{
    for (const LimitFlag& limit : kLimitFlags) {
        std::uint32_t& value = limits.*limit.value;
        command
            .add_option(limit.flag, value,
                        std::string(limit.help) + " [" + std::to_string(value) + "]")
            ->check(CLI::Range(1u, 1'000'000'000u))
            ->group("What an asset may hold");
    }
}

std::vector<std::pair<std::string, std::string>> changedLimits(const ImportLimits& limits)
{
    std::vector<std::pair<std::string, std::string>> changed;
    for (const LimitFlag& limit : kLimitFlags) {
        const std::uint32_t value = limits.*limit.value;
        if (value != ImportLimits().*limit.value)
            changed.emplace_back(limit.flag, std::to_string(value));
    }
    return changed;
}

std::vector<std::string> wordsOfRun(const std::vector<std::string>& overrides,
                                    const ImportLimits& limits, std::optional<int> threads,
                                    bool noCache)
{
    std::vector<std::string> words;
    for (const std::string& text : overrides) words.insert(words.end(), {"--set", text});
    for (const auto& [flag, value] : changedLimits(limits))
        words.insert(words.end(), {flag, value});
    if (threads) words.insert(words.end(), {"--threads", std::to_string(*threads)});
    if (noCache) words.push_back("--no-cache");
    return words;
}

std::string complaintIfNotFinite(const std::string& text)
{
    // What is no number at all is complained of where it is converted.
    return std::isfinite(std::strtod(text.c_str(), nullptr)) ? "" : "'" + text + "' is not finite";
}

std::function<std::string(const std::string&)> oneOf(const std::vector<std::string>& words)
{
    return [words](const std::string& text) -> std::string {
        if (std::find(words.begin(), words.end(), text) != words.end()) return "";
        return "'" + text + "' is none of " + joined(words) + didYouMean(text, words);
    };
}

void requirePageName(const std::string& name)
{
    const std::string ending = endingOf(name);
    if (ending.empty() || ending == "html" || ending == "htm") return;
    throw Error(ErrorKind::usage,
                "\"" + name + "\": the page is HTML; expected a name ending in .html");
}

void requirePngName(const std::string& name)
{
    if (endingOf(name) == "png") return;
    throw Error(
        ErrorKind::usage,
        "\"" + name + "\": pictures are written as PNG; expected a name " + "ending in .png");
}

std::string describeDuration(double seconds)
{
    char text[64];
    if (seconds < 60.0) {
        std::snprintf(text, sizeof text, seconds < 9.95 ? "%.1f s" : "%.0f s", seconds);
    } else {
        const long whole = std::lround(seconds);
        if (whole < 3600)
            std::snprintf(text, sizeof text, "%ld min %02ld s", whole / 60, whole % 60);
        else
            std::snprintf(text, sizeof text, "%ld h %02ld min", whole / 3600, whole % 3600 / 60);
    }
    return text;
}

}  // namespace scree
