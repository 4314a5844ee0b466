#include "io/shot_difference.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>
#include "io/text_forms.h"

namespace scree {
namespace {

constexpr std::size_t kMostTold = 3;
constexpr std::size_t kLongestValue = 60;

/// Keys with the tables they stand in, and their values, in the order of the text.
using Entries = std::vector<std::pair<std::string, std::string>>;

/// A resolved shot holds one "key = value" a line, and the name of an item first.
Entries entriesOf(const std::string& resolvedShot)
{
    constexpr const char* kName = "name = ";
    Entries entries;
    std::map<std::string, int> countOf;  // of [[tables]]
    std::string table, item;             // "body", "body[3]" until its name is known
    std::istringstream lines(resolvedShot);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("[[")) {
            table = line.substr(2, line.find(']') - 2);
            item = table + "[" + std::to_string(++countOf[table]) + "]";
        } else if (line.starts_with("[")) {
            table.clear();
            item = line.substr(1, line.find(']') - 1);
        } else if (const std::size_t equals = line.find(" = "); equals != std::string::npos) {
            const std::string value = line.substr(equals + 3);
            const bool isNamed = !table.empty() && line.starts_with(kName) && value.size() > 2;
            if (isNamed) item = table + "." + value.substr(1, value.size() - 2);
            entries.emplace_back((item.empty() ? "" : item + ".") + line.substr(0, equals), value);
        }
    }
    return entries;
}

/// Two long values from a little before where they part.
std::pair<std::string, std::string> fromWhereTheyPart(const std::string& a, const std::string& b)
{
    constexpr std::size_t kBefore = 20;
    const auto parting = static_cast<std::size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
    if (parting < kLongestValue - kBefore) return {a, b};
    std::size_t from = parting - kBefore;
    // What goes on with a character begins with the bits 10.
    while (from > 0 && (static_cast<unsigned char>(a[from]) & 0xc0) == 0x80) --from;
    return {"..." + a.substr(from), "..." + b.substr(from)};
}

}  // namespace

std::vector<std::string> shotDifferences(const std::string& ours, const std::string& theirs,
                                         const std::string& owner)
{
    const Entries mine = entriesOf(ours), other = entriesOf(theirs);
    const std::map<std::string, std::string> valueHere(mine.begin(), mine.end());
    const std::map<std::string, std::string> valueThere(other.begin(), other.end());
    std::vector<std::string> differences;
    for (const auto& [key, value] : mine) {
        const auto there = valueThere.find(key);
        if (there != valueThere.end() && there->second == value) continue;
        if (there == valueThere.end()) {
            differences.push_back(key + " = " + shortened(value, kLongestValue) + " (" + owner +
                                  " has none)");
            continue;
        }
        const auto [here, elsewhere] = fromWhereTheyPart(value, there->second);
        differences.push_back(key + " = " + shortened(here, kLongestValue) + " (" + owner +
                              " has " + shortened(elsewhere, kLongestValue) + ")");
    }
    for (const auto& [key, value] : other) {
        if (valueHere.contains(key)) continue;
        differences.push_back("no " + key + " (" + owner + " has " +
                              shortened(value, kLongestValue) + ")");
    }
    return differences;
}

std::string someDifferences(const std::vector<std::string>& differences)
{
    std::string text;
    const std::size_t told = std::min(differences.size(), kMostTold);
    for (std::size_t i = 0; i < told; ++i) text += (i == 0 ? "" : ", ") + differences[i];
    if (differences.size() > told) {
        text += " and " + std::to_string(differences.size() - told) + " more";
    }
    return text;
}

}  // namespace scree
