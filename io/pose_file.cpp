#include "io/pose_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "io/file_bytes.h"
#include "io/number_text.h"

namespace scree {
namespace {

constexpr int kNumbersPerLine = 7;
constexpr int kMostProblems = 20;

/// Reads the numbers of one line; a problem found is returned as its column and message.
class PoseLine {
public:
    explicit PoseLine(std::string_view line) : line_(line.substr(0, line.find('#'))) {}

    bool isEmpty() const { return line_.find_first_not_of(kSpace) == std::string_view::npos; }

    /// False when the line is not seven finite numbers with a usable orientation.
    bool read(Pose& pose)
    {
        std::array<double, kNumbersPerLine> numbers{};
        int count = 0;
        std::size_t orientationColumn = 1;
        for (std::size_t from = 0;; ++count) {
            from = line_.find_first_not_of(kSpace, from);
            if (from == std::string_view::npos) break;
            const std::size_t to = std::min(line_.find_first_of(kSpace, from), line_.size());
            double number = 0.0;
            if (!readNumber(line_.substr(from, to - from), number)) {
                return refuse(from + 1, "'" + std::string(line_.substr(from, to - from)) +
                                            "' is not a finite number");
            }
            if (count < kNumbersPerLine) numbers[count] = number;
            if (count == 3) orientationColumn = from + 1;
            from = to;
        }
        if (count != kNumbersPerLine) {
            return refuse(1, "the line has " + std::to_string(count) +
                                 " numbers; expected 7: x y z qw qx qy qz");
        }
        pose.position = {numbers[0], numbers[1], numbers[2]};
        if (toOrientation(numbers[3], numbers[4], numbers[5], numbers[6], pose.orientation)) {
            return true;
        }
        return refuse(orientationColumn, "the orientation qw qx qy qz is zero");
    }

    int problemColumn() const { return static_cast<int>(problemColumn_); }
    const std::string& problem() const { return problem_; }

private:
    static constexpr const char* kSpace = " \t\r";

    static bool readNumber(std::string_view word, double& number)
    {
        if (word.starts_with('+')) word.remove_prefix(1);
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        return error == std::errc() && end == word.data() + word.size() && std::isfinite(number);
    }

    bool refuse(std::size_t column, const std::string& problem)
    {
        problemColumn_ = column;
        problem_ = problem;
        return false;
    }

    std::string_view line_;
    std::size_t problemColumn_ = 0;
    std::string problem_;
};

}  // namespace

std::vector<Pose> readPoseFile(const std::string& path, const SourceLocation& where,
                               ProblemList& problems)
{
    std::vector<Pose> poses;
    if (const std::string obstacle = obstacleTo(path); !obstacle.empty()) {
        problems.add(where, "pose file '" + path + "' cannot be reached: " + obstacle,
                     ErrorKind::missingInput);
        return poses;
    }
    if (!std::filesystem::exists(path)) {
        problems.add(where, "pose file '" + path + "' does not exist", ErrorKind::missingInput);
        return poses;
    }
    std::ifstream file(path);
    if (!file || std::filesystem::is_directory(path)) {
        problems.add(where, "pose file '" + path + "' cannot be read");
        return poses;
    }

    std::string line;
    int lineNumber = 0, problemCount = 0;
    while (std::getline(file, line) && problemCount < kMostProblems) {
        // What editors on Windows put before a text in UTF-8.
        if (++lineNumber == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);
        PoseLine poseLine(line);
        if (poseLine.isEmpty()) continue;
        Pose pose;
        if (poseLine.read(pose)) {
            poses.push_back(pose);
        } else {
            problems.add({path, lineNumber, poseLine.problemColumn()}, poseLine.problem());
            ++problemCount;
        }
    }
    if (file.bad()) problems.add(where, "pose file '" + path + "' cannot be read to its end");
    if (poses.empty() && problemCount == 0) {
        problems.add(where, "pose file '" + path + "' has no poses");
    }
    return poses;
}

std::string encodePoseFile(const std::vector<Pose>& poses, const std::string& comment)
{
    std::string text = "# x y z qw qx qy qz of " + comment + "\n";
    for (const Pose& pose : poses) {
        const Vec3& p = pose.position;
        const Quat& q = pose.orientation;
        for (const double number : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}) {
            appendNumber(text, number);
            text += ' ';
        }
        text.back() = '\n';
    }
    return text;
}

bool toOrientation(double w, double x, double y, double z, Quat& orientation)
{
    // Dividing by the largest part first keeps the squares from over- and underflowing.
    constexpr double kShortest = 1e-9;
    const double largest =
        std::max(std::max(std::abs(w), std::abs(x)), std::max(std::abs(y), std::abs(z)));
    orientation = Quat::Identity();
    if (!(largest > kShortest)) return false;
    w /= largest, x /= largest, y /= largest, z /= largest;
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    orientation = Quat(w / length, x / length, y / length, z / length);
    return true;
}

}  // namespace scree
