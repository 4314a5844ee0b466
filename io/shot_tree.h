// What a shot file says before anybody asks what it means: a tree of values, each with its place in
// the text. The TOML library stays behind it, and files, overrides and defaults become the same
// thing.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"

namespace scree {

struct ShotEntry;

/// One value. Plain fields instead of a variant: the tree is small and read once, and code that
/// walks it stays readable.
struct ShotNode {
    enum class Kind { boolean, integer, number, text, date, list, table };

    Kind kind = Kind::table;
    bool boolean = false;
    std::int64_t integer = 0;
    double number = 0.0;
    std::string text;
    std::vector<ShotNode> items;     // of a list
    std::vector<ShotEntry> entries;  // of a table, in the order of the file
    SourceLocation where;

    /// The value of an integer or number.
    double asNumber() const;
    bool isNumeric() const { return kind == Kind::integer || kind == Kind::number; }

    /// The usable value of a key; null when it is absent or was found wrong.
    const ShotNode* find(std::string_view key) const;

    /// The entry of a key, wrong or right; null when absent.
    const ShotEntry* entry(std::string_view key) const;
    ShotEntry* entry(std::string_view key);

    /// Whether there is an entry of the key, or one that was taken for a slip of it: what has been
    /// reported as misspelt is not missing besides.
    bool mentions(std::string_view key) const;

    /// Whether what the text says of the key has been reported as wrong, or as a slip of it. What
    /// follows from the default in its place is nobody's mistake.
    bool isUnclear(std::string_view key) const;
};

struct ShotEntry {
    std::string key;
    SourceLocation where;  ///< of the key
    ShotNode node{};
    bool isValid = true;  ///< cleared when the value was reported as wrong, so that it is not twice
    bool isStandIn = false;  ///< a default in the place of a value that was reported as wrong
    std::string meant{};     ///< of a key that was reported as unknown: which it may be a slip of
};

/// Shortest decimal text that reads back to the same double, always with a point or an exponent.
std::string toTomlText(double number);

/// Text in quotes, escaped.
std::string toTomlText(std::string_view text);

/// A value on one line; tables inline.
std::string toTomlText(const ShotNode& node);

}  // namespace scree
