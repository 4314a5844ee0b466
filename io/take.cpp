#include "io/take.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "core/base/check.h"
#include "core/base/error.h"
#include "core/base/hash.h"
#include "io/build_world.h"
#include "io/file_bytes.h"
#include "io/ply_mesh.h"
#include "io/shot_difference.h"
#include "io/take_reader.h"
#include "io/take_removal.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFramePrefix = "frame.";
constexpr std::string_view kFrameSuffix = ".scree";

TriMesh meshOf(const SceneMesh& mesh)
{
    return {mesh.points, mesh.triangles, mesh.cornerUvs};
}

/// The meshes that a take keeps: all but those of planes, which are as large as the action.
std::vector<const SceneMesh*> keptMeshes(const SceneDescription& scene)
{
    std::vector<const SceneMesh*> kept;
    for (const SceneMesh& mesh : scene.meshes)
        if (!mesh.isPlane) kept.push_back(&mesh);
    return kept;
}

/// The same command as the one that began the take, given again, or one for another branch?
void checkSameBranch(const TakeInfo& info, const TakeBranch& branch, const fs::path& root)
{
    const std::string name = "\"" + root.string() + "\"";
    if (info.branchTake.empty())
        throw Error(
            ErrorKind::badInput,
            name + " was not begun with --from: it goes on without, or -o writes elsewhere");
    if (info.branchFrame != branch.frame)
        throw Error(ErrorKind::badInput,
                    name + " was branched off at frame " + std::to_string(info.branchFrame) +
                        ", not " + std::to_string(branch.frame) + ": -o writes elsewhere");
}

/// But for the mass, which follows from mesh and material.
bool isSame(const TakeBody& a, const TakeBody& b)
{
    return a.name == b.name && a.shape == b.shape && a.isPlane == b.isPlane &&
           a.material == b.material && a.kind == b.kind && a.isVisible == b.isVisible;
}

void createFolder(const fs::path& folder)
{
    std::error_code code;
    fs::create_directories(folder, code);
    if (code)
        throw Error(ErrorKind::cannotCreate,
                    "cannot create the folder \"" + folder.string() + "\": " + code.message());
}

/// The lock goes with the descriptor, so a killed writer leaves none behind. It is of a file,
/// because NFS tells other machines of no lock on a folder, nor of one without leave to write. File
/// systems that know no locks are taken at their word.
int lockTake(const TakePaths& paths)
{
    const int descriptor = ::open(paths.lock().c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0)
        throw Error(
            errno == ENOSPC || errno == EDQUOT ? ErrorKind::inputOutput : ErrorKind::cannotCreate,
            "cannot create \"" + paths.lock().string() + "\": " + std::strerror(errno));
    struct flock whole = {};
    whole.l_type = F_WRLCK;
    whole.l_whence = SEEK_SET;
    if (::fcntl(descriptor, F_OFD_SETLK, &whole) != 0 && (errno == EAGAIN || errno == EACCES)) {
        ::close(descriptor);
        throw Error(ErrorKind::cannotCreate,
                    "\"" + paths.root.string() + "\" is being written by another scree sim");
    }
    return descriptor;
}

/// Appends a line and makes it durable. A write that fails half way is cut back.
void appendLine(const fs::path& path, const std::string& line)
{
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor < 0)
        throw Error(ErrorKind::cannotCreate,
                    "cannot create \"" + path.string() + "\": " + std::strerror(errno));
    const off_t before = ::lseek(descriptor, 0, SEEK_END);
    const std::string bytes = line + "\n";
    // A call that writes a part does not say why: the next one does.
    std::string_view rest = bytes;
    int reason = 0;
    while (!rest.empty() && reason == 0) {
        const ssize_t count = ::write(descriptor, rest.data(), rest.size());
        if (count > 0) rest.remove_prefix(static_cast<std::size_t>(count));
        if (count == 0) reason = ENOSPC;
        if (count < 0 && errno != EINTR) reason = errno;
    }
    const bool written = rest.empty();
    if (!written && ::ftruncate(descriptor, before) != 0) {
        // The cut line is skipped by readers and dropped by the next resume.
    }
    const bool isKept = ::fdatasync(descriptor) == 0;
    if (written && !isKept) reason = errno;
    const bool isClosed = ::close(descriptor) == 0;
    if (written && isKept && !isClosed) reason = errno;
    if (!written || !isKept || !isClosed)
        throw Error(ErrorKind::inputOutput,
                    "writing \"" + path.string() + "\" failed: " + std::strerror(reason));
}

}  // namespace

std::optional<int> frameNumber(const std::string& name)
{
    if (!name.starts_with(kFramePrefix) || !name.ends_with(kFrameSuffix)) return std::nullopt;
    const std::string digits =
        name.substr(kFramePrefix.size(), name.size() - kFramePrefix.size() - kFrameSuffix.size());
    const std::size_t firstDigit = digits.starts_with('-') ? 1 : 0;
    if (digits.size() < firstDigit + 1 || digits.size() > 9 ||
        digits.find_first_not_of("0123456789", firstDigit) != std::string::npos)
        return std::nullopt;
    return std::stoi(digits);
}

fs::path TakePaths::frame(int frame) const
{
    char name[32];
    std::snprintf(name, sizeof name, "frame.%06d.scree", frame);
    return frames() / name;
}

void refuseTakeFile(const fs::path& output)
{
    std::error_code code;
    const fs::path file = fs::weakly_canonical(output, code);
    if (code) return;
    const fs::path folder = file.parent_path();
    const TakePaths here{folder}, above{folder.parent_path()};
    const bool isOfTake =
        (isThere(here.info()) &&
         (file == here.info() || file == here.stats() || file == here.checkpoint())) ||
        (isThere(above.info()) && (folder == above.frames() || folder == above.shapes()));
    if (isOfTake)
        throw Error(ErrorKind::cannotCreate, "cannot write \"" + output.string() +
                                                 "\": it belongs to the take itself, which only "
                                                 "scree sim writes");
}

std::vector<int> listFrames(const TakePaths& paths)
{
    std::vector<int> frames;
    std::error_code code;
    for (const fs::directory_entry& entry : fs::directory_iterator(paths.frames(), code))
        if (const auto frame = frameNumber(entry.path().filename().string()))
            frames.push_back(*frame);
    std::sort(frames.begin(), frames.end());
    return frames;
}

FrameState captureState(const Shot& shot, const World& world, std::vector<SceneFrame> between)
{
    FrameState state;
    state.shotHash = hashText(shot.resolvedText);
    state.clock = world.clock;
    state.motion = world.motion;
    state.order = world.order;
    if (!world.births.empty()) state.bornAt = world.bornAt;
    state.contactMemory = world.contactMemory;
    state.scene = captureFrame(shot, world);
    state.scene.frame = shot.firstFrame + static_cast<int>(world.clock.frame);
    state.between = std::move(between);
    return state;
}

void restoreState(World& world, const FrameState& state)
{
    SCREE_CHECK(state.motion.size() == world.bodyCount(), "the state is of another world");
    world.motion = state.motion;
    world.order = state.order;
    world.clock = state.clock;
    // Who is keyed and who is free follows from the clock; the next step begins with it.
    SCREE_CHECK(state.bornAt.empty() == world.births.empty(), "the state is of another world");
    world.contactMemory = state.contactMemory;
    if (!state.bornAt.empty()) world.restoreBirths(state.bornAt);
}

TakeWriter::TakeWriter(const fs::path& folder, const Shot& shot, const World& world,
                       const std::string& programVersion, ExistingTake existing,
                       const std::optional<TakeBranch>& branch)
    : shot_(shot), paths_{folder}, shotHash_(hashText(shot.resolvedText))
{
    // Look at everything before anything is touched.
    if (branch) refuseBranchOffItself(*branch);
    refuseForeignFiles(paths_);
    refuseToDisturb(existing);
    const bool isTake = holdsTake();
    const bool goesOn = isTake && existing == ExistingTake::resume;
    TakeInfo info = describe(world, programVersion);
    if (branch && !goesOn) recordBranch(*branch, world, info);

    createFolder(folder);
    lock_ = lockTake(paths_);
    try {
        // Whoever was here before the lock may have made a take meanwhile.
        refuseToDisturb(existing);
        if (isTake != holdsTake())
            throw Error(ErrorKind::cannotCreate,
                        "\"" + folder.string() + "\" was written by another scree sim just now");
        removeTemporaries(paths_);
        if (existing == ExistingTake::overwrite) removeTake(paths_);
        if (goesOn)
            resume(world, info, branch);
        else
            start(world, info);
    } catch (...) {
        if (lock_ >= 0) ::close(lock_);
        throw;
    }
}

TakeWriter::~TakeWriter()
{
    if (lock_ >= 0) ::close(lock_);
}

bool TakeWriter::holdsTake() const
{
    return isThere(paths_.info()) || !listFrames(paths_).empty();
}

void TakeWriter::refuseToDisturb(ExistingTake existing) const
{
    if (existing != ExistingTake::refuse) return;
    const std::vector<int> frames = listFrames(paths_);
    const std::string name = "\"" + paths_.root.string() + "\"";
    if (!isThere(paths_.info())) {
        if (frames.empty()) return;
        throw Error(ErrorKind::inputOutput,
                    name +
                        " has frames but no take.json: --resume makes it again if they are of "
                        "this shot, --overwrite begins again, -o writes elsewhere");
    }
    const bool finished = !frames.empty() && frames.back() >= shot_.lastFrame;
    throw Error(ErrorKind::cannotCreate,
                name + (finished ? " holds a finished take: --overwrite replaces it, -o writes "
                                   "elsewhere, --resume checks it and fills gaps"
                                 : " holds an unfinished take: --resume goes on with it, "
                                   "--overwrite begins again"));
}

/// What take.json is to say, but for the branch.
TakeInfo TakeWriter::describe(const World& world, const std::string& programVersion) const
{
    const SceneDescription scene = describeScene(shot_, world, 1.0);
    TakeInfo info = makeTakeInfo(shot_, world, scene, programVersion);
    for (const SceneMesh* mesh : keptMeshes(scene))
        info.shapes.push_back({mesh->name, hashText(encodePlyMesh(meshOf(*mesh)))});
    return info;
}

/// To overwrite it would be to lose what the branch is to begin with.
void TakeWriter::refuseBranchOffItself(const TakeBranch& branch) const
{
    std::error_code code;
    if (!fs::equivalent(branch.take, paths_.root, code) || code) return;
    throw Error(ErrorKind::usage, "--from \"" + branch.take.string() +
                                      "\" is the very take that is to be written: choose another "
                                      "folder with -o");
}

void TakeWriter::recordBranch(const TakeBranch& branch, const World& world, TakeInfo& info)
{
    checkBranch(branch, shot_, world, info);
    if (const std::string jump = jumpAtBranch(branch, shot_, world); !jump.empty())
        notices_.push_back(jump);
    std::error_code code;
    const fs::path absolute = fs::absolute(branch.take, code).lexically_normal();
    info.branchTake = (code ? branch.take : absolute).string();
    info.branchFrame = branch.frame;
    info.branchHash =
        hashText(readBranchFrame(TakeReader(branch.take), branch, branch.frame, shot_));
}

/// The description comes first: from then on a resume knows what this take is to be, whatever
/// instant the writer is killed at, and makes good all that is missing.
void TakeWriter::start(const World& world, const TakeInfo& info)
{
    // What a take that was removed may have left behind must not be taken for this one's.
    std::error_code ignored;
    for (const fs::path& path : {paths_.checkpoint(), paths_.stats()}) fs::remove(path, ignored);
    writeFileBytes(paths_.info(), encodeTakeInfo(info));
    writeShapes(world);
    createFolder(paths_.frames());
    completeBranch(info);
}

void TakeWriter::resume(const World& world, const TakeInfo& now,
                        const std::optional<TakeBranch>& branch)
{
    // Nothing is written before it is proved that shot and take are one: a resume that is refused
    // leaves the take as good as it was.
    TakeInfo info = readInfo(world, now, branch);
    checkSameShot(info, now);
    checkSameCast(info, now);
    if (branch) {
        checkSameBranch(info, *branch, paths_.root);
        info.branchTake = branch->take.string();
    }
    findWholeFrames(world);
    proveStart(world);
    restoreInfo(now, info);
    for (const fs::path& damaged : writeShapes(world))
        notices_.push_back("\"" + damaged.string() + "\" was damaged; it is written again");
    createFolder(paths_.frames());
    // Statistics follow the frames: lines of frames that are gone or damaged go too.
    for (const FrameSummary& summary : readStats(paths_.stats()))
        if (hasFrame(summary.frame)) statsLines_[summary.frame] = summary.line;
    completeBranch(info);
    findCheckpoint(world);
    rewriteStats();
    std::size_t untold = 0;
    for (const int frame : wholeFrames_) untold += !statsLines_.contains(frame);
    if (untold > 0)
        notices_.push_back("\"" + paths_.stats().string() + "\" has no figures for " +
                           std::to_string(untold) +
                           " frames that are there: whether their overlap broke a limit is no "
                           "longer known");
}

/// What take.json says. Lost or unreadable it is made again, if frame by frame up to the last that
/// is there all say that they are of this shot: what might be missing between is not known to be
/// this shot's to simulate.
TakeInfo TakeWriter::readInfo(const World& world, TakeInfo now,
                              const std::optional<TakeBranch>& branch)
{
    const bool isLost = !isThere(paths_.info());
    const std::string text = isLost ? std::string() : readFileBytes(paths_.info());
    if (isJson(text)) return decodeTakeInfo(text, paths_.info());
    const std::string name = "\"" + paths_.info().string() + "\"";
    const std::string found = isLost ? " is missing" : " is damaged";
    int expected = shot_.firstFrame;
    for (const int frame : listFrames(paths_)) {
        const FrameState state = readFrameFile(paths_.frame(frame));
        if (state.shotHash != shotHash_)
            throw Error(ErrorKind::badInput, name + found + ", and frame " + std::to_string(frame) +
                                                 " beside it is of another shot: -o writes "
                                                 "elsewhere, --overwrite begins again");
        if (frame != expected++)
            throw Error(ErrorKind::inputOutput,
                        name + found + ", and so is frame " + std::to_string(expected - 1) +
                            ": put them back, or begin again with --overwrite");
    }
    if (branch) recordBranch(*branch, world, now);
    notices_.push_back(name + (isLost ? " was missing" : " was damaged") +
                       "; it is made again from the shot, which its frames are of");
    return now;
}

void TakeWriter::checkSameShot(const TakeInfo& info, const TakeInfo& now)
{
    const std::string name = "\"" + paths_.root.string() + "\"";
    if (info.shotHash != shotHash_)
        throw Error(
            ErrorKind::badInput,
            name + " was made from another shot: this one has " +
                someDifferences(shotDifferences(now.resolvedShot, info.resolvedShot, "the take")) +
                ". -o writes to another folder, there --from \"" + paths_.root.string() +
                "@FRAME\" begins with this take's frames up to that one; --overwrite begins "
                "anew");
    for (std::size_t i = 0; i < std::min(info.inputs.size(), now.inputs.size()); ++i)
        if (info.inputs[i].hash != now.inputs[i].hash)
            throw Error(ErrorKind::badInput, name + " was made from another \"" +
                                                 now.inputs[i].path +
                                                 "\": the file has changed since");
    if (info.programVersion != now.programVersion)
        notices_.push_back(name + " was begun by scree " + info.programVersion + ", this is " +
                           now.programVersion + ": the bits may differ from an unbroken run");
}

/// What take.json has of bodies and meshes must be what the shot's files make of them now. It may
/// have lost some, and what follows from the shot's text alone.
void TakeWriter::checkSameCast(const TakeInfo& info, const TakeInfo& now) const
{
    const auto refuse = [&](const std::string& what) {
        throw Error(ErrorKind::badInput, "\"" + paths_.root.string() + "\" was made with another " +
                                             what +
                                             ": an asset or the program has changed since. "
                                             "--overwrite begins again, -o writes elsewhere");
    };
    std::map<std::string, std::uint64_t> meshes;
    for (const TakeShape& shape : now.shapes) meshes[shape.name] = shape.hash;
    for (const TakeShape& shape : info.shapes) {
        const auto mesh = meshes.find(shape.name);
        if (mesh == meshes.end() || mesh->second != shape.hash) refuse("mesh '" + shape.name + "'");
    }
    std::map<std::string, const TakeBody*> bodies;
    for (const TakeBody& body : now.bodies) bodies[body.name] = &body;
    for (const TakeBody& body : info.bodies) {
        const auto same = bodies.find(body.name);
        if (same == bodies.end() || same->second->shape != body.shape)
            refuse("body '" + body.name + "'");
    }
}

/// Writes a take.json that is not there or lacks something: a list that lost bodies would be read
/// with frames that hold all of them.
void TakeWriter::restoreInfo(const TakeInfo& now, TakeInfo& info)
{
    const bool hasAll = info.bodies.size() == now.bodies.size() &&
                        info.shapes.size() == now.shapes.size() &&
                        std::ranges::equal(info.bodies, now.bodies, isSame);
    if (hasAll && isThere(paths_.info()) && isJson(readFileBytes(paths_.info()))) return;
    info.bodies = now.bodies;
    info.shapes = now.shapes;
    writeFileBytes(paths_.info(), encodeTakeInfo(info));
    if (hasAll) return;
    notices_.push_back("\"" + paths_.info().string() +
                       "\" named other bodies or meshes than its shot has; the list is put right");
}

/// Those that are there already are compared: a name says nothing of what a file holds. Answers
/// which held something else.
std::vector<fs::path> TakeWriter::writeShapes(const World& world) const
{
    createFolder(paths_.shapes());
    const SceneDescription scene = describeScene(shot_, world, 1.0);
    std::vector<fs::path> replaced;
    for (const SceneMesh* mesh : keptMeshes(scene)) {
        const fs::path path = paths_.shape(mesh->name);
        const std::string bytes = encodePlyMesh(meshOf(*mesh));
        if (isThere(path)) {
            if (readFileBytes(path) == bytes) continue;
            replaced.push_back(path);
        }
        writeFileBytes(path, bytes);
    }
    return replaced;
}

void TakeWriter::findWholeFrames(const World& world)
{
    for (const int frame : listFrames(paths_)) {
        if (frame < shot_.firstFrame || frame > shot_.lastFrame) continue;
        try {
            const FrameState state = readFrameFile(paths_.frame(frame));
            if (state.shotHash != shotHash_ || state.scene.frame != frame ||
                state.motion.size() != world.bodyCount() ||
                state.bornAt.empty() != world.births.empty())
                throw Error(ErrorKind::badInput, {paths_.frame(frame).string(), 0, 0},
                            "is of another take");
            wholeFrames_.insert(frame);
        } catch (const Error& problem) {
            notices_.push_back(std::string(problem.what()) + "; this frame is simulated again");
        }
    }
}

/// This world begins where the take begins, bit for bit.
void TakeWriter::proveStart(const World& world) const
{
    if (!hasFrame(shot_.firstFrame)) return;
    FrameState first = readFrameFile(paths_.frame(shot_.firstFrame));
    first.untold.clear();  // whoever simulates found them out
    if (encodeFrame(first) != encodeFrame(captureState(shot_, world)))
        throw Error(ErrorKind::badInput,
                    "\"" + paths_.root.string() +
                        "\" does not begin where this shot begins: an asset or the program has "
                        "changed since. --overwrite begins again, -o writes elsewhere");
}

/// Frames that another shot simulated cannot be made again by this one: those that are not there,
/// because the copying was interrupted or one was damaged since, are copied from their take.
void TakeWriter::completeBranch(const TakeInfo& info)
{
    if (info.branchTake.empty()) return;
    std::vector<int> missing;
    for (int frame = shot_.firstFrame; frame <= info.branchFrame; ++frame)
        if (!hasFrame(frame)) missing.push_back(frame);
    if (missing.empty()) return;
    try {
        copyBranchFrames(info, missing);
    } catch (const Error& problem) {
        if (problem.kind() != ErrorKind::missingInput && problem.kind() != ErrorKind::badInput)
            throw;
        throw Error(problem.kind(),
                    "frame " + std::to_string(missing.front()) + " of \"" + paths_.root.string() +
                        "\" is missing or damaged, and the take was branched off "
                        "after it: " +
                        problem.what() + "; --from TAKE@" + std::to_string(info.branchFrame) +
                        " says where it stands now, or begins again with "
                        "--overwrite");
    }
}

void TakeWriter::copyBranchFrames(const TakeInfo& info, const std::vector<int>& missing)
{
    const TakeBranch branch{info.branchTake, info.branchFrame};
    const TakeReader from(branch.take);
    if (hashText(readBranchFrame(from, branch, branch.frame, shot_)) != info.branchHash)
        throw Error(ErrorKind::badInput,
                    "\"" + branch.take.string() + "\" is not what it was when the take was begun");
    // Statistics first, as in writeFrame.
    const std::map<int, std::string> lines = readBranchStats(branch);
    for (const int frame : missing)
        if (const auto line = lines.find(frame); line != lines.end()) statsLines_.insert(*line);
    rewriteStats();
    for (const int frame : missing) {
        writeFileBytes(paths_.frame(frame), readBranchFrame(from, branch, frame, shot_));
        wholeFrames_.insert(frame);
    }
}

void TakeWriter::findCheckpoint(const World& world)
{
    if (!isThere(paths_.checkpoint())) return;
    try {
        const FrameState state = readFrameFile(paths_.checkpoint());
        const bool fits = state.shotHash == shotHash_ && state.motion.size() == world.bodyCount();
        if (fits && !hasFrame(state.scene.frame + 1))
            checkpoint_ = state.clock;
        else
            fs::remove(paths_.checkpoint());
    } catch (const Error& problem) {
        std::error_code code;
        if (problem.kind() == ErrorKind::inputOutput) fs::remove(paths_.checkpoint(), code);
        notices_.push_back(std::string(problem.what()) + "; going on from the last whole frame");
    }
}

std::optional<FrameState> TakeWriter::prepareFor(int frame, World& world) const
{
    const std::int64_t previous = frame - 1 - shot_.firstFrame;
    const bool fromCheckpoint = checkpoint_ && checkpoint_->frame == previous;
    const bool standsThere = world.clock.frame == previous &&
                             !(fromCheckpoint && world.clock.subStep < checkpoint_->subStep);
    if (standsThere) return {};
    FrameState state =
        readFrameFile(fromCheckpoint ? paths_.checkpoint() : paths_.frame(frame - 1));
    restoreState(world, state);
    // The samples in a frame's own file lie on the way to it, not from it.
    if (!fromCheckpoint) state.between.clear();
    return state;
}

void TakeWriter::writeFrame(const World& world, const FrameStats& stats,
                            const std::vector<SceneFrame>& between,
                            const std::optional<StepSeen>& lastStep,
                            const std::vector<BodyPair>& untold)
{
    FrameState state = captureState(shot_, world, between);
    state.lastStep = lastStep;
    state.untold = untold;
    SCREE_CHECK(state.scene.frame == stats.frame && world.clock.subStep == 0,
                "a frame is written at its boundary");

    // Statistics first: a line without its frame is dropped by the next resume, a frame without its
    // line would stay so.
    appendStats(stats, world);
    writeFileBytes(paths_.frame(stats.frame), encodeFrame(state));
    wholeFrames_.insert(stats.frame);

    // A checkpoint that led here has done its duty: the frame itself is the place to go on from.
    if (!checkpoint_ || checkpoint_->frame >= world.clock.frame) return;
    std::error_code code;
    fs::remove(paths_.checkpoint(), code);
    checkpoint_.reset();
}

void TakeWriter::writeCheckpoint(const World& world, const std::vector<SceneFrame>& between,
                                 const FrameReport& soFar, const std::vector<BodyPair>& untold)
{
    FrameState state = captureState(shot_, world, between);
    state.soFar = soFar;
    state.untold = untold;
    writeFileBytes(paths_.checkpoint(), encodeFrame(state));
    checkpoint_ = world.clock;
}

std::vector<FrameSummary> TakeWriter::summaries() const
{
    return readStats(paths_.stats());
}

void TakeWriter::appendStats(const FrameStats& stats, const World& world)
{
    const bool isLast = statsLines_.empty() || statsLines_.rbegin()->first < stats.frame;
    statsLines_[stats.frame] = encodeStats(stats, world);
    if (isLast)
        appendLine(paths_.stats(), statsLines_[stats.frame]);
    else
        rewriteStats();
}

void TakeWriter::rewriteStats() const
{
    std::string text;
    for (const auto& [frame, line] : statsLines_) text += line + "\n";
    writeFileBytes(paths_.stats(), text);
}

}  // namespace scree
