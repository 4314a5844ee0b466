#include "io/take_branch.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "io/file_bytes.h"
#include "io/frame_stats.h"
#include "io/take_reader.h"
#include "io/text_forms.h"
#include "io/world_state.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const TakeBranch& branch, const std::string& why)
{
    throw Error(ErrorKind::badInput, "cannot branch off \"" + branch.take.string() + "\": " + why +
                                         "; a variant may differ in settings, not in bodies");
}

void requireSameCast(const TakeBranch& branch, const TakeInfo& theirs, const TakeInfo& ours)
{
    if (theirs.framesPerSecond != ours.framesPerSecond || theirs.firstFrame != ours.firstFrame) {
        refuse(branch, "its first frame or frame rate is another");
    }
    if (theirs.bodies.size() != ours.bodies.size()) {
        refuse(branch, "it has " + std::to_string(theirs.bodies.size()) + " bodies, the shot " +
                           std::to_string(ours.bodies.size()));
    }
    for (std::size_t i = 0; i < ours.bodies.size(); ++i) {
        const TakeBody &a = theirs.bodies[i], &b = ours.bodies[i];
        if (a.name != b.name || a.kind != b.kind || a.shape != b.shape) {
            refuse(branch, "its body '" + a.name + "' is not the shot's '" + b.name + "'");
        }
        if (a.mass != b.mass) refuse(branch, "the mass of '" + a.name + "' is another");
    }
    for (const TakeShape& shape : ours.shapes) {
        for (const TakeShape& other : theirs.shapes) {
            if (other.name == shape.name && other.hash != shape.hash) {
                refuse(branch, "the mesh of '" + shape.name + "' is another");
            }
        }
    }
}

/// Its frames are kept as they are, and have to hold what the shot asks of all of them.
void requireSameOutputs(const TakeBranch& branch, const TakeInfo& theirs, const TakeInfo& ours)
{
    const bool lacksPoses = ours.offsets.size() > 1 && theirs.offsets != ours.offsets;
    const bool lacksContacts = ours.hasContacts && !theirs.hasContacts;
    if (!lacksPoses && !lacksContacts) return;
    throw Error(ErrorKind::badInput, "cannot branch off \"" + branch.take.string() +
                                         "\": its frames were kept without the shot's " +
                                         (lacksPoses ? "output.subframes" : "output.contacts") +
                                         "; leave these as they are there, or simulate the shot "
                                         "from its first frame");
}

/// Whether two first frames have the same bodies in the same places, by their bits, and the same of
/// them asleep. What pulls at sleepers is a setting.
bool beginsAlike(FrameState theirs, FrameState ours)
{
    const auto isAsleep = [](const FrameState& state) {
        std::vector<BodyId> asleep;
        for (BodyId body = 0; body < static_cast<BodyId>(state.motion.size()); ++body)
            if (state.contactMemory.isAsleep(body)) asleep.push_back(body);
        return asleep;
    };
    if (isAsleep(theirs) != isAsleep(ours)) return false;
    theirs.shotHash = ours.shotHash;
    theirs.contactMemory = ours.contactMemory;
    theirs.untold.clear();  // whoever simulates found them out
    return encodeFrame(theirs) == encodeFrame(ours);
}

/// The lines of a resolved shot that bodies feel: not how long it is, how it looks and what is
/// written of it.
std::string settingsOf(const std::string& resolvedShot)
{
    const auto beginsWithAny = [](const std::string& line, const auto& beginnings) {
        return std::ranges::any_of(beginnings,
                                   [&](const char* text) { return line.starts_with(text); });
    };
    constexpr std::array kTables{"[[camera]]", "[render]", "[output]"};
    constexpr std::array kKeys{"frames = ", "color = ", "roughness = ", "visible = "};
    std::string settings;
    bool isFelt = true;
    std::istringstream lines(resolvedShot);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("[")) isFelt = !beginsWithAny(line, kTables);
        if (isFelt && !beginsWithAny(line, kKeys)) settings += line + "\n";
    }
    return settings;
}

/// Whoever fell asleep did so under the settings of the other take: on a slope that has become
/// slippery nothing would tell it to move.
void wakeWhoSettled(ContactMemory& memory)
{
    for (BodyRest& rest : memory.rest) {
        const bool waitsSinceTheStart = rest.still.frames == 0;
        if (!rest.isAsleep || waitsSinceTheStart) continue;
        rest.isAsleep = false;
        rest.unbalancedFrames = 0;
        rest.still.frames = rest.nearby.frames = rest.around.frames = 0;
    }
}

void requireSameShot(const TakeBranch& branch, const Shot& shot, const World& world,
                     const TakeInfo& info)
{
    if (!fs::exists(TakePaths{branch.take}.info()))
        throw Error(ErrorKind::missingInput, "cannot branch off \"" + branch.take.string() +
                                                 "\": it is no take, for it has no take.json");
    const TakeReader from(branch.take);
    const TakeInfo& theirs = from.info();
    requireSameCast(branch, theirs, info);
    requireSameOutputs(branch, theirs, info);
    // With the last frame too, all is taken over: a finished take gets another camera or colour.
    if (branch.frame < shot.firstFrame || branch.frame > shot.lastFrame) {
        refuse(branch, "frame " + std::to_string(branch.frame) + " is none of the shot's " +
                           std::to_string(shot.firstFrame) + "-" + std::to_string(shot.lastFrame));
    }
    for (int frame = shot.firstFrame; frame <= branch.frame; ++frame)
        readBranchFrame(from, branch, frame, shot);
    if (!beginsAlike(from.readState(shot.firstFrame), captureState(shot, world)))
        refuse(branch, "its bodies begin elsewhere, with other speeds or seed");
}

/// What to tell of bodies whose keys say that they stand elsewhere when the branch begins than the
/// frame has them: the first step takes them there through whatever is in the way. Empty when all
/// stand right.
std::string jumpAtBranch(const TakeBranch& branch, const Shot& shot, const World& world)
{
    constexpr double kSeen = 1e-3;  // of the body
    const FrameState state = TakeReader(branch.take).readState(branch.frame);
    World then = world;
    then.clock = {branch.frame - shot.firstFrame, 0, 0.0};
    then.frameDuration = 1.0 / shot.framesPerSecond;
    then.assignKinds();
    int jumping = 0;
    double farthest = 0.0;
    std::string name;
    for (BodyId body = 0; body < static_cast<BodyId>(then.bodyCount()); ++body) {
        if (then.info[body].kind != BodyKind::keyed) continue;
        const Pose keyed = then.scriptedPose(body, then.time());
        const double size = then.shapeOf(body).boundingRadius;
        const double way = (keyed.position - state.motion[body].position).norm() +
                           size * keyed.orientation.angularDistance(state.motion[body].orientation);
        if (way <= kSeen * size) continue;
        ++jumping;
        if (way > farthest) name = then.info[body].name;
        farthest = std::max(farthest, way);
    }
    if (jumping == 0) return "";
    const std::string others =
        jumping > 1 ? " (and so do " + std::to_string(jumping - 1) + " more)" : std::string();
    return "'" + name + "'" + others + " stands at frame " + std::to_string(branch.frame) +
           formatted(" %.2g m", farthest) +
           " from where its keys have it: it gets there in one step, through whatever is in its "
           "way";
}

}  // namespace

TakeBranch parseBranch(const std::string& text)
{
    const std::size_t at = text.rfind('@');
    TakeBranch branch;
    if (at != std::string::npos && at > 0) {
        branch.take = text.substr(0, at);
        const char *begin = text.data() + at + 1, *end = text.data() + text.size();
        const auto result = std::from_chars(begin, end, branch.frame);
        if (result.ec == std::errc() && result.ptr == end && begin != end) return branch;
    }
    throw Error(ErrorKind::usage,
                "\"" + text +
                    "\" does not say where to begin: write TAKE@FRAME, for example "
                    "takes/rings_100@1080");
}

void refuseBranchOffItself(const TakeBranch& branch, const fs::path& folder)
{
    std::error_code code;
    if (!fs::equivalent(branch.take, folder, code) || code) return;
    throw Error(ErrorKind::usage, "--from \"" + branch.take.string() +
                                      "\" is the very take that is to be written: choose another "
                                      "folder with -o");
}

void recordBranch(const TakeBranch& branch, const Shot& shot, const World& world, TakeInfo& info,
                  std::vector<std::string>& notices)
{
    requireSameShot(branch, shot, world, info);
    if (const std::string jump = jumpAtBranch(branch, shot, world); !jump.empty())
        notices.push_back(jump);
    std::error_code code;
    const fs::path absolute = fs::absolute(branch.take, code).lexically_normal();
    info.branchTake = (code ? branch.take : absolute).string();
    info.branchFrame = branch.frame;
    info.branchHash =
        hashText(readBranchFrame(TakeReader(branch.take), branch, branch.frame, shot));
}

std::string readBranchFrame(const TakeReader& from, const TakeBranch& branch, int frame,
                            const Shot& shot)
{
    std::error_code code;
    if (!fs::exists(from.paths().frame(frame), code)) {
        throw Error(ErrorKind::missingInput, "\"" + branch.take.string() + "\" has no frame " +
                                                 std::to_string(frame) + " to begin with");
    }
    FrameState state = from.readState(frame);
    state.shotHash = hashText(shot.resolvedText);
    const bool feelsOthers = settingsOf(from.info().resolvedShot) != settingsOf(shot.resolvedText);
    if (frame == branch.frame && feelsOthers) wakeWhoSettled(state.contactMemory);
    return encodeFrame(state);
}

std::map<int, std::string> readBranchStats(const TakeBranch& branch)
{
    std::map<int, std::string> lines;
    for (const FrameSummary& summary : readStats(TakePaths{branch.take}.stats())) {
        if (summary.frame <= branch.frame) lines[summary.frame] = summary.line;
    }
    return lines;
}

}  // namespace scree
