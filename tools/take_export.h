// Take → a cache for another program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/take_reader.h"
#include "tools/console.h"
#include "tools/progress.h"

namespace scree {

/// Writes `frames`, which must follow each other without a gap. Folders are made as needed. Signals
/// must be watched (tools/stop_signals.h): false when it was stopped, and no half file is left.
bool exportTake(const TakeReader& take, const std::vector<int>& frames,
                const std::filesystem::path& output, Console& console, ProgressMode progress);

/// <take>/exports/<shot>.abc, or <shot>.####.obj for formats that are one file a frame.
std::filesystem::path defaultExport(const TakeReader& take, const std::string& ending);

/// Makes the folder that `file`, or the frames of this pattern, will stand in, and clears it of
/// what killed runs left of earlier ones. Throws Error{cannotCreate} when that does not work, or
/// the file is one of those that a take consists of.
void createFolderOf(const std::filesystem::path& file, Console& console);

}  // namespace scree
