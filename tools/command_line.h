// What several commands understand in the same way: frame lists, sizes, how many threads.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/import_limits.h"

namespace CLI {
class App;
}

namespace scree {

/// Frames in ascending order, each once: "1001-1240", "1-100x5" (every fifth), "1001", and lists of
/// these with commas. Throws Error{usage}.
std::vector<int> parseFrames(const std::string& text);

/// Those of `available` (ascending) that `text` asks for; all for an empty text. Throws
/// Error{usage} for a bad text and Error{missingInput} when a frame that was asked for, or one
/// between those that are there, is not available.
std::vector<int> chooseFrames(const std::string& text, const std::vector<int>& available);

/// At most `count` of the frames, evenly spread, first and last among them.
std::vector<int> spreadFrames(const std::vector<int>& frames, int count);

/// "1280x720". Throws Error{usage}.
std::array<int, 2> parseSize(const std::string& text);

/// "1001-1240" or "1001-1101x10", or a list: parseFrames gives the frames back.
std::string describeFrames(const std::vector<int>& frames);

/// What was asked for, else SLURM_CPUS_PER_TASK, else as many processors as the affinity mask and
/// the quota of the control group allow. Throws Error{usage} for a number below 1.
int threadsToUse(std::optional<int> asked);

/// Processors' worth of time that the control group of this process allows, rounded up; nothing
/// when there is no limit. `cgroupRoot` is /sys/fs/cgroup but for tests.
std::optional<int> processorQuota(const std::filesystem::path& cgroupRoot,
                                  const std::filesystem::path& cgroupOfProcess);

/// Adds --set, which may stand many times. `overrides` must outlive the command.
void addOverrides(CLI::App& command, std::vector<std::string>& overrides);

/// Adds --no-cache. `noCache` must outlive the command.
void addNoCache(CLI::App& command, bool& noCache);

/// Adds --progress. `word`, for parseProgressMode, must outlive the command.
void addProgress(CLI::App& command, std::string& word);

/// Adds the flags that change what an asset may hold: --import-points and the like. `limits` must
/// outlive the command.
void addImportLimits(CLI::App& command, ImportLimits& limits);

/// Those flags and their values that are not the defaults.
std::vector<std::pair<std::string, std::string>> changedLimits(const ImportLimits& limits);

/// The options of those kinds that were given, as words of a command that is to do the same again.
std::vector<std::string> wordsOfRun(const std::vector<std::string>& overrides,
                                    const ImportLimits& limits, std::optional<int> threads,
                                    bool noCache);

/// For CLI11's check of an option: a complaint when the number is none, or without end. The ranges
/// of the library let "nan" pass, and "inf" where they have no upper end.
std::string complaintIfNotFinite(const std::string& text);

/// For CLI11's check of an option: a complaint, with the nearest of `words`, when the text is none
/// of them.
std::function<std::string(const std::string&)> oneOf(const std::vector<std::string>& words);

/// Throws Error{usage} when the name of a picture does not end in .png, the format they are written
/// in.
void requirePngName(const std::string& name);

/// Throws Error{usage} when the name of a page for a browser has an ending that says otherwise.
void requirePageName(const std::string& name);

/// Seconds as a person says them: "8.2 s", "3 min 05 s", "2 h 10 min".
std::string describeDuration(double seconds);

}  // namespace scree
