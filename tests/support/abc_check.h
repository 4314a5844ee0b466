// Runs abc_check.py, the independent validator and reader of Alembic files.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include "tests/support/support.h"

namespace scree::test {

struct CheckResult {
    int exitCode = -1;
    std::string output;  ///< stdout and stderr
};

/// `options` as on its command line, for instance "--strict" or "--dump-xforms --world".
inline CheckResult runAbcCheck(const std::filesystem::path& file, const std::string& options)
{
    const std::string command = "python3 '" + sourceFile("tests/support/abc_check.py").string() +
                                "' '" + file.string() + "' " + options + " 2>&1";
    CheckResult result;
    std::FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return result;
    std::array<char, 4096> piece;
    while (const std::size_t count = std::fread(piece.data(), 1, piece.size(), pipe)) {
        result.output.append(piece.data(), count);
    }
    const int status = pclose(pipe);
    result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return result;
}

}  // namespace scree::test
