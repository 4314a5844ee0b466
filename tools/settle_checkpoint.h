// What a `scree settle` that was stopped leaves beside its output: going on from there gives the
// pose of a run that was never stopped.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/scene/world.h"
#include "io/frame_file.h"

namespace scree {

struct SettleCheckpoint {
    FrameState state;
    /// Where everything was at the ends of the last frames, the oldest first: what is at rest is
    /// seen by how far it has come since.
    std::deque<std::vector<BodyMotion>> past;
};

/// "rings.poses.checkpoint".
std::filesystem::path checkpointBeside(const std::filesystem::path& output);

/// Throws Error{cannotCreate} when a file of somebody else stands there: a checkpoint is replaced,
/// and removed in the end.
void refuseForeignCheckpoint(const std::filesystem::path& path);

/// `startHash` is of the state in which the run began: it tells which shot the checkpoint is of.
/// Throws Error{cannotCreate} or Error{inputOutput}.
void writeCheckpoint(const std::filesystem::path& path, std::uint64_t startHash,
                     const SettleCheckpoint& checkpoint);

/// Nothing when there is none. Throws Error{badInput} when it is of another shot,
/// Error{inputOutput} when it is damaged.
std::optional<SettleCheckpoint> readCheckpoint(const std::filesystem::path& path,
                                               std::uint64_t startHash);

}  // namespace scree
