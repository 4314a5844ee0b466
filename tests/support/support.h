// Where tests find the project's files and a place to write their own.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace scree::test {

/// Absolute path of a file of the source tree.
inline std::filesystem::path sourceFile(const std::string& relative)
{
    return std::filesystem::path(SCREE_SOURCE_DIR) / relative;
}

/// All of a file, read without the code that is tested; empty where there is none.
inline std::string contentOf(const std::filesystem::path& path)
{
    std::ifstream stream(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
}

/// A fresh, empty folder for one test, removed with the object.
class TemporaryFolder {
public:
    TemporaryFolder()
    {
        std::string pattern =
            (std::filesystem::temp_directory_path() / "scree_test_XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

}  // namespace scree::test
