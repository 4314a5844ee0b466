// Names for objects of a file that is stricter about them than a shot is.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_set>

namespace scree {

/// Names become those of files, with endings and the like; systems take 255 letters.
inline constexpr std::size_t kLongestName = 200;

/// A letter or _, then letters, digits and _: what a shot and USD take as a name.
bool isPlainName(std::string_view name);

/// The name, if it is plain; else other letters become _, and a leading digit gets a _ in front.
std::string plainName(std::string_view wanted);

/// Names of siblings. A wanted name is made plain, and _2, _3, … keeps it apart from those already
/// taken. Who changes a name writes the old one beside it, which makes the mapping reversible.
class UniqueNames {
public:
    std::string take(std::string_view wanted);

private:
    std::unordered_set<std::string> taken_;
};

}  // namespace scree
