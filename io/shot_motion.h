// What a shot says of how things are driven: keyed motion, forces, collision groups, exceptions for
// pairs of materials. Part of reading a shot (shot_interpreter.h).
#pragma once

#include <string>
#include <vector>

#include "io/problem_list.h"
#include "io/shot.h"
#include "io/shot_tree.h"

namespace scree {

/// Reads `keys`, `interpolate`, `keyed_from` and `release` of a [[body]]; reports what fits badly.
/// The shot's frames and units must be known.
void readKeyedMotion(const ShotNode& node, const Shot& shot, ShotBody& body, ProblemList& problems);

/// Reads `keyed_from` and `release` of a keyed [[body]], or of all bodies of an [[import]]: when
/// they are not.
void readFreeTimes(const ShotNode& node, const Shot& shot, ShotBody& body, ProblemList& problems);

/// Reads `force` and `torque` of a [[body]].
void readBodyForces(const ShotNode& node, ShotBody& body, ProblemList& problems);

/// Reads all [[pair]].
void readMaterialPairs(const ShotNode& tree, Shot& shot, ProblemList& problems);

/// The groups of all bodies of a shot: a bit for each name.
class GroupNames {
public:
    /// Finds the names that bodies, imports and emitters give; reports when they are too many.
    GroupNames(const ShotNode& tree, ProblemList& problems);

    /// Reads `group`, `collides` and `unmoved_by` of a [[body]], [[import]] or [[emitter]].
    CollisionGroups read(const ShotNode& node);

    /// Of a list of names.
    std::uint64_t bitsOf(const ShotNode& names);

private:
    std::uint64_t bitOf(const ShotNode& name);

    std::vector<std::string> names_;  // the first is that of bodies which give none
    ProblemList& problems_;
};

/// Reads all [[force]].
void readForceFields(const ShotNode& tree, GroupNames& groups, Shot& shot, ProblemList& problems);

}  // namespace scree
