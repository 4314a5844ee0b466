// Four passes make a picture: depths seen from the sun, depths seen from the sky and their blurred
// moments, the picture itself at several points a pixel, and their mean. What a pass computes per
// pixel is in shaders.h; how far each map reaches is in view_fit.h.
//
// Edges are smoothed by drawing at twice the width and height. OpenGL's multisampling shades less
// but took twice as long on a heap of 1000 rings: the software rasteriser has no short way for
// small triangles with several samples, and it left highlights and shadow edges unsmoothed.
//
// All positions given to OpenGL are measured from the camera's target.
#include "render/rasterizer.h"

#define GL_GLEXT_PROTOTYPES 1
#include <GL/osmesa.h>

#include <GL/glext.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "core/base/check.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/scene/shaded_mesh.h"
#include "render/gl_resources.h"
#include "render/shaders.h"
#include "render/view_fit.h"

namespace scree {
namespace {

// Haze on planes begins and ends at these multiples of the distance from eye to target: measured
// from the eye, so that it stands still while the heap moves.
constexpr double kHazeBegin = 1.1, kHazeEnd = 6.0;

// Texels of the sky's map, of which the near blur is 2.2, and the free margin around the bodies, as
// far as the wide blur reaches: shares of a typical body's radius.
constexpr double kSkyTexelShare = 0.16, kSkyMarginShare = 4.0;
constexpr int kWideBlurStride = 4;  // texels between taps of the wide blur

enum TextureUnit { kShadowUnit, kNearHeightsUnit, kWideHeightsUnit, kFilterUnit };

/// A square from -1 to 1 in x and z whose normal is +y.
ShadedMesh unitSquare()
{
    ShadedMesh mesh;
    mesh.points = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
    mesh.normals.assign(4, Eigen::Vector3f::UnitY());
    mesh.indices = {0, 2, 1, 0, 3, 2};
    return mesh;
}

bool isFinite(const Pose& pose)
{
    return pose.position.allFinite() && pose.orientation.coeffs().allFinite();
}

/// Where a plane's square stands and faces, in its asset frame.
PlaneSurface planeOf(const SceneMesh& mesh)
{
    const Vec3 a = mesh.points.col(mesh.triangles(0, 0)), b = mesh.points.col(mesh.triangles(1, 0)),
               c = mesh.points.col(mesh.triangles(2, 0));
    return {mesh.points.rowwise().mean(), (b - a).cross(c - a).normalized()};
}

/// Columns: two directions along the plane, the first as close as can be to a world axis, with the
/// normal between them.
Mat3 planeAxes(const Vec3& normal)
{
    Eigen::Index least = 0;
    normal.cwiseAbs().minCoeff(&least);
    const Vec3 u = (Vec3::Unit(least) - normal[least] * normal).normalized();
    Mat3 axes;
    axes << u, normal, u.cross(normal);
    return axes;
}

/// From clip space, -1 … 1, to a texture and its depths, 0 … 1.
Mat4 textureFromWorld(const DepthMapFit& fit)
{
    Mat4 half = Mat4::Identity();
    half.topLeftCorner<3, 3>() *= 0.5;
    half.topRightCorner<3, 1>().setConstant(0.5);
    return half * fit.clipFromWorld;
}

double median(std::vector<double> values)
{
    if (values.empty()) return 1.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle > 0.0 ? *middle : 1.0;
}

}  // namespace

// ---------------------------------------------------------------------------------- the rasteriser

class Rasterizer::Context {
public:
    Context(const SceneDescription& scene, const std::vector<Look>& looks,
            const RasterSettings& settings);
    ~Context() { OSMesaDestroyContext(mesa_); }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    Image draw(const SceneFrame& frame, const Camera& camera, int width, int height);

private:
    /// An infinite plane of the scene, in the frame of its asset.
    struct PlaneBody {
        std::size_t body = 0;
        PlaneSurface surface;
    };

    /// All that is known of a picture before the first pass.
    struct View {
        Vec3 origin = Vec3::Zero();  // world place of the camera's target
        Camera camera;               // from here on, lengths are measured from the origin
        std::vector<Ball> bodies;
        std::vector<PlaneSurface> planes;  // parallel to planes_
        double distance = 1.0;             // from eye to target
        Mat4 clipFromWorld, worldFromClip;
        DepthMapFit sun, sky;
    };

    void openMesa();
    void makePrograms();
    void uploadScene(const SceneDescription& scene);

    View measure(const SceneFrame& frame, const Camera& camera, double aspect) const;
    void placeBodies(const SceneFrame& frame, const View& view);
    void drawBodies() const;
    void drawPlane(std::size_t index, const View& view);
    void drawScreen() const;
    void drawSunDepths(const View& view);
    void drawSkyHeights(const View& view);
    void blur(const DrawnTexture& source, const DrawnTexture& target, bool readsDepth, int strideX,
              int strideY) const;
    void setLight(const Program& program, const View& view) const;
    void drawPicture(const View& view);
    Image resolve();

    RasterSettings settings_;
    /// A body that is born, with a pose made of numbers.
    bool isShown(std::size_t body, const SceneFrame& frame) const
    {
        return frame.frame >= birthFrames_[body] && isFinite(frame.worldFromAsset[body]);
    }

    std::vector<Look> looks_;
    std::vector<int> birthFrames_;  // parallel to looks_
    Vec3 up_, towardSun_;
    double typicalRadius_ = 1.0;
    int pointsPerEdge_ = 1;

    OSMesaContext mesa_ = nullptr;
    std::array<std::uint32_t, 16> mesaWindow_{};  // OSMesa insists on one; nothing is drawn into it
    Program depthProgram_, blurProgram_, bodyProgram_, planeProgram_, backgroundProgram_,
        resolveProgram_;
    std::vector<MeshBuffers> meshes_;
    MeshBuffers square_;
    std::vector<PlaneBody> planes_;
    DrawnTexture sunDepths_, skyDepths_, blurred_, nearHeights_, wideHeights_;
    PictureTarget picture_;
};

Rasterizer::Context::Context(const SceneDescription& scene, const std::vector<Look>& looks,
                             const RasterSettings& settings)
    : settings_(settings), looks_(looks)
{
    SCREE_CHECK(looks.size() == scene.bodies.size(), "one look per body is needed");
    SCREE_CHECK(settings.samples == 1 || settings.samples == 4, "samples a pixel: 1 or 4");
    pointsPerEdge_ = settings.samples == 4 ? 2 : 1;
    const Vec3 sun = settings.towardSun.normalized();
    up_ = scene.zUp ? Vec3::UnitZ() : Vec3::UnitY();
    towardSun_ = scene.zUp ? Vec3(sun.x(), -sun.z(), sun.y()) : sun;
    openMesa();
    makePrograms();
    uploadScene(scene);
}

void Rasterizer::Context::openMesa()
{
    const std::string threads = std::to_string(threadCount());
    setenv("LP_NUM_THREADS", threads.c_str(), 0);
    // clang-format off
    const std::array<int, 11> attributes = {
        OSMESA_FORMAT, OSMESA_RGBA,
        OSMESA_DEPTH_BITS, 0,
        OSMESA_PROFILE, OSMESA_CORE_PROFILE,
        OSMESA_CONTEXT_MAJOR_VERSION, 3,
        OSMESA_CONTEXT_MINOR_VERSION, 3,
        0};
    // clang-format on
    mesa_ = OSMesaCreateContextAttribs(attributes.data(), nullptr);
    if (!mesa_) failInOpenGl("no context of version 3.3 (is the OSMesa library complete?)");
    if (!OSMesaMakeCurrent(mesa_, mesaWindow_.data(), GL_UNSIGNED_BYTE, 4, 4))
        failInOpenGl("cannot use its context");
}

void Rasterizer::Context::makePrograms()
{
    const std::string light = shader::kLight, surface = light + shader::kSurfaceLight;
    depthProgram_ = Program(shader::kBodyVertex, shader::kDepthFragment);
    blurProgram_ = Program(shader::kScreenVertex, shader::kBlurFragment);
    bodyProgram_ = Program(shader::kBodyVertex, surface + shader::kBodyFragment);
    planeProgram_ = Program(shader::kBodyVertex, surface + shader::kPlaneFragment);
    backgroundProgram_ = Program(shader::kScreenVertex, light + shader::kBackgroundFragment);
    resolveProgram_ = Program(shader::kScreenVertex, shader::kResolveFragment);
}

void Rasterizer::Context::uploadScene(const SceneDescription& scene)
{
    std::vector<char> isPlaneMesh;
    for (const SceneMesh& mesh : scene.meshes) {
        isPlaneMesh.push_back(isPlane(mesh));
        meshes_.push_back(isPlaneMesh.back() ? MeshBuffers{} : uploadMesh(shadeMesh(mesh)));
    }
    std::vector<double> radii, movingRadii;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const SceneBody& body = scene.bodies[i];
        birthFrames_.push_back(body.birthFrame);
        if (isPlaneMesh[body.mesh]) {
            planes_.push_back({i, planeOf(scene.meshes[body.mesh])});
            continue;
        }
        meshes_[body.mesh].bodies.push_back(i);
        radii.push_back(meshes_[body.mesh].ball.radius);
        if (body.moves) movingRadii.push_back(radii.back());
    }
    typicalRadius_ = median(movingRadii.empty() ? radii : movingRadii);
    square_ = uploadMesh(unitSquare());
}

/// Decides what the camera and the two maps have to hold.
Rasterizer::Context::View Rasterizer::Context::measure(const SceneFrame& frame,
                                                       const Camera& camera, double aspect) const
{
    View view;
    view.origin = camera.target;
    view.camera = camera;
    view.camera.eye -= view.origin;
    view.camera.target.setZero();
    view.distance = std::max(view.camera.eye.norm(), 1e-6);

    for (const MeshBuffers& mesh : meshes_) {
        for (const std::size_t body : mesh.bodies) {
            const Pose& pose = frame.worldFromAsset[body];
            if (isShown(body, frame))
                view.bodies.push_back({pose * mesh.ball.centre - view.origin, mesh.ball.radius});
        }
    }
    for (const PlaneBody& plane : planes_) {
        const Pose& pose = frame.worldFromAsset[plane.body];
        view.planes.push_back(
            {pose * plane.surface.point - view.origin, pose.orientation * plane.surface.normal});
    }

    const DepthRange range = fitDepth(view.camera, aspect, view.bodies, view.planes,
                                      planes_.empty() ? view.distance : kHazeEnd * view.distance);
    const Points visible = visibleCorners(view.camera, aspect, range);
    view.clipFromWorld = clipFromView(view.camera, aspect, range) * viewFromWorld(view.camera);
    view.worldFromClip = view.clipFromWorld.inverse();
    view.sun = fitDepthMap(towardSun_, view.bodies, visible, 0.0, 0.0, settings_.shadowTexels);
    view.sky = fitDepthMap(up_, view.bodies, visible, kSkyMarginShare * typicalRadius_,
                           kSkyTexelShare * typicalRadius_, settings_.skyTexels);
    return view;
}

/// Bodies nearer to the camera come first: what they hide is then never shaded.
void Rasterizer::Context::placeBodies(const SceneFrame& frame, const View& view)
{
    std::vector<std::pair<double, std::size_t>> nearToFar;
    std::vector<float> instances;
    for (MeshBuffers& mesh : meshes_) {
        nearToFar.clear();
        for (const std::size_t body : mesh.bodies) {
            const Pose& pose = frame.worldFromAsset[body];
            if (!isShown(body, frame)) continue;
            const Vec3 place = pose * mesh.ball.centre - view.origin;
            nearToFar.emplace_back((place - view.camera.eye).squaredNorm(), body);
        }
        std::sort(nearToFar.begin(), nearToFar.end());
        instances.clear();
        for (const auto& [distance, body] : nearToFar) {
            const Pose& pose = frame.worldFromAsset[body];
            appendInstance(instances, pose.orientation.toRotationMatrix(),
                           pose.position - view.origin, looks_[body]);
        }
        if (!mesh.bodies.empty()) uploadInstances(mesh, instances);
    }
}

void Rasterizer::Context::drawBodies() const
{
    for (const MeshBuffers& mesh : meshes_) {
        (mesh.isClosed ? glEnable : glDisable)(GL_CULL_FACE);
        mesh.draw();
    }
}

/// The triangle that covers the whole picture, for programs made with kScreenVertex.
void Rasterizer::Context::drawScreen() const
{
    glDisable(GL_CULL_FACE);
    glBindVertexArray(square_.vertexArray);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// The square that the haze swallows before its edge, below the eye.
void Rasterizer::Context::drawPlane(std::size_t index, const View& view)
{
    const PlaneSurface& plane = view.planes[index];
    const double height = plane.normal.dot(view.camera.eye - plane.point);
    if (!(height > 0.0)) return;  // seen from inside the solid, or not finite
    Mat3 axes = planeAxes(plane.normal);
    axes.col(0) *= kHazeEnd * view.distance;
    axes.col(2) *= kHazeEnd * view.distance;
    std::vector<float> instance;
    appendInstance(instance, axes, view.camera.eye - height * plane.normal,
                   looks_[planes_[index].body]);
    uploadInstances(square_, instance);
    glEnable(GL_CULL_FACE);
    square_.draw();
}

void Rasterizer::Context::drawSunDepths(const View& view)
{
    resizeDepths(sunDepths_, view.sun.size, true);
    glBindFramebuffer(GL_FRAMEBUFFER, sunDepths_.framebuffer);
    glViewport(0, 0, sunDepths_.size, sunDepths_.size);
    glClear(GL_DEPTH_BUFFER_BIT);
    depthProgram_.use();
    depthProgram_.set("clipFromWorld", view.sun.clipFromWorld);
    glEnable(GL_DEPTH_CLAMP);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.5f, 2.0f);
    drawBodies();
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDisable(GL_DEPTH_CLAMP);
}

/// Depths seen from above, then their moments under a narrow and a wide blur.
void Rasterizer::Context::drawSkyHeights(const View& view)
{
    const int size = view.sky.size;
    resizeDepths(skyDepths_, size, false);
    for (DrawnTexture* target : {&blurred_, &nearHeights_, &wideHeights_})
        resizeMoments(*target, size);
    glBindFramebuffer(GL_FRAMEBUFFER, skyDepths_.framebuffer);
    glViewport(0, 0, size, size);
    glClear(GL_DEPTH_BUFFER_BIT);
    depthProgram_.use();
    depthProgram_.set("clipFromWorld", view.sky.clipFromWorld);
    glEnable(GL_DEPTH_CLAMP);
    drawBodies();
    for (std::size_t i = 0; i < planes_.size(); ++i) drawPlane(i, view);
    glDisable(GL_DEPTH_CLAMP);

    glDisable(GL_DEPTH_TEST);
    blurProgram_.use();
    blur(skyDepths_, blurred_, true, 1, 0);
    blur(blurred_, nearHeights_, false, 0, 1);
    blur(nearHeights_, blurred_, false, kWideBlurStride, 0);
    blur(blurred_, wideHeights_, false, 0, kWideBlurStride);
    glEnable(GL_DEPTH_TEST);
}

void Rasterizer::Context::blur(const DrawnTexture& source, const DrawnTexture& target,
                               bool readsDepth, int strideX, int strideY) const
{
    glActiveTexture(GL_TEXTURE0 + kFilterUnit);
    glBindTexture(GL_TEXTURE_2D, source.texture);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    blurProgram_.set("source", kFilterUnit);
    blurProgram_.set("readsDepth", readsDepth ? 1 : 0);
    blurProgram_.set("stride", strideX, strideY);
    drawScreen();
}

/// Selects a program and tells it of lights and maps.
void Rasterizer::Context::setLight(const Program& program, const View& view) const
{
    program.use();
    program.set("clipFromWorld", view.clipFromWorld);
    program.set("worldFromClip", view.worldFromClip);
    program.set("eye", view.camera.eye);
    program.set("up", up_);
    program.set("toSun", towardSun_);
    program.set("shadowMap", kShadowUnit);
    program.set("shadowFromWorld", textureFromWorld(view.sun));
    program.set("shadowTexel", view.sun.texel);
    program.set("nearHeights", kNearHeightsUnit);
    program.set("wideHeights", kWideHeightsUnit);
    program.set("skyFromWorld", textureFromWorld(view.sky));
    program.set("skyDepth", view.sky.depth);
    program.set("bodyRadius", typicalRadius_);
}

void Rasterizer::Context::drawPicture(const View& view)
{
    for (const auto& [unit, texture] : {std::pair(kShadowUnit, sunDepths_.texture),
                                        std::pair(kNearHeightsUnit, nearHeights_.texture),
                                        std::pair(kWideHeightsUnit, wideHeights_.texture)}) {
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, texture);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, picture_.points);
    glViewport(0, 0, pointsPerEdge_ * picture_.width, pointsPerEdge_ * picture_.height);
    glClear(GL_DEPTH_BUFFER_BIT);

    // Bodies first: they hide much of the planes, and both hide much of the background.
    setLight(bodyProgram_, view);
    drawBodies();

    // Choose lines a power of ten apart, some ten of them across the picture.
    setLight(planeProgram_, view);
    const double spacing = std::pow(10.0, std::floor(std::log10(view.distance / 5.0)));
    planeProgram_.set("haze", kHazeBegin * view.distance, kHazeEnd * view.distance);
    for (std::size_t i = 0; i < planes_.size(); ++i) {
        const Mat3 axes = planeAxes(view.planes[i].normal);
        const Vec3 u = axes.col(0) / spacing, v = axes.col(2) / spacing;
        const double period = 5.0;  // of the stronger lines
        planeProgram_.set("gridU", settings_.groundLines ? u : Vec3(Vec3::Zero()));
        planeProgram_.set("gridV", settings_.groundLines ? v : Vec3(Vec3::Zero()));
        planeProgram_.set("gridOrigin",
                          settings_.groundLines ? std::fmod(u.dot(view.origin), period) : 0.5,
                          settings_.groundLines ? std::fmod(v.dot(view.origin), period) : 0.5);
        drawPlane(i, view);
    }

    setLight(backgroundProgram_, view);
    drawScreen();
}

/// Averages the points of each pixel and turns OpenGL's rows, bottom first, round.
Image Rasterizer::Context::resolve()
{
    const int width = picture_.width, height = picture_.height;
    glActiveTexture(GL_TEXTURE0 + kFilterUnit);
    glBindTexture(GL_TEXTURE_2D, picture_.pointColors);
    glBindFramebuffer(GL_FRAMEBUFFER, picture_.pixels);
    glViewport(0, 0, width, height);
    glDisable(GL_DEPTH_TEST);
    resolveProgram_.use();
    resolveProgram_.set("points", kFilterUnit);
    resolveProgram_.set("pointsPerEdge", pointsPerEdge_);
    drawScreen();
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(width) * height * 4);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());

    Image image(width, height);
    for (int y = 0; y < height; ++y) {
        const std::uint8_t* row =
            bytes.data() + static_cast<std::size_t>(height - 1 - y) * width * 4;
        for (int x = 0; x < width; ++x, row += 4)
            image.set(x, y, {decodeSrgb(row[0]), decodeSrgb(row[1]), decodeSrgb(row[2])});
    }
    return image;
}

Image Rasterizer::Context::draw(const SceneFrame& frame, const Camera& camera, int width,
                                int height)
{
    SCREE_CHECK(frame.worldFromAsset.size() == looks_.size(), "a frame of another scene");
    if (!OSMesaMakeCurrent(mesa_, mesaWindow_.data(), GL_UNSIGNED_BYTE, 4, 4))
        failInOpenGl("cannot use its context");
    GLint largest = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    largest /= pointsPerEdge_;
    if (width < 1 || height < 1 || width > largest || height > largest)
        throw Error(ErrorKind::usage, "a picture of " + std::to_string(width) + " x " +
                                          std::to_string(height) + " pixels cannot be drawn; the " +
                                          "largest is " + std::to_string(largest) + " x " +
                                          std::to_string(largest));

    const View view = measure(frame, camera, static_cast<double>(width) / height);
    placeBodies(frame, view);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    drawSunDepths(view);
    drawSkyHeights(view);
    resizePicture(picture_, width, height, pointsPerEdge_);
    drawPicture(view);
    Image image = resolve();
    const GLenum error = glGetError();
    SCREE_CHECK(error == GL_NO_ERROR, "OpenGL error " + std::to_string(error));
    return image;
}

Rasterizer::Rasterizer(const SceneDescription& scene, const std::vector<Look>& looks,
                       const RasterSettings& settings)
    : context_(std::make_unique<Context>(scene, looks, settings))
{
}

Rasterizer::~Rasterizer() = default;

Image Rasterizer::draw(const SceneFrame& frame, const Camera& camera, int width, int height)
{
    return context_->draw(frame, camera, width, height);
}

}  // namespace scree
