#include "io/motion_spool.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/base/check.h"
#include "io/byte_order.h"

namespace scree {

namespace {

/// A sample on disk: position, orientation (x y z w), velocity, angular velocity.
using Record = std::array<double, 13>;

Record recordOf(const Vec3& position, const Quat& orientation, const Vec3& velocity,
                const Vec3& angularVelocity)
{
    Record record;
    double* end = std::copy_n(position.data(), 3, record.data());
    end = std::copy_n(orientation.coeffs().data(), 4, end);
    end = std::copy_n(velocity.data(), 3, end);
    std::copy_n(angularVelocity.data(), 3, end);
    return record;
}

MotionSample sampleOf(const Record& record)
{
    MotionSample sample;
    sample.worldFromAsset.position = Eigen::Map<const Vec3>(record.data());
    sample.worldFromAsset.orientation.coeffs() = Eigen::Map<const Eigen::Vector4d>(&record[3]);
    sample.velocity = Eigen::Map<const Vec3>(&record[7]);
    sample.angularVelocity = Eigen::Map<const Vec3>(&record[10]);
    return sample;
}

}  // namespace

MotionSpool::MotionSpool(const std::filesystem::path& folder, std::vector<std::size_t> bodies,
                         std::size_t blockBytes)
    : bodies_(std::move(bodies)),
      blockBytes_(blockBytes),
      lastOrientation_(bodies_.size(), Quat::Identity()),
      spool_(folder)
{
}

void MotionSpool::append(const SceneFrame& frame)
{
    const double time = frame.frame + frame.offset;
    SCREE_CHECK(times_.empty() || times_.back() < time, "frames out of order");
    times_.push_back(time);
    std::string bytes;
    bytes.reserve(bodies_.size() * sizeof(Record));
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const std::size_t body = bodies_[k];
        Quat orientation = frame.worldFromAsset[body].orientation.normalized();
        if (orientation.dot(lastOrientation_[k]) < 0.0) orientation.coeffs() *= -1.0;
        lastOrientation_[k] = orientation;
        bytes += bytesOf(recordOf(frame.worldFromAsset[body].position, orientation,
                                  frame.velocity[body], frame.angularVelocity[body]));
    }
    spool_.write(bytes);
}

std::vector<MotionSample> MotionSpool::readTime(std::size_t time)
{
    std::vector<Record> records(bodies_.size());
    const std::size_t byteCount = records.size() * sizeof(Record);
    spool_.read(time * byteCount, records.data(), byteCount);
    std::vector<MotionSample> samples(records.size());
    std::transform(records.begin(), records.end(), samples.begin(), sampleOf);
    return samples;
}

void MotionSpool::visitTracks(
    const std::function<void(std::size_t k, std::span<const MotionSample> track)>& visit)
{
    const std::size_t timeCount = times_.size(), bodyCount = bodies_.size();
    if (timeCount == 0) return;
    // Each block reads a piece from every time, so blocks should be few.
    const std::size_t blockBodies =
        std::max<std::size_t>(1, blockBytes_ / (timeCount * sizeof(Record)));
    std::vector<Record> block;
    std::vector<MotionSample> track(timeCount);
    for (std::size_t first = 0; first < bodyCount; first += blockBodies) {
        // Read what the block's bodies do at every time.
        const std::size_t count = std::min(blockBodies, bodyCount - first);
        block.resize(count * timeCount);
        for (std::size_t time = 0; time < timeCount; ++time) {
            spool_.read((time * bodyCount + first) * sizeof(Record), &block[time * count],
                        count * sizeof(Record));
        }

        // Hand it out body by body.
        for (std::size_t k = 0; k < count; ++k) {
            for (std::size_t time = 0; time < timeCount; ++time) {
                track[time] = sampleOf(block[time * count + k]);
            }
            visit(first + k, track);
        }
    }
}

std::vector<std::size_t> neededTimes(
    std::size_t count, const std::function<bool(std::size_t i, std::size_t j)>& isSame)
{
    std::vector<std::size_t> needed;
    bool isConstant = true;
    for (std::size_t i = 0; i < count; ++i) {
        const bool startsRun = i == 0 || !isSame(i - 1, i);
        const bool endsRun = i + 1 == count || !isSame(i, i + 1);
        isConstant = isConstant && (i == 0 || !startsRun);
        if (startsRun || endsRun) needed.push_back(i);
    }
    if (isConstant && count > 1) needed.resize(1);
    return needed;
}

}  // namespace scree
