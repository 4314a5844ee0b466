// The one table of everything a shot file may say: type, range, default and meaning of every key.
// The checks, the defaults, the resolved shot and `scree explain` are all made from it.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

enum class KeyType {
    boolean,
    integer,
    number,
    text,
    word,          ///< one of `choices`
    integers,      ///< a list of exactly `count`
    numbers,       ///< a list of exactly `count`
    numberOrList,  ///< one number, or a list of exactly `count`
    numberOrWord,  ///< one number, or one of `choices`
    textOrTexts,   ///< one text, or a list of any length but zero
    words,         ///< a list of any length, each one of `choices` if there are any
    table,
    namedTables,  ///< [material.NAME]: a table for each name
    tableList,    ///< [[body]]
};

/// One key. Keys inside named tables and lists of tables leave the name out: "material.friction".
/// A plain struct with designated initialisers makes the table below readable as documentation,
/// which is what it is.
struct ShotKey {
    const char* path;
    KeyType type = KeyType::number;
    int count = 3;  ///< of integers and numbers; 0: as many as one likes
    const char* unit = "-";
    const char* byDefault = "";  ///< as TOML; empty: none
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool isOpen = false;       ///< the limits themselves are not allowed
    const char* choices = "";  ///< of words, "a|b|c"
    bool isFile = false;       ///< text that names a file relative to the shot
    bool isRequired = false;
    const char* excludes = "";  ///< keys of the same table that cannot stand beside it, "a|b|c"
    const char* method = "";    ///< the one solver.method that reads it; empty: all do
    const char* help = "";      ///< what it means, what goes wrong at the extremes
};

/// All keys, tables before what they contain, in the order in which a resolved shot is written.
const std::vector<ShotKey>& shotKeys();

/// Null when the format has no such key. `path` as in ShotKey; "" is the file itself.
const ShotKey* findShotKey(std::string_view path);

/// The keys directly inside a table, in order; "" for the file itself.
std::vector<const ShotKey*> keysInside(std::string_view path);

/// Names, without their table, of the keys inside.
std::vector<std::string> namesInside(std::string_view path);

/// The last word of a path.
std::string_view nameOf(const ShotKey& key);

/// What an item of a list of tables is called that has no name of its own; empty: nothing.
std::string nameByDefault(std::string_view list);

/// "a|b|c" → a, b, c.
std::vector<std::string> splitWords(std::string_view words);

/// The path of a key inside a table; "" is the file itself.
std::string joinPath(std::string_view table, std::string_view name);

/// What a value of this key must be: "a whole number from 0 to 1000".
std::string expectationOf(const ShotKey& key);

/// What a key of the shot file means, as `scree explain` prints it: unit, default, range, text; for
/// a table also its keys. `path` may leave out the table when the name alone is unambiguous, and
/// may contain the name of a material, shape, body or camera. Throws Error{usage} with the nearest
/// key.
std::string explainKey(const std::string& path);

}  // namespace scree
