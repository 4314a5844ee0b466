#include "io/text_forms.h"

#include <cstdio>

namespace scree {

std::string inSmallLetters(std::string text)
{
    for (char& letter : text)
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    return text;
}

std::string endingOf(const std::filesystem::path& file)
{
    const std::string ending = file.extension().string();
    return ending.empty() ? ending : inSmallLetters(ending.substr(1));
}

std::string shortened(const std::string& text, std::size_t longest)
{
    if (text.size() <= longest) return text;
    std::size_t length = longest - 3;
    // What goes on with a character begins with the bits 10.
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xc0) == 0x80) --length;
    return text.substr(0, length) + "...";
}

std::string formatted(const char* format, double a, double b)
{
    char text[160];
    std::snprintf(text, sizeof text, format, a, b);
    return text;
}

std::string percent(double share)
{
    return formatted(share < 1.0 ? "%.2g %%" : "%.0f %%", 100.0 * share);
}

std::string toHex(std::uint64_t value)
{
    std::string text(16, '0');
    for (int digit = 15; digit >= 0; --digit, value >>= 4)
        text[digit] = "0123456789abcdef"[value & 15];
    return text;
}

}  // namespace scree
