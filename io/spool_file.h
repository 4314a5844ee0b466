// Bytes set aside on disk while a file is being made that needs them in another order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace scree {

/// Has no name in the folder, so nothing is left of it however the program ends.
class SpoolFile {
public:
    /// In `folder`, which should be where the output will stand: it is the disk that was chosen for
    /// much data. Throws Error{cannotCreate}.
    explicit SpoolFile(const std::filesystem::path& folder);
    ~SpoolFile();

    SpoolFile(const SpoolFile&) = delete;
    SpoolFile& operator=(const SpoolFile&) = delete;

    /// Appends. Throws Error{inputOutput} when the disk refuses, as read() may.
    void write(std::string_view bytes);

    std::uint64_t size() const { return flushed_ + pending_.size(); }

    /// Copies bytes written earlier; the range must lie inside what was appended.
    void read(std::uint64_t offset, void* bytes, std::size_t byteCount);

private:
    void flush();
    [[noreturn]] void fail(const char* what, int errorNumber) const;

    std::filesystem::path folder_;
    int descriptor_ = -1;
    std::uint64_t flushed_ = 0;
    std::string pending_;  // the last bytes, not handed to the system yet
};

}  // namespace scree
