#include "io/shot_schema.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/base/error.h"
#include "io/nearest_word.h"
#include "io/text_forms.h"

namespace scree {
namespace {

/// " from 0 to 1000", " above 0", " above 0 and below 180"; nothing without limits.
std::string rangeText(const ShotKey& key)
{
    const bool hasMin = std::isfinite(key.min), hasMax = std::isfinite(key.max);
    const std::string min = formatted("%.10g", key.min), max = formatted("%.10g", key.max);
    if (hasMin && hasMax && key.min == key.max) return " " + min;
    if (hasMin && hasMax && key.isOpen) return " above " + min + " and below " + max;
    if (hasMin && hasMax) return " from " + min + " to " + max;
    if (hasMin) return (key.isOpen ? " above " : " of at least ") + min;
    if (hasMax) return (key.isOpen ? " below " : " of at most ") + max;
    return "";
}

/// Which number is which, where that has a name.
std::string listPattern(int count)
{
    return count == 3 ? " [x, y, z]" : count == 4 ? " [w, x, y, z]" : "";
}

std::string quotedChoices(const char* choices)
{
    std::string text;
    for (const std::string& word : splitWords(choices)) {
        text += (text.empty() ? "\"" : ", \"") + word + "\"";
    }
    return text;
}

/// Breaks at spaces so that lines, indented by four, stay within 80 columns.
std::string wrapped(const std::string& text)
{
    constexpr std::size_t kWidth = 76;
    std::string result, line;
    std::size_t from = 0;
    while (from < text.size()) {
        const std::size_t to = std::min(text.find(' ', from), text.size());
        const std::string word = text.substr(from, to - from);
        if (!line.empty() && line.size() + 1 + word.size() > kWidth) {
            result += "    " + line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
        from = to + 1;
    }
    return result + "    " + line + "\n";
}

std::string explanationOf(const ShotKey& key)
{
    std::string text = std::string(key.path) + "\n    must be " + expectationOf(key);
    if (*key.unit && std::string_view(key.unit) != "-") text += " [" + std::string(key.unit) + "]";
    if (key.isRequired) {
        text += "; required\n";
    } else if (*key.byDefault && key.type != KeyType::table) {
        text += "; default " + std::string(key.byDefault) + "\n";
    } else {
        text += "; optional\n";
    }
    text += wrapped(key.help);
    if (*key.excludes) {
        text += wrapped("Not together with " + joined(splitWords(key.excludes)) + ".");
    }
    const std::vector<std::string> inside = namesInside(key.path);
    if (!inside.empty()) text += wrapped("Keys: " + joined(inside) + ".");
    return text;
}

/// "material.wood.friction" → "material.friction": the names that shots give leave no trace.
std::string withoutGivenName(const std::string& path)
{
    const std::size_t first = path.find('.');
    if (first == std::string::npos) return path;
    const ShotKey* table = findShotKey(path.substr(0, first));
    const bool isNamed =
        table && (table->type == KeyType::namedTables || table->type == KeyType::tableList);
    const std::size_t second = path.find('.', first + 1);
    if (!isNamed || second == std::string::npos) return path;
    return path.substr(0, first) + path.substr(second);
}

}  // namespace

const ShotKey* findShotKey(std::string_view path)
{
    static const std::unordered_map<std::string_view, const ShotKey*> keyOf = [] {
        std::unordered_map<std::string_view, const ShotKey*> map;
        for (const ShotKey& key : shotKeys()) map.emplace(key.path, &key);
        return map;
    }();
    const auto found = keyOf.find(path);
    return found == keyOf.end() ? nullptr : found->second;
}

std::vector<const ShotKey*> keysInside(std::string_view path)
{
    std::vector<const ShotKey*> result;
    for (const ShotKey& key : shotKeys()) {
        const std::string_view candidate = key.path;
        if (joinPath(path, nameOf(key)) == candidate) result.push_back(&key);
    }
    return result;
}

std::vector<std::string> namesInside(std::string_view path)
{
    std::vector<std::string> names;
    for (const ShotKey* key : keysInside(path)) {
        names.emplace_back(nameOf(*key));
    }
    return names;
}

std::string_view nameOf(const ShotKey& key)
{
    const std::string_view path = key.path;
    const std::size_t dot = path.rfind('.');
    return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

std::string nameByDefault(std::string_view list)
{
    const ShotKey* name = findShotKey(joinPath(list, "name"));
    const std::string_view quoted = name ? name->byDefault : "";
    return quoted.size() < 2 ? "" : std::string(quoted.substr(1, quoted.size() - 2));
}

std::vector<std::string> splitWords(std::string_view words)
{
    std::vector<std::string> result;
    while (!words.empty()) {
        const std::size_t bar = std::min(words.find('|'), words.size());
        result.emplace_back(words.substr(0, bar));
        words.remove_prefix(std::min(bar + 1, words.size()));
    }
    return result;
}

std::string joinPath(std::string_view table, std::string_view name)
{
    return table.empty() ? std::string(name) : std::string(table) + "." + std::string(name);
}

std::string expectationOf(const ShotKey& key)
{
    const std::string count = std::to_string(key.count), range = rangeText(key);
    const std::string eachRange = range.empty() ? "" : ", each" + range;
    switch (key.type) {
        case KeyType::boolean:
            return "true or false";
        case KeyType::integer:
            return key.min == key.max ? range.substr(1) : "a whole number" + range;
        case KeyType::number:
            return "a number" + range;
        case KeyType::text:
            return "text in quotes";
        case KeyType::word:
            return *key.choices ? "one of " + quotedChoices(key.choices) : "a word in quotes";
        case KeyType::integers:
            return count + " whole numbers" + listPattern(key.count) + eachRange;
        case KeyType::numbers:
            if (key.count == 0) return "a list of numbers" + eachRange;
            return count + " numbers" + listPattern(key.count) + eachRange;
        case KeyType::numberOrList:
            return "a number" + range + ", or " + count + " such numbers" + listPattern(key.count);
        case KeyType::numberOrWord:
            return "a number" + range + ", or " + quotedChoices(key.choices);
        case KeyType::textOrTexts:
            return "text in quotes, or a list of such texts";
        case KeyType::words:
            if (!*key.choices) return "a list of names in quotes";
            return "a list of words from " + quotedChoices(key.choices);
        case KeyType::table:
            return "a table";
        case KeyType::namedTables:
            return "tables, each with a name: [" + std::string(key.path) + ".NAME]";
        case KeyType::tableList:
            return "a list of tables: [[" + std::string(key.path) + "]]";
    }
    return "";
}

std::string explainKey(const std::string& path)
{
    if (const ShotKey* key = findShotKey(path)) return explanationOf(*key);
    if (const ShotKey* key = findShotKey(withoutGivenName(path))) return explanationOf(*key);

    // A bare name may stand for every key that is called so.
    std::string text;
    std::vector<std::string> paths, names;
    for (const ShotKey& key : shotKeys()) {
        if (nameOf(key) == path) text += (text.empty() ? "" : "\n") + explanationOf(key);
        paths.emplace_back(key.path);
        names.emplace_back(nameOf(key));
    }
    if (!text.empty()) return text;

    // Of a table that there is, its own keys are nearer than any word elsewhere.
    const std::string plain = withoutGivenName(path);
    const std::vector<std::string> inside =
        namesInside(plain.substr(0, std::min(plain.rfind('.'), plain.size())));
    std::string hint = didYouMean(plain, paths);
    if (hint.empty() && plain.find('.') != std::string::npos && !inside.empty()) {
        hint = " (valid: " + joined(inside) + ")";
    }
    if (hint.empty()) hint = didYouMean(path.substr(path.rfind('.') + 1), names);
    if (hint.empty()) hint = "; the file's tables are: " + joined(namesInside(""));
    throw Error(ErrorKind::usage, "no key '" + path + "' in shot files" + hint);
}

}  // namespace scree
