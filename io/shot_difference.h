// In which keys two resolved shots differ, for whoever wonders why a take does not fit a shot.
#pragma once

#include <string>
#include <vector>

namespace scree {

/// One line for every key that is not the same: "shot.frames = \"1001-1300\" (the take has
/// \"1001-1240\")", in the order of `ours`, then what only `theirs` has. `owner` is what messages
/// call theirs. Items of lists go by their names, or by their number where they have none.
std::vector<std::string> shotDifferences(const std::string& ours, const std::string& theirs,
                                         const std::string& owner);

/// The first few of them with commas, and how many more there are.
std::string someDifferences(const std::vector<std::string>& differences);

}  // namespace scree
