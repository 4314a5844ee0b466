// A file that appears under its name complete or not at all. What is written goes to a temporary
// name in the same folder; commit() makes it durable and renames it. A crash or a full disk leaves
// what stood there before untouched.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace scree {

/// Not a std::ofstream because that can neither sync nor say why it failed. Temporaries are named
/// ".<name>.<process>-<count>.tmp"; one that a killed process left behind is nobody's data and may
/// be deleted by whoever owns the folder, as removeAbandoned() does.
class AtomicFile {
public:
    /// Throws Error{cannotCreate} when nothing can be created beside `target`, or when `target` is
    /// a folder or a device. A symbolic link is followed: the file it names is replaced,
    /// or made where there is none.
    explicit AtomicFile(const std::filesystem::path& target);

    /// Without commit() the temporary is removed.
    ~AtomicFile();

    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Appends. Throws Error{inputOutput} when the disk refuses, here or at a later call: bytes
    /// are collected into large pieces first.
    void write(const void* bytes, std::size_t byteCount);
    void write(std::string_view bytes) { write(bytes.data(), bytes.size()); }

    /// Bytes appended so far: where the next write() goes.
    std::uint64_t size() const { return size_; }

    /// Replaces bytes written earlier; the range must lie inside what was appended.
    void overwrite(std::uint64_t offset, const void* bytes, std::size_t byteCount);

    /// Flushes, syncs file and folder, and gives the file its name. To be called once, last.
    void commit();

    const std::filesystem::path& target() const { return target_; }

private:
    void open();
    void flush();
    void writeAt(std::uint64_t offset, const char* bytes, std::size_t byteCount);
    [[noreturn]] void fail(const char* what, int errorNumber) const;

    std::filesystem::path target_, temporary_;
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
    std::string pending_;  // the last bytes of the file, not handed to the system yet
};

/// Makes the names in a folder, those of renamed files and new folders, survive a power cut;
/// answers 0, or the number of the error. A file system that cannot sync a folder has no better
/// promise to give, so its refusal is none.
int syncFolder(const std::filesystem::path& folder);

/// The folder that a name is in.
std::filesystem::path folderOf(const std::filesystem::path& file);

/// Removes what killed processes left of earlier writes to `target`, which may be a frame pattern:
/// a cache half written is as large as a cache, and nobody sees it. Its process must be gone and,
/// since it may have run on another machine of the farm, an hour must have passed since it wrote.
/// Says how many there were. It reads the folder, so it is asked once for all files of a run.
int removeAbandoned(const std::filesystem::path& target);

/// The same for all targets in a folder whose names a predicate holds for.
int removeAbandonedIn(const std::filesystem::path& folder,
                      const std::function<bool(const std::string& name)>& isTarget);

}  // namespace scree
