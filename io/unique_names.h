// Names for objects of a file that is stricter about them than a shot is.
#pragma once

#include <string>
#include <string_view>
#include <unordered_set>

namespace scree {

/// A letter or _, then letters, digits and _: what USD takes as the name of a prim.
bool isPlainName(std::string_view name);

/// Names of siblings. A wanted name is kept when it is plain and free; else other letters become _,
/// a leading digit gets a _ in front, and _2, _3, … keeps it apart from those already taken. Who
/// changes a name writes the old one beside it, which makes the mapping reversible.
class UniqueNames {
public:
    std::string take(std::string_view wanted);

private:
    std::unordered_set<std::string> taken_;
};

}  // namespace scree
