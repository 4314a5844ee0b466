#include "io/shot_reference.h"

#include <string_view>

#include "io/nearest_word.h"
#include "io/shot_schema.h"

namespace scree {
namespace {

constexpr const char* kOpening =
    "# The keys of a shot file\n\n"
    "Made by `scree explain --all` from the table that checks shot files; a test compares the two. "
    "`scree explain KEY` prints one entry.\n"
    "Shots are TOML 1.0. Lengths are in the shot's own unit, angles in degrees.\n";

std::string headingOf(const ShotKey& table)
{
    const std::string path = table.path;
    if (table.type == KeyType::namedTables) return "[" + path + ".NAME]";
    if (table.type == KeyType::tableList) return "[[" + path + "]]";
    return "[" + path + "]";
}

std::string entryOf(const ShotKey& key)
{
    std::string text = "- **`" + std::string(key.path) + "`**: " + expectationOf(key);
    if (*key.unit && std::string_view(key.unit) != "-") text += " [" + std::string(key.unit) + "]";
    if (key.isRequired) text += "; required";
    const bool isTable = key.type == KeyType::table;
    if (*key.byDefault && !isTable) text += "; default `" + std::string(key.byDefault) + "`";
    text += ".\n  " + std::string(key.help) + "\n";
    if (*key.method) text += "  Method \"" + std::string(key.method) + "\" only.\n";
    if (*key.excludes) {
        text += "  Not together with " + joined(splitWords(key.excludes)) + ".\n";
    }
    return text;
}

/// A table inside a table follows its own entry.
void appendKeys(const std::string& path, std::string& text)
{
    for (const ShotKey* key : keysInside(path)) {
        text += entryOf(*key);
        appendKeys(key->path, text);
    }
}

}  // namespace

std::string shotReference()
{
    std::string text = kOpening;
    text += "\n## At the top of the file\n\n";
    for (const ShotKey* key : keysInside("")) {
        if (keysInside(key->path).empty()) text += entryOf(*key);
    }
    for (const ShotKey* key : keysInside("")) {
        if (keysInside(key->path).empty()) continue;
        text += "\n## " + headingOf(*key) + "\n\n" + std::string(key->help) + "\n\n";
        appendKeys(key->path, text);
    }
    return text;
}

}  // namespace scree
