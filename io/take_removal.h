// What may be removed from a folder that is to hold a take: what scree itself has written there.
// Folders called "frames" or "images" are common, and what else stands in them is somebody's.
#pragma once

#include "io/take_folder.h"

namespace scree {

/// Throws Error{cannotCreate} when the folder has a take.json or statistics that are no take's.
void refuseForeignFiles(const TakePaths& paths);

/// Removes a take, and with it the pictures and caches that were made from it: left beside another
/// they would be mixed with its own. Where there is neither a take.json nor a frame those are
/// somebody else's. Of folders that are links the contents go. Throws Error{cannotCreate}.
void removeTake(const TakePaths& paths);

/// Removes what a killed writer of a take has left half written, by the rules of removeAbandoned():
/// where a file system knows no locks another machine may be writing.
void removeTemporaries(const TakePaths& paths);

}  // namespace scree
