// Programs of others that read our exports (tests/support/reader_env.sh).
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <string_view>

#include "tests/support/support.h"

namespace scree::test {

struct CommandResult {
    int exitCode = -1;
    std::string output;  ///< stdout and stderr
};

inline CommandResult runCommand(const std::string& command)
{
    CommandResult result;
    std::FILE* pipe = popen(("( " + command + " ) 2>&1").c_str(), "r");
    if (pipe == nullptr) return result;
    std::array<char, 4096> piece;
    while (const std::size_t count = std::fread(piece.data(), 1, piece.size(), pipe)) {
        result.output.append(piece.data(), count);
    }
    const int status = pclose(pipe);
    result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return result;
}

inline std::string quoted(const std::filesystem::path& path)
{
    return "'" + path.string() + "'";
}

/// A reader that can be run, or why it cannot.
struct Reader {
    std::string command;  ///< what reader_env.sh prints; empty when it is missing
    std::string reason;
};

/// `name` as reader_env.sh knows it. Looked for once a process.
inline const Reader& findReader(const std::string& name)
{
    static std::map<std::string, Reader> known;
    const auto [entry, isNew] = known.emplace(name, Reader{});
    if (!isNew) return entry->second;

    const CommandResult result =
        runCommand(quoted(sourceFile("tests/support/reader_env.sh")) + " " + name);
    std::string_view lines = result.output;
    while (lines.ends_with('\n')) lines.remove_suffix(1);
    if (result.exitCode == 0) {
        entry->second.command = lines.substr(lines.rfind('\n') + 1);
    } else {
        entry->second.reason = lines;
    }
    return entry->second;
}

/// A missing reader must not pass for a test: continuous integration (CI=true) calls it a failure.
inline bool mayBeSkipped()
{
    const char* ci = std::getenv("CI");
    return ci == nullptr || std::string_view(ci) != "true";
}

}  // namespace scree::test

/// Ends the test, loudly, when `condition` does not hold: a reader is missing.
#define SCREE_REQUIRE_READER(condition, reason)                                       \
    do {                                                                              \
        if (condition) break;                                                         \
        if (!::scree::test::mayBeSkipped()) FAIL() << "reader missing: " << (reason); \
        std::fprintf(stderr, "\n*** NOT TESTED, a reader is missing: %s\n\n",         \
                     std::string(reason).c_str());                                    \
        GTEST_SKIP() << "reader missing: " << (reason);                               \
    } while (false)
