#include "io/shot_parser.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <tuple>

// The library asserts what a text like "[.a]" breaks, and reports it properly right after.
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>

#include "io/file_bytes.h"
#include "io/nearest_word.h"
#include "io/problem_list.h"
#include "io/shot_check.h"
#include "io/shot_extends.h"
#include "io/shot_interpreter.h"
#include "io/shot_schema.h"
#include "io/shot_tree.h"

namespace scree {
namespace {

SourceLocation placeOf(const toml::source_region& source, const std::string& file)
{
    return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

/// The library sorts tables by key; ours are in the order of the text.
void sortByPlace(std::vector<ShotEntry>& entries)
{
    const auto place = [](const ShotEntry& entry) {
        return std::make_tuple(entry.where.line, entry.where.column);
    };
    std::stable_sort(entries.begin(), entries.end(),
                     [&](const ShotEntry& a, const ShotEntry& b) { return place(a) < place(b); });
}

ShotNode toShotNode(const toml::node& source, const std::string& file)
{
    using Kind = ShotNode::Kind;
    ShotNode node;
    node.where = placeOf(source.source(), file);
    if (const toml::table* table = source.as_table()) {
        node.kind = Kind::table;
        for (auto&& [key, value] : *table) {
            node.entries.push_back(
                {std::string(key.str()), placeOf(key.source(), file), toShotNode(value, file)});
        }
        sortByPlace(node.entries);
    } else if (const toml::array* list = source.as_array()) {
        node.kind = Kind::list;
        for (const toml::node& item : *list) node.items.push_back(toShotNode(item, file));
    } else if (const auto* boolean = source.as_boolean()) {
        node.kind = Kind::boolean;
        node.boolean = boolean->get();
    } else if (const auto* integer = source.as_integer()) {
        node.kind = Kind::integer;
        node.integer = integer->get();
    } else if (const auto* number = source.as_floating_point()) {
        node.kind = Kind::number;
        node.number = number->get();
    } else if (const auto* text = source.as_string()) {
        node.kind = Kind::text;
        node.text = text->get();
    } else {
        node.kind = Kind::date;
    }
    return node;
}

/// Throws toml::parse_error.
ShotNode readToml(const std::string& text, const std::string& file)
{
    return toShotNode(toml::parse(std::string_view(text), std::string_view(file)), file);
}

void placeEverythingAt(const SourceLocation& where, ShotNode& node)
{
    node.where = where;
    for (ShotNode& item : node.items) placeEverythingAt(where, item);
    for (ShotEntry& entry : node.entries) {
        entry.where = where;
        placeEverythingAt(where, entry.node);
    }
}

/// One TOML value, everything in it placed at `where`. Throws toml::parse_error, also when the text
/// holds more than one value.
ShotNode readTomlValue(const std::string& text, const SourceLocation& where)
{
    ShotNode table = readToml("value = " + text, where.file);
    if (table.entries.size() != 1) {
        throw toml::parse_error("one value expected", toml::source_region{});
    }
    ShotNode node = std::move(table.entries.front().node);
    placeEverythingAt(where, node);
    return node;
}

/// Puts the value of one --set into the tree.
class Override {
public:
    Override(const std::string& text, ProblemList& problems)
        : text_(text), place_{"--set " + text, 0, 0}, problems_(problems)
    {
    }

    void apply(ShotNode& tree)
    {
        const std::size_t equals = text_.find('=');
        if (equals == std::string::npos) {
            return report("expected KEY=VALUE, for example solver.contact_iterations=20");
        }
        splitPath(trimmed(text_.substr(0, equals)));
        if (words_.front() == "extends") {
            return report("'extends' cannot be set: what a shot stands on is read before");
        }
        const std::string value = trimmed(text_.substr(equals + 1));

        ShotNode* table = &tree;
        std::string path;
        while (words_.size() > 1 && table) table = enter(*table, path);
        if (!table) return;
        const ShotKey* key = findKey(path, words_.front());
        if (!key) return;
        const bool isWholeList = key->type == KeyType::tableList && !path.empty();
        if (key->type == KeyType::namedTables ||
            (key->type == KeyType::tableList && !isWholeList)) {
            return report("'" + words_.front() + "' is followed by a name and a key: " +
                          words_.front() + ".NAME.KEY=VALUE");
        }
        setValue(*table, *key, value);
    }

private:
    static std::string trimmed(const std::string& text)
    {
        const std::size_t first = text.find_first_not_of(" \t");
        if (first == std::string::npos) return "";
        return text.substr(first, text.find_last_not_of(" \t") - first + 1);
    }

    void splitPath(const std::string& path)
    {
        std::istringstream stream(path);
        for (std::string word; std::getline(stream, word, '.');) words_.push_back(trimmed(word));
        if (words_.empty()) words_.emplace_back();
    }

    std::string takeWord()
    {
        const std::string word = words_.front();
        words_.erase(words_.begin());
        return word;
    }

    /// The table that the next words of the path lead to, created when only the schema knows it;
    /// null and a report when there is none.
    ShotNode* enter(ShotNode& table, std::string& path)
    {
        const std::string word = takeWord();
        const ShotKey* key = findKey(path, word);
        if (!key) return nullptr;
        path = key->path;
        if (key->type == KeyType::namedTables || key->type == KeyType::tableList) {
            return enterNamed(table, *key);
        }
        if (key->type != KeyType::table) {
            report("'" + word + "' has no keys of its own");
            return nullptr;
        }
        ShotEntry* entry = table.entry(word);
        if (!entry) {
            entry = &table.entries.emplace_back(ShotEntry{word, place_, {}});
            entry->node.where = place_;
        }
        if (entry->node.kind == ShotNode::Kind::table) return &entry->node;
        report("'" + word + "' is not a table in the shot");
        return nullptr;
    }

    /// [material.NAME] by key, [[body]] by its name, what has none by its number from 0.
    ShotNode* enterNamed(ShotNode& table, const ShotKey& key)
    {
        const std::string wanted = takeWord();
        if (words_.empty()) {
            report("'" + wanted + "' is a whole [" + key.path +
                   "]; name one of its keys: " + joined(namesInside(key.path)));
            return nullptr;
        }
        std::vector<std::string> names;
        ShotEntry* list = table.entry(nameOf(key));
        if (list) {
            for (ShotEntry& entry : list->node.entries) {
                if (entry.key == wanted && entry.node.kind == ShotNode::Kind::table) {
                    return &entry.node;
                }
                names.push_back(entry.key);
            }
            for (ShotNode& item : list->node.items) {
                const ShotNode* name = item.find("name");
                std::string itemName = name ? name->text : nameByDefault(key.path);
                if (itemName.empty()) itemName = std::to_string(names.size());
                if (itemName == wanted) return &item;
                names.push_back(itemName);
            }
        }
        report("no " + std::string(key.path) + " '" + wanted + "' in the shot" +
               didYouMean(wanted, names) +
               (names.empty() ? "" : " (known: " + joined(names) + ")"));
        return nullptr;
    }

    const ShotKey* findKey(const std::string& path, const std::string& word)
    {
        const ShotKey* key = findShotKey(joinPath(path, word));
        if (key) return key;
        const std::vector<std::string> names = namesInside(path);
        report("unknown key '" + word + "'" + (path.empty() ? "" : " in '" + path + "'") +
               didYouMean(word, names) + " (valid: " + joined(names) + ")");
        return nullptr;
    }

    void setValue(ShotNode& table, const ShotKey& key, const std::string& value)
    {
        // A shell eats quotes, so text may come without them; 1001-1240 is no TOML value at all.
        const bool isText = key.type == KeyType::text || key.type == KeyType::word;
        const bool isQuoted = value.starts_with('"') || value.starts_with('\'');
        ShotNode node;
        try {
            const std::string quoted = toTomlText(std::string_view(value));
            node = readTomlValue(isText && !isQuoted ? quoted : value, place_);
        } catch (const toml::parse_error&) {
            return report("'" + std::string(key.path) + "' must be " + expectationOf(key) +
                          ", not " + (value.empty() ? "nothing" : value));
        }
        const std::string name(nameOf(key));
        ShotEntry* entry = table.entry(name);
        if (!entry) entry = &table.entries.emplace_back(ShotEntry{name, place_, {}});
        entry->node = std::move(node);
    }

    void report(const std::string& message) { problems_.add(place_, message); }

    std::string text_;
    SourceLocation place_;
    ProblemList& problems_;
    std::vector<std::string> words_;  // of the path, those not yet followed
};

/// Throws when no file can be read there; `where` is the place that names it, if there is one.
void requireShotFile(const std::string& path, const SourceLocation& where = {})
{
    const auto refuse = [&](ErrorKind kind, const std::string& why) {
        const std::string message = "shot file '" + path + "' " + why;
        throw where.file.empty() ? Error(kind, message) : Error(kind, where, message);
    };
    const std::string obstacle = obstacleTo(path);
    if (!obstacle.empty()) refuse(ErrorKind::missingInput, "cannot be reached: " + obstacle);
    if (!std::filesystem::exists(path)) refuse(ErrorKind::missingInput, "does not exist");
    if (std::filesystem::is_directory(path)) {
        // As a base it is what a shot says, and says wrongly.
        refuse(where.file.empty() ? ErrorKind::missingInput : ErrorKind::badInput,
               "is a folder without a shot.toml: name the .toml file in it");
    }
}

std::string readWholeFile(const std::string& path)
{
    requireShotFile(path);
    return readFileBytes(path);
}

/// A shot may be a folder of its own, with its assets beside its shot.toml.
std::string shotFileOf(const std::string& path)
{
    std::error_code ignored;
    const std::filesystem::path inside = std::filesystem::path(path) / "shot.toml";
    return std::filesystem::exists(inside, ignored) ? inside.string() : path;
}

/// What the parser's own words do not tell those who meet TOML for the first time.
std::string adviceFor(std::string_view description)
{
    const auto tells = [&](const char* words) {
        return description.find(words) != std::string_view::npos;
    };
    if (tells("could not determine value type")) {
        return "; a text stands in straight quotes, \"wood\", a list in square brackets, [0, 1, 0]";
    }
    if (tells("invalid utf-8")) return "; a shot is a text file in UTF-8";
    return "";
}

ShotNode readTree(const std::string& text, const std::string& path)
{
    try {
        return readToml(text, path);
    } catch (const toml::parse_error& error) {
        throw Error(ErrorKind::badInput, placeOf(error.source(), path),
                    std::string(error.description()) + adviceFor(error.description()));
    }
}

/// Follows `extends` down to a shot that stands on nothing. `above` are the files on the way here.
ShotNode withBase(ShotNode tree, const std::string& path, std::vector<std::string> above)
{
    const ShotEntry* extends = tree.entry("extends");
    if (!extends || extends->node.kind != ShotNode::Kind::text) return tree;
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    const std::filesystem::path named = extends->node.text;
    const std::string asNamed = (folder / named).lexically_normal().string();
    const std::string base = shotFileOf(asNamed);
    above.push_back(std::filesystem::path(path).lexically_normal().string());
    if (std::find(above.begin(), above.end(), base) != above.end()) {
        throw Error(ErrorKind::badInput, extends->node.where,
                    "'extends' goes round in a circle: \"" + base + "\" extends this shot");
    }
    requireShotFile(base, extends->node.where);
    std::erase_if(tree.entries, [](const ShotEntry& entry) { return entry.key == "extends"; });
    ShotNode below = withBase(readTree(readWholeFile(base), base), base, above);
    rebaseFiles(below, base == asNamed ? named.parent_path() : named);
    return laidOver(std::move(below), tree);
}

}  // namespace

Shot parseShot(const std::string& path, const std::vector<std::string>& overrides,
               const ImportLimits& limits)
{
    const std::string file = shotFileOf(path);
    return parseShotText(readWholeFile(file), file, overrides, limits);
}

Shot parseShotText(const std::string& text, const std::string& path,
                   const std::vector<std::string>& overrides, const ImportLimits& limits)
{
    ShotNode tree = withBase(readTree(text, path), path, {});

    ProblemList problems(path);
    for (const std::string& setting : overrides) Override(setting, problems).apply(tree);
    checkShotTree(tree, problems);
    completeShotTree(tree, &readTomlValue);
    Shot shot = interpretShot(tree, path, limits, problems);
    problems.throwIfAny();
    shot.warnings = problems.warnings();
    shot.resolvedText = printShotTree(tree);
    return shot;
}

}  // namespace scree
