#include "io/file_bytes.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "core/base/error.h"
#include "io/atomic_file.h"

namespace scree {

std::string readFileBytes(const std::filesystem::path& path)
{
    if (const std::string obstacle = obstacleTo(path); !obstacle.empty())
        throw Error(ErrorKind::missingInput, {path.string(), 0, 0}, "cannot be read: " + obstacle);
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    std::error_code ignored;
    if (!file || std::filesystem::is_directory(path, ignored))
        throw Error(ErrorKind::missingInput, {path.string(), 0, 0},
                    std::string("cannot be read: ") + std::strerror(file ? EISDIR : errno));
    // As long as it says, and what it has grown by since.
    const std::uintmax_t size = std::filesystem::file_size(path, ignored);
    std::string bytes(ignored ? 0 : size, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    if (file) bytes.append(std::istreambuf_iterator<char>(file), {});
    if (file.bad()) throw Error(ErrorKind::inputOutput, {path.string(), 0, 0}, "reading failed");
    return bytes;
}

bool isThere(const std::filesystem::path& path)
{
    std::error_code code;
    return std::filesystem::exists(path, code);
}

std::string obstacleTo(const std::filesystem::path& path)
{
    std::error_code code;
    const std::filesystem::file_status status = std::filesystem::status(path, code);
    if (!std::filesystem::status_known(status)) return code.message();
    const bool isUsual = !std::filesystem::exists(status) ||
                         std::filesystem::is_regular_file(status) ||
                         std::filesystem::is_directory(status);
    return isUsual ? "" : "it is a pipe or a device, not a file";
}

void writeFileBytes(const std::filesystem::path& path, std::string_view bytes)
{
    AtomicFile file(path);
    file.write(bytes);
    file.commit();
}

}  // namespace scree
