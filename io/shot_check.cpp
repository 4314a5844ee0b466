#include "io/shot_check.h"

#include <algorithm>
#include <cmath>

#include "io/nearest_word.h"
#include "io/text_forms.h"
#include "io/unique_names.h"

namespace scree {
namespace {

using Kind = ShotNode::Kind;

constexpr const char* kFileLabel = "the shot";

/// A value as quoted in messages: short, whatever it is.
std::string quoted(const ShotNode& node)
{
    constexpr std::size_t kLongest = 48;
    if (node.kind == Kind::table) return "a table";
    if (node.kind == Kind::date) return "a date";
    return shortened(toTomlText(node), kLongest);
}

bool isInRange(const ShotKey& key, double value)
{
    if (!std::isfinite(value)) return false;
    return key.isOpen ? value > key.min && value < key.max : value >= key.min && value <= key.max;
}

bool contains(const std::vector<std::string>& words, const std::string& word)
{
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// Walks tree and schema together.
class Checker {
public:
    explicit Checker(ProblemList& problems) : problems_(problems) {}

    /// `label` is what messages call the table: "[material.wood]".
    void checkTable(ShotNode& table, const std::string& path, const std::string& label)
    {
        for (ShotEntry& entry : table.entries) {
            entry.isValid = checkEntry(entry, path, label);
        }
        for (const ShotKey* key : keysInside(path)) {
            if (key->isRequired && !table.mentions(nameOf(*key))) {
                problems_.add(table.where, label + " lacks '" + std::string(nameOf(*key)) +
                                               "': " + expectationOf(*key));
            }
        }
        checkExclusions(table, path, label);
    }

private:
    bool checkEntry(ShotEntry& entry, const std::string& path, const std::string& label)
    {
        const ShotKey* key = findShotKey(joinPath(path, entry.key));
        // A dot inside a quoted key must not reach into another table of the schema.
        if (!key || entry.key.find('.') != std::string::npos) {
            const std::vector<std::string> names = namesInside(path);
            problems_.add(entry.where, "unknown key '" + entry.key + "' in " + label +
                                           didYouMean(entry.key, names) +
                                           " (valid: " + joined(names) + ")");
            entry.meant = meantWord(entry.key, names);
            return false;
        }
        switch (key->type) {
            case KeyType::table:
                return checkSubTable(entry, *key, label);
            case KeyType::namedTables:
                return checkNamedTables(entry, *key);
            case KeyType::tableList:
                return checkTableList(entry, *key);
            default:
                return checkValue(entry.node, *key);
        }
    }

    bool checkSubTable(ShotEntry& entry, const ShotKey& key, const std::string& label)
    {
        if (entry.node.kind != Kind::table) return refuse(entry.node, key);
        const bool isTopLevel = label == kFileLabel;
        checkTable(entry.node, key.path,
                   isTopLevel ? "[" + entry.key + "]" : label + " " + entry.key);
        return true;
    }

    bool checkNamedTables(ShotEntry& entry, const ShotKey& key)
    {
        if (entry.node.kind != Kind::table) return refuse(entry.node, key);
        for (ShotEntry& named : entry.node.entries) {
            named.isValid = named.node.kind == Kind::table;
            if (!named.isValid) {
                problems_.add(named.where, "'" + entry.key + "' must be " + expectationOf(key) +
                                               "; '" + named.key + "' is no table");
            } else {
                checkName(named.key, named.where);
                checkTable(named.node, key.path, "[" + entry.key + "." + named.key + "]");
            }
        }
        return true;
    }

    bool checkTableList(ShotEntry& entry, const ShotKey& key)
    {
        const bool isList = entry.node.kind == Kind::list;
        if (!isList) return refuse(entry.node, key);
        for (const ShotNode& item : entry.node.items) {
            if (item.kind != Kind::table) return refuse(item, key);
        }
        for (ShotNode& item : entry.node.items) {
            checkTable(item, key.path, "[[" + entry.key + "]]");
            const ShotNode* name = item.find("name");
            if (name) checkName(name->text, name->where);
        }
        return true;
    }

    void checkName(const std::string& name, const SourceLocation& where)
    {
        if (name.size() > kLongestName) {
            problems_.add(where, "a name of " + std::to_string(name.size()) +
                                     " letters is too long for a file: at most " +
                                     std::to_string(kLongestName));
        }
        if (isPlainName(name)) return;
        problems_.add(where, "name " + toTomlText(std::string_view(name)) +
                                 " must be letters, digits and _, not beginning with a digit");
    }

    bool checkValue(ShotNode& node, const ShotKey& key)
    {
        switch (key.type) {
            case KeyType::boolean:
                return node.kind == Kind::boolean || refuse(node, key);
            case KeyType::text:
                return node.kind == Kind::text || refuse(node, key);
            case KeyType::integer:
                return checkInteger(node, key);
            case KeyType::number:
                return checkNumber(node, key);
            case KeyType::numberOrList:
                return node.kind == Kind::list ? checkList(node, key) : checkNumber(node, key);
            case KeyType::numberOrWord:
                return node.kind == Kind::text ? checkWord(node, key) : checkNumber(node, key);
            case KeyType::textOrTexts:
                return checkTexts(node, key);
            case KeyType::word:
                return checkWord(node, key);
            default:
                return checkList(node, key);
        }
    }

    bool checkInteger(const ShotNode& node, const ShotKey& key)
    {
        const bool isRight = node.kind == Kind::integer && isInRange(key, node.asNumber());
        return isRight || refuse(node, key);
    }

    bool checkNumber(ShotNode& node, const ShotKey& key)
    {
        if (!node.isNumeric() || !isInRange(key, node.asNumber())) return refuse(node, key);
        node.number = node.asNumber();
        node.kind = Kind::number;
        return true;
    }

    bool checkList(ShotNode& node, const ShotKey& key)
    {
        if (node.kind != Kind::list) return refuse(node, key);
        const bool hasCount = key.type != KeyType::words && key.count != 0;
        if (hasCount && node.items.size() != static_cast<std::size_t>(key.count)) {
            return refuse(node, key);
        }
        bool isRight = true;
        for (ShotNode& item : node.items) {
            if (key.type == KeyType::integers) {
                isRight = checkInteger(item, key) && isRight;
            } else if (key.type == KeyType::words) {
                isRight = checkWord(item, key) && isRight;
            } else {
                isRight = checkNumber(item, key) && isRight;
            }
        }
        return isRight;
    }

    bool checkTexts(const ShotNode& node, const ShotKey& key)
    {
        const bool isList = node.kind == Kind::list && !node.items.empty();
        const bool areTexts =
            std::all_of(node.items.begin(), node.items.end(),
                        [](const ShotNode& item) { return item.kind == Kind::text; });
        return node.kind == Kind::text || (isList && areTexts) || refuse(node, key);
    }

    bool checkWord(const ShotNode& node, const ShotKey& key)
    {
        const std::vector<std::string> choices = splitWords(key.choices);
        if (node.kind != Kind::text) return refuse(node, key);
        if (choices.empty() || contains(choices, node.text)) return true;
        problems_.add(node.where, "'" + std::string(nameOf(key)) + "' must be " +
                                      expectationOf(key) + ", not " + quoted(node) +
                                      didYouMean(node.text, choices));
        return false;
    }

    void checkExclusions(const ShotNode& table, const std::string& path, const std::string& label)
    {
        // A pair is reported once, at the one that comes later in the text.
        for (std::size_t later = 0; later < table.entries.size(); ++later) {
            for (std::size_t earlier = 0; earlier < later; ++earlier) {
                const std::string& a = table.entries[earlier].key;
                const ShotEntry& b = table.entries[later];
                const ShotKey* keyA = findShotKey(joinPath(path, a));
                const ShotKey* keyB = findShotKey(joinPath(path, b.key));
                if (!keyA || !keyB) continue;
                const bool excluded = contains(splitWords(keyA->excludes), b.key) ||
                                      contains(splitWords(keyB->excludes), a);
                if (!excluded) continue;
                problems_.add(b.where,
                              "'" + b.key + "' cannot stand beside '" + a + "' in " + label);
                break;
            }
        }
    }

    bool refuse(const ShotNode& node, const ShotKey& key)
    {
        // Of a text, the default shows the form: a number of frames is no range of them.
        const bool hasExample = key.type == KeyType::text && *key.byDefault;
        problems_.add(node.where, "'" + std::string(nameOf(key)) + "' must be " +
                                      expectationOf(key) +
                                      (hasExample ? std::string(", like ") + key.byDefault : "") +
                                      ", not " + quoted(node));
        return false;
    }

    ProblemList& problems_;
};

bool isExcluded(const ShotNode& table, const ShotKey& key)
{
    const std::vector<std::string> excludes = splitWords(key.excludes);
    return std::any_of(excludes.begin(), excludes.end(),
                       [&](const std::string& other) { return table.entry(other) != nullptr; });
}

/// Gravity points down, and where down is another key says.
std::string defaultTextOf(const ShotKey& key, const ShotNode& table)
{
    const bool isGravity = std::string_view(key.path) == "shot.gravity";
    const ShotNode* up = isGravity ? table.find("up") : nullptr;
    return up && up->text == "+z" ? "[0.0, 0.0, -9.81]" : key.byDefault;
}

void completeTable(ShotNode& table, const std::string& path, ReadTomlValue readValue)
{
    for (const ShotKey* key : keysInside(path)) {
        const std::string name(nameOf(*key));
        if (*key->byDefault && !table.find(name) && !isExcluded(table, *key)) {
            ShotEntry* present = table.entry(name);
            if (present) {
                present->isStandIn = true;
            } else {
                present = &table.entries.emplace_back(ShotEntry{name, table.where});
            }
            present->node = readValue(defaultTextOf(*key, table), table.where);
            present->isValid = true;
        }
        ShotEntry* inside = table.entry(name);
        if (!inside || !inside->isValid) continue;
        if (key->type == KeyType::table) {
            completeTable(inside->node, key->path, readValue);
        } else if (key->type == KeyType::namedTables) {
            for (ShotEntry& named : inside->node.entries) {
                if (named.isValid) completeTable(named.node, key->path, readValue);
            }
        } else if (key->type == KeyType::tableList) {
            for (ShotNode& item : inside->node.items) completeTable(item, key->path, readValue);
        }
    }
}

std::string printInline(const ShotNode& node, const ShotKey& key)
{
    if (key.type != KeyType::table) return toTomlText(node);
    std::string text;
    for (const ShotKey* inside : keysInside(key.path)) {
        const ShotNode* value = node.find(nameOf(*inside));
        if (!value) continue;
        text += (text.empty() ? "" : ", ") + std::string(nameOf(*inside)) + " = " +
                printInline(*value, *inside);
    }
    return text.empty() ? "{}" : "{ " + text + " }";
}

/// The entries of a table in the order of the schema, one "key = value" each; tables inside inline.
std::string printEntries(const ShotNode& table, const std::string& path)
{
    std::string text;
    for (const ShotKey* key : keysInside(path)) {
        const ShotNode* value = table.find(nameOf(*key));
        if (!value) continue;
        text += std::string(nameOf(*key)) + " = " + printInline(*value, *key) + "\n";
    }
    return text;
}

}  // namespace

void checkShotTree(ShotNode& tree, ProblemList& problems)
{
    Checker(problems).checkTable(tree, "", kFileLabel);
}

void completeShotTree(ShotNode& tree, ReadTomlValue readValue)
{
    completeTable(tree, "", readValue);
}

std::string printShotTree(const ShotNode& tree)
{
    std::string text;
    for (const ShotKey* key : keysInside("")) {
        const ShotNode* value = tree.find(key->path);
        if (!value) continue;
        const std::string path = key->path;
        if (key->type == KeyType::table) {
            text += "\n[" + path + "]\n" + printEntries(*value, path);
        } else if (key->type == KeyType::namedTables) {
            for (const ShotEntry& named : value->entries) {
                text += "\n[" + path + "." + named.key + "]\n" + printEntries(named.node, path);
            }
        } else if (key->type == KeyType::tableList) {
            for (const ShotNode& item : value->items) {
                text += "\n[[" + path + "]]\n" + printEntries(item, path);
            }
        } else {
            text += path + " = " + toTomlText(*value) + "\n";
        }
    }
    return text;
}

}  // namespace scree
