// The word somebody probably meant: for "did you mean …" in error messages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// The candidate with the fewest slips (a letter too many, missing, wrong, or two swapped) from
/// `word`, capitals ignored; the first of equals. Empty when none is near: more than a third of the
/// letters would have to change, though two slips are forgiven from four letters on.
std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates);

/// The nearest candidate, or that which `word` is the name of in other programs; empty when there
/// is neither.
std::string meantWord(std::string_view word, const std::vector<std::string>& candidates);

/// "; did you mean 'x'?" of the meant word, or nothing when there is none.
std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates);

/// "a, b, c"
std::string joined(const std::vector<std::string>& words);

}  // namespace scree
