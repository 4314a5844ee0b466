// The text of small shots: blocks of wood on a ground, and what a test adds to them.
#pragma once

#include <string>

#include "core/base/error.h"
#include "io/shot_parser.h"
#include "tests/support/refusal.h"

namespace scree::test {

/// What tests vary of a shot; further keys are lines of TOML.
struct SmallShot {
    std::string name = "s", frames = "1001-1006";
    std::string shotKeys = "", woodKeys = "";
    std::string box = "[1, 1, 1]";  ///< size of [shape.block]
};

/// The shot with its material `wood`, shape `block` and a ground at height 0, then `more`.
inline std::string shotTextOf(const SmallShot& shot, const std::string& more)
{
    return "scree = 1\n[shot]\nname = \"" + shot.name + "\"\nframes = \"" + shot.frames + "\"\n" +
           shot.shotKeys + "\n[material.wood]\ndensity = 650\n" + shot.woodKeys +
           "\n[shape.block]\nbox = { size = " + shot.box +
           " }\n[[body]]\nname = \"ground\"\nplane = { point = [0, 0, 0], normal = [0, 1, 0] }\n"
           "material = \"wood\"\nmotion = \"static\"\n" +
           more;
}

/// A body of wood; `more` places it.
inline std::string bodyText(const std::string& name, const std::string& more,
                            const std::string& shape = "block")
{
    return "[[body]]\nname = \"" + name + "\"\nshape = \"" + shape + "\"\nmaterial = \"wood\"\n" +
           more + "\n";
}

/// What the parser says against a shot called s.toml.
inline std::string messageOfShot(const std::string& text)
{
    return refusalBy([&] { parseShotText(text, "s.toml"); }).message;
}

}  // namespace scree::test
