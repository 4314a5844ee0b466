#include "io/nearest_word.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace scree {
namespace {

std::string lowerCase(std::string_view word)
{
    std::string result(word);
    for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

/// What the keys and words of a shot are called in Blender, Houdini, Maya and game engines.
constexpr std::array<std::pair<std::string_view, std::string_view>, 36> kElsewhere = {{
    {"angular_velocity", "spin"},
    {"w", "spin"},
    {"linear_velocity", "velocity"},
    {"v", "velocity"},
    {"location", "position"},
    {"translate", "position"},
    {"translation", "position"},
    {"center", "position"},
    {"origin", "position"},
    {"rotate", "rotation"},
    {"euler", "rotation"},
    {"quaternion", "orientation"},
    {"orient", "orientation"},
    {"bounce", "restitution"},
    {"bounciness", "restitution"},
    {"elasticity", "restitution"},
    {"mu", "friction"},
    {"albedo", "color"},
    {"diffuse", "color"},
    {"geometry", "shape"},
    {"mesh", "file"},
    {"path", "file"},
    {"cube", "box"},
    {"ball", "sphere"},
    {"tube", "cylinder"},
    {"ring", "torus"},
    {"dimensions", "size"},
    {"length", "height"},
    {"type", "motion"},
    {"active", "dynamic"},
    {"rigid", "dynamic"},
    {"passive", "static"},
    {"fixed", "static"},
    {"kinematic", "keyed"},
    {"animated", "keyed"},
    {"framerate", "fps"},
}};

/// Edit distance with swaps of neighbours, by rows of the usual table.
std::size_t slipsBetween(const std::string& a, const std::string& b)
{
    std::vector<std::size_t> beforeLast(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t wrongLetter = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, wrongLetter});
            const bool isSwap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (isSwap) row[j] = std::min(row[j], beforeLast[j - 2] + 1);
        }
        std::swap(beforeLast, last);
        std::swap(last, row);
    }
    return last[b.size()];
}

}  // namespace

std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates)
{
    // Names longer than any of ours are not typing slips, and the table is quadratic.
    constexpr std::size_t kLongestWord = 200;
    if (word.size() > kLongestWord) return {};

    const std::string wanted = lowerCase(word);
    const std::size_t forgiven =
        std::max<std::size_t>(wanted.size() / 3, wanted.size() < 4 ? 1 : 2);
    std::string best;
    std::size_t fewest = forgiven + 1;
    for (const std::string& candidate : candidates) {
        if (candidate.size() > wanted.size() + forgiven) continue;
        if (wanted.size() > candidate.size() + forgiven) continue;
        const std::size_t slips = slipsBetween(wanted, lowerCase(candidate));
        if (slips < fewest && slips < std::max(wanted.size(), candidate.size())) {
            fewest = slips;
            best = candidate;
        }
    }
    return best;
}

std::string meantWord(std::string_view word, const std::vector<std::string>& candidates)
{
    std::string meant = nearestWord(word, candidates);
    for (const auto& [theirs, ours] : kElsewhere) {
        const bool isOffered = std::ranges::find(candidates, ours) != candidates.end();
        if (meant.empty() && isOffered && lowerCase(word) == theirs) meant = ours;
    }
    return meant;
}

std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates)
{
    const std::string meant = meantWord(word, candidates);
    return meant.empty() ? "" : "; did you mean '" + meant + "'?";
}

std::string joined(const std::vector<std::string>& words)
{
    std::string result;
    for (const std::string& word : words) result += (result.empty() ? "" : ", ") + word;
    return result;
}

}  // namespace scree
