#include "io/stats_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include "core/base/error.h"
#include "io/file_bytes.h"
#include "io/frame_stats.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

/// Appends a line and makes it durable. A write that fails half way is cut back.
void appendLine(const fs::path& path, const std::string& line)
{
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor < 0)
        throw Error(ErrorKind::cannotCreate,
                    "cannot create \"" + path.string() + "\": " + std::strerror(errno));
    const off_t before = ::lseek(descriptor, 0, SEEK_END);
    const std::string bytes = line + "\n";
    // A call that writes a part does not say why: the next one does.
    std::string_view rest = bytes;
    int reason = 0;
    while (!rest.empty() && reason == 0) {
        const ssize_t count = ::write(descriptor, rest.data(), rest.size());
        if (count > 0) rest.remove_prefix(static_cast<std::size_t>(count));
        if (count == 0) reason = ENOSPC;
        if (count < 0 && errno != EINTR) reason = errno;
    }
    const bool written = rest.empty();
    if (!written && ::ftruncate(descriptor, before) != 0) {
        // The cut line is skipped by readers and dropped by the next resume.
    }
    const bool isKept = ::fdatasync(descriptor) == 0;
    if (written && !isKept) reason = errno;
    const bool isClosed = ::close(descriptor) == 0;
    if (written && isKept && !isClosed) reason = errno;
    if (!written || !isKept || !isClosed)
        throw Error(ErrorKind::inputOutput,
                    "writing \"" + path.string() + "\" failed: " + std::strerror(reason));
}

}  // namespace

void StatsFile::readLinesOf(const std::set<int>& frames)
{
    for (const FrameSummary& summary : readStats(path_))
        if (frames.contains(summary.frame)) lines_[summary.frame] = summary.line;
}

void StatsFile::add(int frame, const std::string& line)
{
    const bool isLast = lines_.empty() || lines_.rbegin()->first < frame;
    lines_[frame] = line;
    if (isLast)
        appendLine(path_, line);
    else
        rewrite();
}

void StatsFile::rewrite() const
{
    std::string text;
    for (const auto& [frame, line] : lines_) text += line + "\n";
    writeFileBytes(path_, text);
}

}  // namespace scree
