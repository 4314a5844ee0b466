#include "io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <optional>
#include <system_error>

#include "core/base/check.h"
#include "core/base/error.h"
#include "io/frame_pattern.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

[[noreturn]] void refuse(const fs::path& target, const std::string& reason)
{
    throw Error(ErrorKind::cannotCreate, "cannot create \"" + target.string() + "\": " + reason);
}

/// The file that a write to `target` would change; refuses what a rename must not replace.
fs::path resolveTarget(const fs::path& target)
{
    constexpr int kMostLinks = 40;  // as the system has it
    std::error_code code;
    fs::path resolved = target;
    // Link by link: of one that leads nowhere yet, the place it leads to is meant.
    for (int links = 0; fs::is_symlink(resolved, code); ++links) {
        if (links == kMostLinks) refuse(target, std::strerror(ELOOP));
        resolved = resolved.parent_path() / fs::read_symlink(resolved, code);
        if (code) refuse(target, code.message());
    }

    const fs::file_status status = fs::status(resolved, code);
    if (fs::is_directory(status)) refuse(target, "it is a folder");
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        refuse(target, "it is not a plain file");
    }
    return resolved;
}

struct TemporaryName {
    std::string target;  // without its folder
    int process;
};

/// Of ".<target>.<process>-<count>.tmp"; nothing of another name.
std::optional<TemporaryName> readTemporaryName(const std::string& name)
{
    constexpr std::string_view kEnding = ".tmp";
    if (!name.starts_with('.') || !name.ends_with(kEnding)) return std::nullopt;
    const std::size_t dot = name.rfind('.', name.size() - kEnding.size() - 1);
    if (dot == std::string::npos || dot == 0) return std::nullopt;
    int process = 0, end = 0;
    unsigned count = 0;
    std::sscanf(name.c_str() + dot, ".%9d-%9u.tmp%n", &process, &count, &end);
    if (end == 0 || dot + static_cast<std::size_t>(end) != name.size() || process <= 0) {
        return std::nullopt;
    }
    return TemporaryName{name.substr(1, dot - 1), process};
}

}  // namespace

fs::path folderOf(const fs::path& file)
{
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

int syncFolder(const fs::path& folder)
{
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return 0;
    const int reason = ::fsync(descriptor) == 0 ? 0 : errno;
    ::close(descriptor);
    return reason == EIO || reason == ENOSPC || reason == EDQUOT ? reason : 0;
}

AtomicFile::AtomicFile(const fs::path& target) : target_(resolveTarget(target))
{
    if (!target_.has_filename()) refuse(target_, "the path names a folder, not a file");
    open();
    pending_.reserve(kPieceBytes);
}

AtomicFile::~AtomicFile()
{
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    ::unlink(temporary_.c_str());
}

// The count makes names differ inside a process, O_EXCL steps over what an earlier process with our
// number left behind.
void AtomicFile::open()
{
    static std::atomic<unsigned> counter{0};
    const fs::path folder = folderOf(target_);
    do {
        temporary_ =
            folder / ("." + target_.filename().string() + "." + std::to_string(::getpid()) + "-" +
                      std::to_string(counter++) + ".tmp");
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor_ < 0 && errno == EEXIST);
    if (descriptor_ >= 0) return;

    const int reason = errno;
    std::error_code code;
    if (reason == ENOSPC || reason == EDQUOT) fail("writing", reason);
    if (reason == ENOENT && !fs::exists(folder, code)) {
        refuse(target_, "the folder \"" + folder.string() + "\" does not exist");
    }
    refuse(target_, std::strerror(reason));
}

void AtomicFile::write(const void* bytes, std::size_t byteCount)
{
    const char* cursor = static_cast<const char*>(bytes);
    if (pending_.size() + byteCount > kPieceBytes) flush();
    if (byteCount >= kPieceBytes) {
        writeAt(size_, cursor, byteCount);
    } else {
        pending_.append(cursor, byteCount);
    }
    size_ += byteCount;
}

void AtomicFile::overwrite(std::uint64_t offset, const void* bytes, std::size_t byteCount)
{
    SCREE_CHECK(offset + byteCount <= size_, target_.string() + ": overwriting past the end");
    flush();
    writeAt(offset, static_cast<const char*>(bytes), byteCount);
}

void AtomicFile::commit()
{
    SCREE_CHECK(descriptor_ >= 0, target_.string() + ": committed twice");
    flush();
    if (::fsync(descriptor_) != 0) fail("writing", errno);
    const int descriptor = descriptor_;
    descriptor_ = -1;
    const bool closed = ::close(descriptor) == 0;
    if (!closed || ::rename(temporary_.c_str(), target_.c_str()) != 0) {
        const int reason = errno;
        ::unlink(temporary_.c_str());
        fail(closed ? "renaming the finished file to" : "writing", reason);
    }
    if (const int reason = syncFolder(folderOf(target_)); reason != 0)
        fail("making durable the name of", reason);
}

void AtomicFile::flush()
{
    if (pending_.empty()) return;
    writeAt(size_ - pending_.size(), pending_.data(), pending_.size());
    pending_.clear();
}

void AtomicFile::writeAt(std::uint64_t offset, const char* bytes, std::size_t byteCount)
{
    SCREE_CHECK(descriptor_ >= 0, target_.string() + ": written after commit");
    while (byteCount > 0) {
        const ssize_t written = ::pwrite(descriptor_, bytes, byteCount, static_cast<off_t>(offset));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) fail("writing", written < 0 ? errno : ENOSPC);
        bytes += written;
        offset += static_cast<std::uint64_t>(written);
        byteCount -= static_cast<std::size_t>(written);
    }
}

void AtomicFile::fail(const char* what, int errorNumber) const
{
    throw Error(ErrorKind::inputOutput, std::string(what) + " \"" + target_.string() +
                                            "\" failed: " + std::strerror(errorNumber));
}

int removeAbandoned(const fs::path& target)
{
    const std::string name = target.filename().string();
    const bool isPattern = hasFramePattern(name);
    return removeAbandonedIn(folderOf(target), [&](const std::string& other) {
        return isPattern ? frameOf(name, other).has_value() : name == other;
    });
}

int removeAbandonedIn(const fs::path& folder,
                      const std::function<bool(const std::string& name)>& isTarget)
{
    constexpr std::chrono::hours kQuiet{1};
    int removed = 0;
    std::error_code code;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
        const std::optional<TemporaryName> name =
            readTemporaryName(entry.path().filename().string());
        if (!name || !isTarget(name->target)) continue;
        if (::kill(name->process, 0) == 0 || errno != ESRCH) continue;
        std::error_code ignored;
        const auto written = fs::last_write_time(entry.path(), ignored);
        if (ignored || fs::file_time_type::clock::now() - written < kQuiet) continue;
        if (fs::remove(entry.path(), ignored)) ++removed;
    }
    return removed;
}

}  // namespace scree
