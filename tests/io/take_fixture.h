// A small take for the tests of what is kept of a run.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "core/diagnostics/state_hash.h"
#include "io/build_world.h"
#include "io/file_bytes.h"
#include "io/shot_parser.h"
#include "io/take.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"

namespace scree::test {

/// A block above the ground and a camera; the ground is body 0.
inline std::string shotText()
{
    const SmallShot shot{
        .name = "two", .frames = "1001-1005", .shotKeys = "units = \"cm\"", .box = "[10, 20, 30]"};
    const std::string block = bodyText("block",
                                       "position = [100, 40, 0]\n"
                                       "rotation = [10, 20, 30]\n"
                                       "velocity = [50, 0, 0]");
    return shotTextOf(shot, block +
                                "[[camera]]\nname = \"main\"\neye = [300, 200, 100]\n"
                                "target = [0, 10, 0]\n");
}

/// A shot, its world, and a stand-in for simulation that is quick and reaches every value.
class TakeFixture : public testing::Test {
protected:
    TakeFixture() : shot(parseShotText(shotText(), "two.toml")), world(buildWorld(shot)) {}

    void advance(World& moved) const
    {
        ++moved.clock.frame;
        moved.motion[1].position.x() += 1.0 / 3.0;
        moved.motion[1].angularMomentum.z() -= 0.1;
        std::swap(moved.order[0], moved.order[1]);
    }

    FrameStats statsOf(const World& moved) const
    {
        FrameStats stats;
        stats.frame = shot.firstFrame + static_cast<int>(moved.clock.frame);
        stats.report.stateHash = stateHash(moved);
        return stats;
    }

    TakeWriter open(ExistingTake existing, const Shot& used)
    {
        return TakeWriter(folder / "take", used, world, "1.2.3", existing);
    }

    /// All five frames.
    void writeWholeTake()
    {
        TakeWriter take = open(ExistingTake::refuse, shot);
        World moved = world;
        take.writeFrame(moved, statsOf(moved));
        for (int i = 0; i < 4; ++i) {
            advance(moved);
            take.writeFrame(moved, statsOf(moved));
        }
    }

    TemporaryFolder folder;
    Shot shot;
    World world;
};

inline void flipByte(const std::filesystem::path& path, std::size_t offset)
{
    std::string bytes = readFileBytes(path);
    bytes[offset] ^= 1;
    std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace scree::test
