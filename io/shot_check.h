// Holds a shot's tree against the schema: says what is wrong, writes in every default, prints the
// result. What needs knowledge beyond one key (names that must exist, bodies in total) is said in
// shot_interpreter.h.
#pragma once

#include <string>

#include "io/problem_list.h"
#include "io/shot_schema.h"
#include "io/shot_tree.h"

namespace scree {

/// Reports unknown keys, wrong types and ranges, missing and contradicting keys.
/// Entries reported as wrong lose `isValid`; whole numbers where numbers are asked become numbers.
void checkShotTree(ShotNode& tree, ProblemList& problems);

/// Turns the default text of a key into a value; the parser's, so that defaults are TOML too.
using ReadTomlValue = ShotNode (*)(const std::string& text, const SourceLocation& where);

/// Writes the default of every key that has one and is absent or wrong. A key whose place is taken
/// by one that excludes it gets none.
void completeShotTree(ShotNode& tree, ReadTomlValue readValue);

/// The tree as TOML, in the order of the schema: the resolved shot.
std::string printShotTree(const ShotNode& tree);

}  // namespace scree
