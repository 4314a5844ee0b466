// Whether a take may be gone on with: it must be of this very shot, or the frames to come would not
// fit those that are there. Looks at everything and writes nothing, so that a resume that is
// refused leaves the take as good as it was.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/scene/world.h"
#include "io/shot.h"
#include "io/take_branch.h"
#include "io/take_folder.h"
#include "io/take_info.h"

namespace scree {

/// A take that is known to be of the shot.
struct ProvenTake {
    TakeInfo info;                     ///< what take.json says; made again where it is lost
    std::set<int> wholeFrames;         ///< of the shot's frames those whose file is whole
    std::vector<std::string> notices;  ///< what was found damaged or odd, one sentence each
};

/// `now` is what take.json would say if the take began now, in `world` at time zero. Throws
/// Error{badInput} when shot, input files, bodies, meshes, first frame or `branch` are others than
/// the take's, Error{inputOutput} when take.json is lost or damaged and its frames do not tell that
/// they are of this shot.
ProvenTake proveTake(const TakePaths& paths, const Shot& shot, const World& world,
                     const TakeInfo& now, const std::optional<TakeBranch>& branch);

}  // namespace scree
