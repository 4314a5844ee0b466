// A long chain of bodies that lean on each other gains no energy from nowhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "io/file_bytes.h"
#include "tests/support/readers.h"
#include "tests/support/support.h"

namespace scree::test {
namespace {

double numberAfter(const std::string& line, const std::string& key)
{
    const std::size_t at = line.find("\"" + key + "\":");
    EXPECT_NE(at, std::string::npos) << key;
    return at == std::string::npos ? 0.0 : std::stod(line.substr(at + key.size() + 3));
}

/// Fallen dominoes wedge each other; shock propagation once threw one of them with more energy than
/// all of them had.
TEST(ShotEnergy, ASpiralOfFallenDominoesStaysDown)
{
    const TemporaryFolder folder;
    const CommandResult made = runCommand(std::string(SCREE_PROGRAM) + " -q sim " +
                                          quoted(sourceFile("shots/domino_spiral.toml")) + " -o " +
                                          quoted(folder / "take"));
    ASSERT_EQ(made.exitCode, 0) << made.output;
    std::istringstream lines(readFileBytes(folder / "take" / "stats.jsonl"));
    double first = 0.0, last = 0.0, largestRise = 0.0;
    int frames = 0;
    for (std::string line; std::getline(lines, line);) {
        if (line.find("\"potential_energy_J\"") == std::string::npos) continue;
        const double energy =
            numberAfter(line, "kinetic_energy_J") + numberAfter(line, "potential_energy_J");
        // The first frame is the start, of which nothing is told.
        if (++frames == 2) first = energy;
        if (frames > 2) largestRise = std::max(largestRise, energy - last);
        last = energy;
    }
    EXPECT_GE(frames, 160);
    EXPECT_LE(last, 0.6 * first);  // they have fallen
    EXPECT_LE(largestRise, 0.01 * first);
}

}  // namespace
}  // namespace scree::test
