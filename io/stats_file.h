// stats.jsonl as its writer has it: a line for each frame, in their order, and none of a frame that
// is not there.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace scree {

/// Remembers all lines, because a frame in the middle that is simulated again has its line
/// replaced.
class StatsFile {
public:
    /// Reads nothing: a take that begins has no lines, whatever stands there.
    explicit StatsFile(std::filesystem::path path) : path_(std::move(path)) {}

    /// Takes up the lines of those frames that the file has. Those of others go with the next
    /// rewrite().
    void readLinesOf(const std::set<int>& frames);

    bool hasLine(int frame) const { return lines_.contains(frame); }

    /// Lines from elsewhere, for frames that have none; the file has them after rewrite().
    void adopt(const std::map<int, std::string>& lines)
    {
        lines_.insert(lines.begin(), lines.end());
    }

    /// The line of a frame that was simulated, durable when this returns. Throws
    /// Error{cannotCreate} or Error{inputOutput}, and the file is as it was.
    void add(int frame, const std::string& line);

    void rewrite() const;

private:
    std::filesystem::path path_;
    std::map<int, std::string> lines_;  // by frame
};

}  // namespace scree
