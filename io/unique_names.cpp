#include "io/unique_names.h"

#include <algorithm>

namespace scree {

namespace {

bool isDigit(char letter)
{
    return letter >= '0' && letter <= '9';
}

bool fitsInName(char letter)
{
    return isDigit(letter) || letter == '_' || (letter >= 'a' && letter <= 'z') ||
           (letter >= 'A' && letter <= 'Z');
}

}  // namespace

bool isPlainName(std::string_view name)
{
    return !name.empty() && !isDigit(name.front()) &&
           std::all_of(name.begin(), name.end(), fitsInName);
}

std::string plainName(std::string_view wanted)
{
    std::string name(wanted);
    std::replace_if(
        name.begin(), name.end(), [](char letter) { return !fitsInName(letter); }, '_');
    if (name.empty() || isDigit(name.front())) name.insert(0, "_");
    return name;
}

std::string UniqueNames::take(std::string_view wanted)
{
    const std::string name = plainName(wanted);
    std::string free = name;
    for (int copy = 2; !taken_.insert(free).second; ++copy)
        free = name + "_" + std::to_string(copy);
    return free;
}

}  // namespace scree
