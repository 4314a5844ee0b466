// What the benchmarks of a frame tell of a run: milliseconds of each phase, sub-steps and contacts
// per frame, and as its label the state hash of the last.
#pragma once

#include <benchmark/benchmark.h>

#include <array>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <string>

#include "core/diagnostics/step_report.h"

namespace scree::test {

class FrameTally {
public:
    void add(const FrameReport& report)
    {
        ++frames_;
        steps_ += report.steps;
        contacts_ += report.sum.contacts;
        for (std::size_t p = 0; p < seconds_.size(); ++p) seconds_[p] += report.sum.seconds[p];
        stateHash_ = report.stateHash;
    }

    void tell(benchmark::State& state) const
    {
        const auto count = static_cast<double>(frames_);
        state.counters["substeps"] = static_cast<double>(steps_) / count;
        state.counters["contacts"] = static_cast<double>(contacts_) / count;
        for (std::size_t p = 0; p < seconds_.size(); ++p) {
            state.counters[std::string("ms_") + nameOf(static_cast<Phase>(p))] =
                1e3 * seconds_[p] / count;
        }
        std::array<char, 32> hash;
        std::snprintf(hash.data(), hash.size(), "%016" PRIx64, stateHash_);
        state.SetLabel(hash.data());
    }

private:
    std::int64_t frames_ = 0, steps_ = 0, contacts_ = 0;
    PhaseSeconds seconds_{};
    std::uint64_t stateHash_ = 0;
};

/// An iteration is a frame, of 240.
inline void byFrames(benchmark::internal::Benchmark* frames)
{
    frames->Iterations(240)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}

}  // namespace scree::test
