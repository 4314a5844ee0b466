#include "io/obj_names.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <string_view>
#include <vector>

namespace scree {
namespace {

constexpr char kNoBlank = '\x1f';  // the separator of units, which nobody types

bool isBlank(char c)
{
    return c == ' ' || c == '\t';
}

/// Whether the line begins with the keyword, which is one letter.
bool says(std::string_view line, char keyword)
{
    return line.size() > 1 && line[0] == keyword && isBlank(line[1]);
}

template <class Action>
void forEachLine(std::string_view text, const Action& action)
{
    while (!text.empty()) {
        const std::size_t newline = text.find('\n');
        const std::size_t length = newline == std::string_view::npos ? text.size() : newline + 1;
        action(text.substr(0, length));
        text.remove_prefix(length);
    }
}

/// What follows the keyword, without the blanks around it.
std::string_view wordsOf(std::string_view line)
{
    constexpr const char* kSpace = " \t\r\n";
    const std::size_t first = line.find_first_not_of(kSpace, 1);
    if (first == std::string_view::npos) return {};
    return line.substr(first, line.find_last_not_of(kSpace) + 1 - first);
}

struct ObjObject {
    std::string name;
    bool hasFaces = false;
};

/// One for every line "o NAME".
std::vector<ObjObject> objectsOf(const std::string& text)
{
    std::vector<ObjObject> objects;
    forEachLine(text, [&](std::string_view line) {
        if (says(line, 'o')) objects.push_back({std::string(wordsOf(line))});
        if (says(line, 'f') && !objects.empty()) objects.back().hasFaces = true;
    });
    return objects;
}

/// Gives objects with faces names of their own; those without are nothing, and keep theirs.
void tellApart(std::vector<ObjObject>& objects)
{
    std::set<std::string> names, taken;
    for (const ObjObject& object : objects) names.insert(object.name);
    std::map<std::string, int> lastNumber;
    for (ObjObject& object : objects) {
        if (!object.hasFaces || taken.insert(object.name).second) continue;
        const std::string name = object.name;
        do {
            char number[16];
            std::snprintf(number, sizeof number, ".%03d", ++lastNumber[name]);
            object.name = name + number;
        } while (!names.insert(object.name).second);
    }
}

/// In one piece, as assimp reads it.
std::string closed(std::string name)
{
    std::replace_if(name.begin(), name.end(), isBlank, kNoBlank);
    return name;
}

}  // namespace

std::optional<std::string> textWithObjNames(const std::string& text)
{
    std::vector<ObjObject> objects = objectsOf(text);
    // The common large file, one object, is not copied.
    if (objects.empty() || (objects.size() == 1 && closed(objects[0].name) == objects[0].name)) {
        return std::nullopt;
    }
    tellApart(objects);
    const auto hasFaces = [](const ObjObject& object) { return object.hasFaces; };
    const bool areGroupsIdle = std::count_if(objects.begin(), objects.end(), hasFaces) > 1;
    std::string result;
    result.reserve(text.size() + 8 * objects.size());
    auto object = objects.begin();
    forEachLine(text, [&](std::string_view line) {
        if (says(line, 'o')) {
            result += "o " + closed((object++)->name) + (line.back() == '\n' ? "\n" : "");
        } else {
            const std::size_t start = result.size();
            result += line;
            if (areGroupsIdle && says(line, 'g')) result[start] = '#';
        }
    });
    if (result == text) return std::nullopt;
    return result;
}

std::string openedObjName(std::string name)
{
    std::replace(name.begin(), name.end(), kNoBlank, ' ');
    return name;
}

}  // namespace scree
