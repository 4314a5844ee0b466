#include "io/take_reader.h"

#include <algorithm>
#include <map>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "io/file_bytes.h"
#include "io/plane_mesh.h"
#include "io/ply_mesh.h"
#include "io/subframes.h"

namespace scree {
namespace {

/// Space left around the outermost body, as a share of its distance from the plane's origin.
constexpr double kPlaneMargin = 0.25;

/// Distance of the farthest point from the asset's origin.
double reach(const SceneMesh& mesh)
{
    double farthest = 0.0;
    for (Eigen::Index i = 0; i < mesh.points.cols(); ++i)
        farthest = std::max(farthest, mesh.points.col(i).norm());
    return farthest;
}

}  // namespace

TakeReader::TakeReader(const std::filesystem::path& folder) : paths_{folder}
{
    if (!std::filesystem::exists(paths_.info()))
        throw Error(ErrorKind::missingInput,
                    "\"" + folder.string() + "\" is no take: it has no take.json");
    info_ = decodeTakeInfo(readFileBytes(paths_.info()), paths_.info());
    frames_ = listFrames(paths_);
}

SceneDescription TakeReader::describe(PlaneSize planes) const
{
    SceneDescription scene;
    scene.name = info_.name;
    scene.framesPerSecond = info_.framesPerSecond;
    scene.metresPerUnit = info_.metresPerUnit;
    scene.zUp = info_.zUp;

    // Read the meshes, each of which must be the one that was simulated.
    std::map<std::string, std::size_t> meshByName;
    for (const TakeShape& shape : info_.shapes) {
        const std::filesystem::path path = paths_.shape(shape.name);
        if (hashText(readFileBytes(path)) != shape.hash)
            throw Error(ErrorKind::inputOutput, {path.string(), 0, 0},
                        "damaged: its hash is not the one in take.json; scree sim with --resume "
                        "writes it again");
        meshByName[shape.name] = scene.meshes.size();
        const TriMesh mesh = readPlyMesh(path);
        scene.meshes.push_back({shape.name, mesh.points, mesh.triangles, mesh.cornerUvs});
    }

    // List the bodies. Planes share a mesh, which is made once it is known how large it must be.
    std::vector<std::size_t> planeMeshes;
    for (const TakeBody& body : info_.bodies) {
        if (body.isPlane && !meshByName.contains(body.shape)) {
            meshByName[body.shape] = scene.meshes.size();
            planeMeshes.push_back(scene.meshes.size());
            scene.meshes.push_back(makePlaneMesh(body.shape, 0.0));
        }
        const auto mesh = meshByName.find(body.shape);
        if (mesh == meshByName.end())
            throw Error(ErrorKind::inputOutput, {paths_.info().string(), 0, 0},
                        "damaged: no shape \"" + body.shape + "\" for body \"" + body.name + "\"");
        scene.bodies.push_back({body.name, mesh->second, body.material, body.mass,
                                body.kind != BodyKind::fixed, info_.firstFrame, body.isVisible});
    }
    tellBirths(scene);
    const bool isSized = planes == PlaneSize::ofAction && !planeMeshes.empty();
    const double half = isSized ? planeHalfWidth(scene) : 1.0;
    for (const std::size_t mesh : planeMeshes)
        scene.meshes[mesh] = makePlaneMesh(scene.meshes[mesh].name, half);

    // Say how it looks and from where it is seen.
    scene.materials = info_.materials;
    scene.cameras = info_.cameras;
    scene.aspect = static_cast<double>(info_.pictureSize[0]) / info_.pictureSize[1];
    return scene;
}

SceneFrame TakeReader::readFrame(int frame) const
{
    return readState(frame).scene;
}

void TakeReader::forWholeFrames(const std::vector<int>& numbers,
                                const std::function<void(int, const SceneFrame&)>& visit) const
{
    for (const int number : numbers) {
        SceneFrame frame;
        try {
            frame = readFrame(number);
        } catch (const Error&) {
            continue;
        }
        visit(number, frame);
    }
}

std::vector<SceneFrame> TakeReader::readSamples(int frame) const
{
    // Samples before a frame are kept with it, those after it with the next one.
    const FrameState here = readState(frame);
    const bool looksAhead =
        offsets().back() > 0.0 && std::filesystem::exists(paths_.frame(frame + 1));
    const FrameState next = looksAhead ? readState(frame + 1) : FrameState();

    std::vector<SceneFrame> samples;
    for (const double offset : offsets()) {
        const FrameState& keeper = offset > 0.0 ? next : here;
        const double instant = offset > 0.0 ? offset : 1.0 + offset;
        const auto kept =
            std::find_if(keeper.between.begin(), keeper.between.end(),
                         [&](const SceneFrame& sample) { return sample.offset == instant; });
        if (offset == 0.0)
            samples.push_back(here.scene);
        else if (kept != keeper.between.end())
            samples.push_back(*kept);
        else
            samples.push_back(coasted(here.scene, offset / info_.framesPerSecond));
        samples.back().frame = frame;
        samples.back().offset = offset;
    }
    return samples;
}

std::map<int, std::string> TakeReader::damagedFrames(const std::function<void()>& beforeFrame) const
{
    std::map<int, std::string> damaged;
    for (const int frame : frames_) {
        if (beforeFrame) beforeFrame();
        try {
            readState(frame);
        } catch (const Error& problem) {
            damaged[frame] = problem.what();
        }
    }
    return damaged;
}

FrameState TakeReader::readState(int frame) const
{
    const std::filesystem::path path = paths_.frame(frame);
    if (!std::filesystem::exists(path))
        throw Error(ErrorKind::missingInput, "frame " + std::to_string(frame) + " is not in \"" +
                                                 paths_.root.string() + "\"");
    FrameState state = readFrameFile(path, frame);
    if (state.shotHash != info_.shotHash || state.motion.size() != info_.bodies.size())
        throw Error(ErrorKind::inputOutput, {path.string(), 0, 0}, "is a frame of another take");
    return state;
}

/// The last frame knows of everyone when he was born.
void TakeReader::tellBirths(SceneDescription& scene) const
{
    for (auto number = frames_.rbegin(); number != frames_.rend(); ++number) {
        FrameState state;
        try {
            state = readState(*number);
        } catch (const Error&) {
            continue;  // whoever wants this very frame is told that it is damaged
        }
        for (std::size_t body = 0; body < state.bornAt.size(); ++body) {
            const std::int32_t bornAt = state.bornAt[body];
            scene.bodies[body].birthFrame = bornAt < 0 ? kNeverBorn : info_.firstFrame + bornAt;
        }
        return;
    }
}

double TakeReader::planeHalfWidth(const SceneDescription& scene) const
{
    std::vector<double> reaches;
    for (const SceneMesh& mesh : scene.meshes) reaches.push_back(reach(mesh));

    // Take the farthest that any body ever is from any plane's origin.
    double farthest = 0.0;
    forWholeFrames(frames_, [&](int, const SceneFrame& frame) {
        for (std::size_t plane = 0; plane < scene.bodies.size(); ++plane) {
            if (!info_.bodies[plane].isPlane) continue;
            const Vec3& origin = frame.worldFromAsset[plane].position;
            for (std::size_t body = 0; body < scene.bodies.size(); ++body)
                if (!info_.bodies[body].isPlane)
                    farthest =
                        std::max(farthest, (frame.worldFromAsset[body].position - origin).norm() +
                                               reaches[scene.bodies[body].mesh]);
        }
    });
    return farthest > 0.0 ? farthest * (1.0 + kPlaneMargin) : 1.0;
}

}  // namespace scree
