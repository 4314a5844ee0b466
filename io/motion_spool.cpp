#include "io/motion_spool.h"

#include <algorithm>
#include <string>

#include "core/base/check.h"
#include "io/byte_order.h"
#include "io/motion_record.h"

namespace scree {

namespace {

MotionSample sampleOf(const MotionRecord& record)
{
    MotionSample sample;
    readMotion(record, sample.worldFromAsset.position, sample.worldFromAsset.orientation,
               sample.velocity, sample.angularVelocity);
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
    bytes.reserve(bodies_.size() * sizeof(MotionRecord));
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const std::size_t body = bodies_[k];
        Quat orientation = frame.worldFromAsset[body].orientation.normalized();
        if (orientation.dot(lastOrientation_[k]) < 0.0) orientation.coeffs() *= -1.0;
        lastOrientation_[k] = orientation;
        bytes += bytesOf(motionRecord(frame.worldFromAsset[body].position, orientation,
                                      frame.velocity[body], frame.angularVelocity[body]));
    }
    spool_.write(bytes);
}

std::vector<MotionSample> MotionSpool::readTime(std::size_t time)
{
    std::vector<MotionRecord> records(bodies_.size());
    const std::size_t byteCount = records.size() * sizeof(MotionRecord);
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
        std::max<std::size_t>(1, blockBytes_ / (timeCount * sizeof(MotionRecord)));
    std::vector<MotionRecord> block;
    std::vector<MotionSample> track(timeCount);
    for (std::size_t first = 0; first < bodyCount; first += blockBodies) {
        // Read what the block's bodies do at every time.
        const std::size_t count = std::min(blockBodies, bodyCount - first);
        block.resize(count * timeCount);
        for (std::size_t time = 0; time < timeCount; ++time) {
            spool_.read((time * bodyCount + first) * sizeof(MotionRecord), &block[time * count],
                        count * sizeof(MotionRecord));
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
