#include "io/take_removal.h"

#include <string>
#include <system_error>
#include <vector>

#include "core/base/error.h"
#include "io/atomic_file.h"
#include "io/file_bytes.h"
#include "io/frame_stats.h"
#include "io/take_info.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuseForeign(const fs::path& file, const std::string& what)
{
    throw Error(ErrorKind::cannotCreate, "\"" + file.string() + "\" is not " + what +
                                             ": move it away, or choose another folder with -o");
}

/// Meshes that the take says it keeps; none where it is damaged.
std::vector<fs::path> shapeFiles(const TakePaths& paths)
{
    std::vector<fs::path> files;
    try {
        const TakeInfo info = decodeTakeInfo(readFileBytes(paths.info()), paths.info());
        for (const TakeShape& shape : info.shapes) files.push_back(paths.shape(shape.name));
    } catch (const Error&) {
        // What is left is written over where it has the name of a shape of the next take.
    }
    return files;
}

void removeWhole(const fs::path& path)
{
    std::error_code code;
    fs::remove_all(path, code);
    if (code)
        throw Error(ErrorKind::cannotCreate,
                    "cannot remove \"" + path.string() + "\": " + code.message());
}

/// Of a folder that somebody has put on another disk the link stays, for the next take's.
void removeMade(const fs::path& path)
{
    std::error_code code;
    if (!fs::is_symlink(path, code)) return removeWhole(path);
    for (const fs::directory_entry& entry : fs::directory_iterator(path, code))
        removeWhole(entry.path());
}

}  // namespace

void refuseForeignFiles(const TakePaths& paths)
{
    // A damaged take.json may say nothing any more, but has frames beside it.
    const bool isOfTake = !isThere(paths.info()) || !listFrames(paths).empty() ||
                          readFileBytes(paths.info()).find(kTakeFormat) != std::string::npos;
    if (!isOfTake) refuseForeign(paths.info(), "the description of a take");
    // A line that was cut belongs to a take, if that is there.
    const bool areFigures = isThere(paths.info()) || !isThere(paths.stats()) ||
                            readFileBytes(paths.stats()).empty() ||
                            !readStats(paths.stats()).empty();
    if (!areFigures) refuseForeign(paths.stats(), "the statistics of a take");
    // A take that begins here is replaced one day, and what was made from it goes with it.
    if (isThere(paths.info()) || !listFrames(paths).empty()) return;
    for (const fs::path& folder : {paths.images(), paths.exports()}) {
        std::error_code none;
        if (!fs::is_empty(folder, none) && !none) refuseForeign(folder, "made from a take");
    }
}

void removeTake(const TakePaths& paths)
{
    const std::vector<fs::path> shapes = shapeFiles(paths);
    // A take.json that is lost has left frames, or nothing that a take would be known by.
    if (isThere(paths.info()) || !listFrames(paths).empty()) {
        for (const fs::path& made : {paths.images(), paths.exports(), paths.statsPage()})
            removeMade(made);
    }
    // The description goes before the frames: from then on nobody takes the rest for a take.
    removeWhole(paths.info());
    for (const int frame : listFrames(paths)) removeWhole(paths.frame(frame));
    for (const fs::path& shape : shapes) removeWhole(shape);
    for (const fs::path& file : {paths.stats(), paths.checkpoint()}) removeWhole(file);
    for (const fs::path& folder : {paths.frames(), paths.shapes()}) {
        std::error_code isNotEmpty;
        if (!fs::is_symlink(folder, isNotEmpty)) fs::remove(folder, isNotEmpty);
    }
}

void removeTemporaries(const TakePaths& paths)
{
    removeAbandonedIn(paths.root, [&](const std::string& name) {
        return name == paths.info().filename() || name == paths.stats().filename() ||
               name == paths.checkpoint().filename();
    });
    removeAbandonedIn(paths.frames(),
                      [](const std::string& name) { return frameNumber(name).has_value(); });
    removeAbandonedIn(paths.shapes(),
                      [](const std::string& name) { return name.ends_with(".ply"); });
}

}  // namespace scree
