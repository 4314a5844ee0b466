// Numbers as text: the shortest decimal form that reads back to the same value, whatever the
// locale. Equal numbers are equal bytes, which exports of one take have to be.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace scree {

/// Also for float: 0.1f is "0.1", not what its double would need.
template <class Number>
void appendNumber(std::string& text, Number value)
{
    std::array<char, 32> letters;
    const auto end = std::to_chars(letters.data(), letters.data() + letters.size(), value).ptr;
    text.append(letters.data(), end);
}

template <class Number>
std::string numberText(Number value)
{
    std::string text;
    appendNumber(text, value);
    return text;
}

}  // namespace scree
