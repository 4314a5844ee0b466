// A long run as it can be judged afterwards: poses of every frame and what the frames said of
// themselves, read from a take or recorded as a short shot runs.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/picture/scene_description.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {

/// What is said of a frame, SI.
struct FrameFigures {
    int steps = 0;
    double wallSeconds = 0.0, cpuSeconds = 0.0;
    double kineticEnergy = 0.0, potentialEnergy = 0.0, pushOutWork = 0.0;  ///< [J]
};

struct HeapRecord {
    SceneDescription scene;
    std::vector<SceneFrame> frames;     ///< from the first on, without a gap
    std::vector<FrameFigures> figures;  ///< parallel to frames
    int framesOfShot = 0;               ///< how many there should be

    bool isComplete() const { return static_cast<int>(frames.size()) == framesOfShot; }
    /// Index of the first of the last `seconds`.
    std::size_t lastPart(double seconds) const;
    bool moves(std::size_t body) const { return scene.bodies[body].mass > 0.0; }
};

/// What a take holds so far. Throws as TakeReader does.
HeapRecord readTake(const std::filesystem::path& folder);

/// Runs a shot for so many frames; `look` before each.
HeapRecord recordRun(ShotRun& run, int frames, const std::function<void(int frame)>& look = {});

/// The take of a large shot, shots/NAME.toml, in the context's folder of takes: simulated to its
/// end first if the context may. It holds two frames at least; empty when there is no such take,
/// and the findings say how to make it.
std::optional<HeapRecord> largeTake(const Context& context, const std::string& name,
                                    Findings& findings);
std::filesystem::path folderOfTake(const Context& context, const std::string& name);

/// What to heed a stop with while such a take is judged, which can take as long as to make it.
inline constexpr const char* kTakesAreKept = "the takes of large shots are kept";

/// Speed of the body's origin in the frame, from the pose before [m/s].
double speedOf(const HeapRecord& record, std::size_t frame, std::size_t body);
/// The same of every movable body, ascending.
std::vector<double> speedsAt(const HeapRecord& record, std::size_t frame);

/// The value below which a part of the (ascending) values lies.
double quantile(const std::vector<double>& ascending, double part);

/// Rows that every heap has: frames there, energy that no step may create, and time.
void addCommonRows(const HeapRecord& record, const std::string& name, Weight energyWeight,
                   Findings& findings);

/// Pictures of the take at so many parts of its length, 0 … 1.
void addTakePictures(const Context& context, const std::string& name,
                     const std::vector<double>& parts, bool isWireframe, const std::string& caption,
                     Findings& findings);

}  // namespace scree::verify
