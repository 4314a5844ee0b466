// A line that says what it is; the hash of the start; how many moments there are of how many
// bodies, and 13 numbers for each body of each; how long the state is as a frame file, and that;
// the hash of all before it.
#include "tools/settle_checkpoint.h"

#include <fstream>
#include <span>
#include <string>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "io/byte_cursor.h"
#include "io/byte_order.h"
#include "io/file_bytes.h"
#include "io/motion_record.h"

namespace scree {
namespace {

constexpr std::string_view kTitle = "scree settle 1\n";

BodyMotion motionOf(const MotionRecord& record)
{
    BodyMotion motion;
    readMotion(record, motion.position, motion.orientation, motion.velocity,
               motion.angularMomentum);
    return motion;
}

}  // namespace

std::filesystem::path checkpointBeside(const std::filesystem::path& output)
{
    return output.string() + ".checkpoint";
}

void refuseForeignCheckpoint(const std::filesystem::path& path)
{
    if (!isThere(path)) return;
    std::string title(kTitle.size(), '\0');
    std::ifstream(path, std::ios::binary)
        .read(title.data(), static_cast<std::streamsize>(title.size()));
    if (title == kTitle) return;
    throw Error(
        ErrorKind::cannotCreate,
        "\"" + path.string() +
            "\" is no checkpoint of scree settle, which would keep its state there: move it "
            "away, or choose another name with -o");
}

void writeCheckpoint(const std::filesystem::path& path, std::uint64_t startHash,
                     const SettleCheckpoint& checkpoint)
{
    std::string bytes(kTitle);
    appendBytes(bytes, startHash);
    appendBytes(bytes, static_cast<std::uint64_t>(checkpoint.past.size()));
    appendBytes(bytes, static_cast<std::uint64_t>(checkpoint.state.motion.size()));
    for (const std::vector<BodyMotion>& moment : checkpoint.past)
        for (const BodyMotion& motion : moment)
            bytes += bytesOf(motionRecord(motion.position, motion.orientation, motion.velocity,
                                          motion.angularMomentum));
    const std::string state = encodeFrame(checkpoint.state);
    appendBytes(bytes, static_cast<std::uint64_t>(state.size()));
    bytes += state;
    appendBytes(bytes, hashText(bytes));
    writeFileBytes(path, bytes);
}

std::optional<SettleCheckpoint> readCheckpoint(const std::filesystem::path& path,
                                               std::uint64_t startHash)
{
    if (!isThere(path)) return {};
    const std::string bytes = readFileBytes(path);
    const auto refuse = [&] {
        throw Error(ErrorKind::inputOutput, {path.string(), 0, 0},
                    "is damaged; without --resume the run begins anew");
    };
    const std::size_t hashBytes = sizeof(std::uint64_t);
    if (bytes.size() < kTitle.size() + hashBytes || !bytes.starts_with(kTitle) ||
        readBytes<std::uint64_t>(bytes, bytes.size() - hashBytes) !=
            hashText(std::string_view(bytes).substr(0, bytes.size() - hashBytes)))
        refuse();
    ByteCursor cursor(std::string_view(bytes).substr(0, bytes.size() - hashBytes), refuse);
    cursor.takeText(kTitle.size());
    if (cursor.take<std::uint64_t>() != startHash)
        throw Error(ErrorKind::badInput,
                    "\"" + path.string() +
                        "\" is of another shot, or an asset or the program has changed since; "
                        "without --resume the run begins anew");
    const auto moments = cursor.take<std::uint64_t>(), bodies = cursor.take<std::uint64_t>();
    SettleCheckpoint checkpoint;
    for (std::uint64_t i = 0; i < moments; ++i) {
        cursor.require(bodies, sizeof(MotionRecord));
        std::vector<MotionRecord> records(bodies);
        cursor.takeInto(std::span(records));
        std::vector<BodyMotion>& moment = checkpoint.past.emplace_back();
        for (const MotionRecord& record : records) moment.push_back(motionOf(record));
    }
    const auto stateBytes = cursor.take<std::uint64_t>();
    checkpoint.state = decodeFrame(cursor.takeText(stateBytes), path);
    if (checkpoint.state.motion.size() != bodies) refuse();
    return checkpoint;
}

}  // namespace scree
