#include "io/take_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "core/base/error.h"
#include "io/atomic_file.h"
#include "io/file_bytes.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFramePrefix = "frame.";
constexpr std::string_view kFrameSuffix = ".scree";

}  // namespace

fs::path TakePaths::frame(int frame) const
{
    char name[32];
    std::snprintf(name, sizeof name, "frame.%06d.scree", frame);
    return frames() / name;
}

std::optional<int> frameNumber(const std::string& name)
{
    if (!name.starts_with(kFramePrefix) || !name.ends_with(kFrameSuffix)) return std::nullopt;
    const std::string digits =
        name.substr(kFramePrefix.size(), name.size() - kFramePrefix.size() - kFrameSuffix.size());
    const std::size_t firstDigit = digits.starts_with('-') ? 1 : 0;
    if (digits.size() < firstDigit + 1 || digits.size() > 9 ||
        digits.find_first_not_of("0123456789", firstDigit) != std::string::npos)
        return std::nullopt;
    return std::stoi(digits);
}

std::vector<int> listFrames(const TakePaths& paths)
{
    std::vector<int> frames;
    std::error_code code;
    for (const fs::directory_entry& entry : fs::directory_iterator(paths.frames(), code)) {
        const fs::path name = entry.path().filename();
        const auto frame = frameNumber(name.string());
        // A number with fewer digits, or more, is that of no file which we read.
        if (frame && paths.frame(*frame).filename() == name) frames.push_back(*frame);
    }
    std::sort(frames.begin(), frames.end());
    return frames;
}

bool holdsTake(const TakePaths& paths)
{
    return isThere(paths.info()) || !listFrames(paths).empty();
}

void refuseTakeFile(const fs::path& output)
{
    std::error_code code;
    const fs::path file = fs::weakly_canonical(output, code);
    if (code) return;
    const fs::path folder = file.parent_path();
    const TakePaths here{folder}, above{folder.parent_path()};
    const bool isOfTake =
        (isThere(here.info()) &&
         (file == here.info() || file == here.stats() || file == here.checkpoint())) ||
        (isThere(above.info()) && (folder == above.frames() || folder == above.shapes()));
    if (isOfTake)
        throw Error(ErrorKind::cannotCreate, "cannot write \"" + output.string() +
                                                 "\": it belongs to the take itself, which only "
                                                 "scree sim writes");
}

void createFolder(const fs::path& folder)
{
    std::error_code code;
    std::vector<fs::path> parents;  // of the folders that are new
    for (fs::path at = folder; !at.empty() && !fs::exists(at, code); at = at.parent_path())
        parents.push_back(folderOf(at));
    fs::create_directories(folder, code);
    if (code)
        throw Error(ErrorKind::cannotCreate,
                    "cannot create the folder \"" + folder.string() + "\": " + code.message());
    for (const fs::path& parent : parents) {
        if (const int reason = syncFolder(parent); reason != 0)
            throw Error(ErrorKind::inputOutput, "making durable the folder \"" + folder.string() +
                                                    "\" failed: " + std::strerror(reason));
    }
}

/// Of a file, because NFS tells other machines of no lock on a folder, nor of one without leave to
/// write. File systems that know no locks are taken at their word.
TakeLock::TakeLock(const TakePaths& paths)
    : descriptor_(::open(paths.lock().c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666))
{
    if (descriptor_ < 0)
        throw Error(
            errno == ENOSPC || errno == EDQUOT ? ErrorKind::inputOutput : ErrorKind::cannotCreate,
            "cannot create \"" + paths.lock().string() + "\": " + std::strerror(errno));
    struct flock whole = {};
    whole.l_type = F_WRLCK;
    whole.l_whence = SEEK_SET;
    if (::fcntl(descriptor_, F_OFD_SETLK, &whole) != 0 && (errno == EAGAIN || errno == EACCES)) {
        ::close(descriptor_);
        throw Error(ErrorKind::cannotCreate,
                    "\"" + paths.root.string() + "\" is being written by another scree sim");
    }
}

TakeLock::~TakeLock()
{
    ::close(descriptor_);
}

}  // namespace scree
