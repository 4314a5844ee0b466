#include "io/obj_names.h"

#include <algorithm>
#include <cstring>

namespace scree {
namespace {

constexpr char kNoBlank = '\x1f';  // the separator of units, which nobody types

bool isBlank(char c)
{
    return c == ' ' || c == '\t';
}

}  // namespace

bool closeObjNames(std::string& text)
{
    bool isChanged = false;
    const char* const end = text.data() + text.size();
    for (char* line = text.data(); line < end;) {
        const void* newline = std::memchr(line, '\n', end - line);
        char* const next = newline ? line + (static_cast<const char*>(newline) - line) + 1
                                   : text.data() + text.size();
        if (*line == 'o' && next - line > 2 && isBlank(line[1])) {
            const auto isInk = [](char c) { return !isBlank(c) && c != '\r' && c != '\n'; };
            char* const first = std::find_if(line + 1, next, isInk);
            char* last = next;
            while (last > first && !isInk(last[-1])) --last;
            isChanged = isChanged || std::any_of(first, last, isBlank);
            std::replace_if(first, last, isBlank, kNoBlank);
        }
        line = next;
    }
    return isChanged;
}

std::string openedObjName(std::string name)
{
    std::replace(name.begin(), name.end(), kNoBlank, ' ');
    return name;
}

}  // namespace scree
