#include "io/spool_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "core/base/check.h"
#include "core/base/error.h"

namespace scree {

namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

/// A file without a name. Where the file system cannot make one at once, it loses its name here.
int openNameless(const std::filesystem::path& folder)
{
    const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (descriptor >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != ENOENT)) {
        return descriptor;
    }
    std::string pattern = (folder / ".spool.XXXXXX").string();
    const int named = ::mkostemp(pattern.data(), O_CLOEXEC);
    if (named >= 0) ::unlink(pattern.c_str());
    return named;
}

}  // namespace

SpoolFile::SpoolFile(const std::filesystem::path& folder)
    : folder_(folder.empty() ? std::filesystem::path(".") : folder)
{
    descriptor_ = openNameless(folder_);
    if (descriptor_ >= 0) return;
    if (errno == ENOSPC || errno == EDQUOT) fail("writing", errno);
    throw Error(ErrorKind::cannotCreate, "cannot create a temporary file in \"" + folder_.string() +
                                             "\": " + std::strerror(errno));
}

SpoolFile::~SpoolFile()
{
    if (descriptor_ >= 0) ::close(descriptor_);
}

void SpoolFile::write(std::string_view bytes)
{
    pending_.append(bytes);
    if (pending_.size() >= kPieceBytes) flush();
}

void SpoolFile::read(std::uint64_t offset, void* bytes, std::size_t byteCount)
{
    SCREE_CHECK(offset + byteCount <= size(), "reading past the end of a spool file");
    flush();
    char* cursor = static_cast<char*>(bytes);
    while (byteCount > 0) {
        const ssize_t got = ::pread(descriptor_, cursor, byteCount, static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) fail("reading", got < 0 ? errno : EIO);
        cursor += got;
        offset += static_cast<std::uint64_t>(got);
        byteCount -= static_cast<std::size_t>(got);
    }
}

void SpoolFile::flush()
{
    std::string_view rest = pending_;
    while (!rest.empty()) {
        const ssize_t written =
            ::pwrite(descriptor_, rest.data(), rest.size(), static_cast<off_t>(flushed_));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) fail("writing", written < 0 ? errno : ENOSPC);
        rest.remove_prefix(static_cast<std::size_t>(written));
        flushed_ += static_cast<std::uint64_t>(written);
    }
    pending_.clear();
}

void SpoolFile::fail(const char* what, int errorNumber) const
{
    throw Error(ErrorKind::inputOutput, std::string(what) + " a temporary file in \"" +
                                            folder_.string() +
                                            "\" failed: " + std::strerror(errorNumber));
}

}  // namespace scree
