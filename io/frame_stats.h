// stats.jsonl: what each frame of a take cost and how it went, one JSON object a line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/diagnostics/step_report.h"
#include "core/scene/world.h"

namespace scree {

/// What is known of a frame when it is written.
struct FrameStats {
    int frame = 0;
    FrameReport report;
    double wallSeconds = 0.0;
    double cpuSeconds = 0.0;            ///< of all threads
    std::int64_t resumedAtSubStep = 0;  ///< > 0: times cover only the steps after this one
};

/// Takes the figures of the steps of a frame before it was saved into those of the steps after, but
/// for times.
void addEarlier(const FrameReport& earlier, FrameReport& later);

/// The line, without its newline. `world` gives the bodies their names.
std::string encodeStats(const FrameStats& stats, const World& world);

/// What is read back from a line.
struct FrameSummary {
    int frame = 0;
    double wallSeconds = 0.0, cpuSeconds = 0.0;
    int steps = 0;
    std::int64_t contactPairs = 0;
    int bodiesAwake = 0;
    double overlapRatio = 0.0;   ///< worst, of the smaller body's longest box edge; may be infinite
    std::string worstA, worstB;  ///< the bodies of the worst ratio; may be empty
    double kineticEnergy = 0.0;  ///< [J]; may be infinite
    std::string stateHash;       ///< 16 hexadecimal digits
    std::string line;            ///< as it stands in the file
};

/// All lines that can be read, in the order of the file; a line cut by a crash is left out, a
/// missing file is no lines.
std::vector<FrameSummary> readStats(const std::filesystem::path& path);

}  // namespace scree
