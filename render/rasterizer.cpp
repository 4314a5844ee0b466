// Depths seen from the sun and from the sky are drawn by depth_map.h; OpenGL then makes the
// picture. What is computed for a pixel is in shaders.h; how far each map reaches is in view_fit.h.
//
// A pixel is one point, and its edges are smoothed afterwards (edge_smoothing.h), or the picture is
// drawn at twice the width and height. OpenGL's multisampling was slower than either on a heap of
// 1000 rings: the software rasteriser has no short way for small triangles with several samples.
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
#include <mutex>
#include <string>

#include "core/base/check.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/picture/shaded_mesh.h"
#include "render/depth_map.h"
#include "render/edge_smoothing.h"
#include "render/gl_resources.h"
#include "render/hidden_bodies.h"
#include "render/shaders.h"
#include "render/view_fit.h"

namespace scree {
namespace {

// Texels of the sky's map, of which the near blur is 2.2, and the free margin around the bodies, as
// far as the wide blur reaches: shares of a typical body's radius.
constexpr double kSkyTexelShare = 0.16, kSkyMarginShare = 4.0;
constexpr int kWideBlurStride = 4;  // texels between taps of the wide blur

// Depth a triangle may span over a texel before it shades itself, in texels.
constexpr double kSlopeBias = 1.5;

enum TextureUnit { kShadowUnit, kShadowBoundsUnit, kHeightsUnit, kFilterUnit };

/// A square from -1 to 1 in x and z whose normal is +y.
ShadedMesh unitSquare()
{
    ShadedMesh mesh;
    mesh.points = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
    mesh.normals.assign(4, Eigen::Vector3f::UnitY());
    mesh.indices = {0, 2, 1, 0, 3, 2};
    return mesh;
}

/// From clip space, -1 … 1, to a texture and its depths, 0 … 1.
Mat4 textureFromWorld(const DepthMapFit& fit)
{
    Mat4 half = Mat4::Identity();
    half.topLeftCorner<3, 3>() *= 0.5;
    half.topRightCorner<3, 1>().setConstant(0.5);
    return half * fit.clipFromWorld;
}

}  // namespace

// ---------------------------------------------------------------------------------- the rasteriser

class Rasterizer::Context {
public:
    Context(const SceneDescription& scene, const std::vector<Look>& looks,
            const RasterSettings& settings);
    ~Context()
    {
        const std::lock_guard lock(mesaLock());
        OSMesaDestroyContext(mesa_);
    }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    void setLooks(const std::vector<Look>& looks)
    {
        SCREE_CHECK(looks.size() == looks_.size(), "one look per body is needed");
        looks_ = looks;
    }
    Image draw(const SceneFrame& frame, const Camera& camera, int width, int height);

private:
    /// An infinite plane of the scene, in the frame of its asset.
    struct PlaneBody {
        std::size_t body = 0;
        PlaneSurface surface;
    };

    struct Placed {
        std::size_t mesh = 0, body = 0;
    };

    /// All that is known of a picture before the first pass.
    struct View {
        Vec3 origin = Vec3::Zero();        // world place of the camera's target
        Camera camera;                     // from here on, lengths are measured from the origin
        std::vector<Placed> placed;        // all bodies that are shown but planes
        std::vector<PlacedMesh> bodies;    // parallel to placed
        std::vector<Ball> balls;           // parallel to placed
        std::vector<PlaneSurface> planes;  // parallel to planes_
        double distance = 1.0;             // from eye to target
        Mat4 clipFromWorld, worldFromClip;
        DepthMapFit sun, sky;
    };

    void openMesa();
    void makePrograms();
    void uploadScene(const SceneDescription& scene);

    View measure(const SceneFrame& frame, const Camera& camera, double aspect) const;
    void placeBodies(const View& view, int width, int height);
    void drawBodies() const;
    void drawWires(const View& view) const;
    void drawPlane(std::size_t index, const View& view);
    void drawScreen() const;
    void drawSunDepths(const View& view);
    void drawSkyHeights(const View& view);
    void setLight(const Program& program, const View& view) const;
    void drawPicture(const View& view);
    void averagePoints();
    Image readPicture();
    int useContext();
    Image drawWithMesa(const View& view, int width, int height);

    /// OSMesa's contexts share a screen, and drawing in one while another uploads textures crashed
    /// (Mesa 22.3; a shot of 500 rings whose maps change their size, one run in two). So one at a
    /// time calls it; it draws with several threads, and maps are drawn and PNGs packed meanwhile.
    static std::mutex& mesaLock()
    {
        static std::mutex lock;
        return lock;
    }

    RasterSettings settings_;
    /// A body that is there to be seen, with a pose made of numbers.
    bool isShown(std::size_t body, const SceneFrame& frame) const
    {
        return frame.frame >= seenFrom_[body] && isFinite(frame.worldFromAsset[body]);
    }

    std::vector<Look> looks_;
    std::vector<int> seenFrom_;  // parallel to looks_
    Vec3 up_, towardSun_;
    double typicalRadius_ = 1.0;
    int pointsPerEdge_ = 1;

    OSMesaContext mesa_ = nullptr;
    std::array<std::uint32_t, 16> mesaWindow_{};  // OSMesa insists on one; nothing is drawn into it
    Program bodyProgram_, lineProgram_, planeProgram_, backgroundProgram_, resolveProgram_;
    std::vector<MeshBuffers> meshes_;
    std::vector<ShadedMesh> casters_;  // parallel to meshes_, without normals
    MeshBuffers square_;
    std::vector<PlaneBody> planes_;
    DepthMap depths_;  // scratch
    MapTexture sunDepths_, sunBounds_, heights_;
    PictureTarget picture_;
    std::vector<std::uint8_t> bytes_;  // scratch
};

Rasterizer::Context::Context(const SceneDescription& scene, const std::vector<Look>& looks,
                             const RasterSettings& settings)
    : settings_(settings), looks_(looks)
{
    SCREE_CHECK(looks.size() == scene.bodies.size(), "one look per body is needed");
    SCREE_CHECK(settings.samples == 1 || settings.samples == 4, "samples a pixel: 1 or 4");
    pointsPerEdge_ = settings.samples == 4 ? 2 : 1;
    up_ = upOf(scene);
    towardSun_ = sunOf(scene, settings);
    const std::lock_guard lock(mesaLock());
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
    const std::string light = lightConstantsInGlsl() + shader::kLight;
    const std::string surface = light + shader::kSurfaceLight;
    lineProgram_ = Program(shader::kBodyVertex, shader::kLineFragment);
    bodyProgram_ = Program(shader::kBodyVertex, surface + shader::kBodyFragment);
    planeProgram_ = Program(shader::kBodyVertex, surface + shader::kPlaneFragment);
    backgroundProgram_ = Program(shader::kScreenVertex, light + shader::kBackgroundFragment);
    resolveProgram_ = Program(shader::kScreenVertex, shader::kResolveFragment);
}

void Rasterizer::Context::uploadScene(const SceneDescription& scene)
{
    std::vector<char> isPlaneMesh;
    std::vector<double> radii;
    for (const SceneMesh& mesh : scene.meshes) {
        isPlaneMesh.push_back(mesh.isPlane);
        casters_.push_back(isPlaneMesh.back() ? ShadedMesh{} : shadeMesh(mesh));
        meshes_.push_back(isPlaneMesh.back() ? MeshBuffers{} : uploadMesh(casters_.back()));
        radii.push_back(casters_.back().radius);
    }
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const SceneBody& body = scene.bodies[i];
        seenFrom_.push_back(seenFrom(body));
        if (isPlaneMesh[body.mesh]) {
            if (body.isVisible) planes_.push_back({i, planeOf(scene.meshes[body.mesh])});
            continue;
        }
        meshes_[body.mesh].bodies.push_back(i);
    }
    typicalRadius_ = typicalRadius(scene, radii);
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

    for (std::size_t mesh = 0; mesh < meshes_.size(); ++mesh) {
        for (const std::size_t body : meshes_[mesh].bodies) {
            if (!isShown(body, frame)) continue;
            Pose pose = frame.worldFromAsset[body];
            pose.position -= view.origin;
            view.placed.push_back({mesh, body});
            view.bodies.push_back({&casters_[mesh], pose});
            view.balls.push_back({pose * meshes_[mesh].ball.centre, meshes_[mesh].ball.radius});
        }
    }
    for (const PlaneBody& plane : planes_) {
        const Pose& pose = frame.worldFromAsset[plane.body];
        view.planes.push_back(
            {pose * plane.surface.point - view.origin, pose.orientation * plane.surface.normal});
    }

    const DepthRange range = fitDepth(view.camera, aspect, view.balls, view.planes,
                                      planes_.empty() ? view.distance : kHazeEnd * view.distance);
    const Points visible = visibleCorners(view.camera, aspect, range);
    view.clipFromWorld = clipFromView(view.camera, aspect, range) * viewFromWorld(view.camera);
    view.worldFromClip = view.clipFromWorld.inverse();
    view.sun = fitDepthMap(towardSun_, view.balls, visible, 0.0, 0.0, settings_.shadowTexels);
    view.sky = fitDepthMap(up_, view.balls, visible, kSkyMarginShare * typicalRadius_,
                           kSkyTexelShare * typicalRadius_, settings_.skyTexels);
    return view;
}

/// Hands OpenGL the bodies that can be seen. Nearer ones come first: what they hide is then never
/// shaded.
void Rasterizer::Context::placeBodies(const View& view, int width, int height)
{
    const PictureMap map = mapOfPicture(view.clipFromWorld, width, height);
    clearDepths(depths_, map.size);
    std::vector<std::vector<float>> instances(meshes_.size());
    for (const std::size_t i :
         drawNearToFar(depths_, view.bodies, view.balls, map.clipFromWorld, 0.0)) {
        const Pose& pose = view.bodies[i].worldFromAsset;
        appendInstance(instances[view.placed[i].mesh], pose.orientation.toRotationMatrix(),
                       pose.position, looks_[view.placed[i].body]);
    }
    const std::lock_guard lock(mesaLock());
    for (std::size_t mesh = 0; mesh < meshes_.size(); ++mesh)
        if (!meshes_[mesh].bodies.empty()) uploadInstances(meshes_[mesh], instances[mesh]);
}

void Rasterizer::Context::drawBodies() const
{
    for (const MeshBuffers& mesh : meshes_) {
        (mesh.isClosed ? glEnable : glDisable)(GL_CULL_FACE);
        mesh.draw();
    }
}

/// The edges of all triangles, a little in front of the surfaces they are of.
void Rasterizer::Context::drawWires(const View& view) const
{
    lineProgram_.use();
    lineProgram_.set("clipFromWorld", view.clipFromWorld);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glEnable(GL_POLYGON_OFFSET_LINE);
    glPolygonOffset(-1.0f, -1.0f);
    drawBodies();
    glDisable(GL_POLYGON_OFFSET_LINE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
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
    clearDepths(depths_, view.sun.size);
    drawNearToFar(depths_, view.bodies, view.balls, view.sun.clipFromWorld, kSlopeBias);
    const DepthBounds bounds = boundDepths(depths_);
    const std::lock_guard lock(mesaLock());
    uploadDepths(sunDepths_, depths_);
    uploadBounds(sunBounds_, bounds);
}

/// Depths seen from above, then their moments under a narrow and a wide blur.
void Rasterizer::Context::drawSkyHeights(const View& view)
{
    clearDepths(depths_, view.sky.size);
    drawNearToFar(depths_, view.bodies, view.balls, view.sky.clipFromWorld, 0.0);
    for (const PlaneSurface& plane : view.planes)
        if (plane.normal.dot(view.camera.eye - plane.point) > 0.0)  // else it is not seen either
            drawPlaneDepths(depths_, plane, view.sky.clipFromWorld);
    const DepthMoments near = blurred(momentsOf(depths_), 1);
    const DepthMoments wide = blurred(near, kWideBlurStride);
    const std::lock_guard lock(mesaLock());
    uploadMoments(heights_, near, wide);
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
    program.set("shadowBounds", kShadowBoundsUnit);
    program.set("shadowFromWorld", textureFromWorld(view.sun));
    program.set("shadowTexel", view.sun.texel);
    program.set("heights", kHeightsUnit);
    program.set("skyFromWorld", textureFromWorld(view.sky));
    program.set("skyDepth", view.sky.depth);
    program.set("bodyRadius", typicalRadius_);
}

void Rasterizer::Context::drawPicture(const View& view)
{
    for (const auto& [unit, texture] : {std::pair(kShadowUnit, sunDepths_.texture),
                                        std::pair(kShadowBoundsUnit, sunBounds_.texture),
                                        std::pair(kHeightsUnit, heights_.texture)}) {
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, texture);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, picture_.points);
    glViewport(0, 0, pointsPerEdge_ * picture_.width, pointsPerEdge_ * picture_.height);
    glClear(GL_DEPTH_BUFFER_BIT);

    // Bodies first: they hide much of the planes, and both hide much of the background.
    setLight(bodyProgram_, view);
    drawBodies();
    if (settings_.wireframe) drawWires(view);

    setLight(planeProgram_, view);
    const double spacing = gridSpacing(view.distance), period = kStrongLinePeriod;
    planeProgram_.set("haze", kHazeBegin * view.distance, kHazeEnd * view.distance);
    for (std::size_t i = 0; i < planes_.size(); ++i) {
        const Mat3 axes = planeAxes(view.planes[i].normal);
        const Vec3 u = axes.col(0) / spacing, v = axes.col(2) / spacing;
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

/// Averages the points of each pixel into the framebuffer that is then read.
void Rasterizer::Context::averagePoints()
{
    glActiveTexture(GL_TEXTURE0 + kFilterUnit);
    glBindTexture(GL_TEXTURE_2D, picture_.pointColors);
    glBindFramebuffer(GL_FRAMEBUFFER, picture_.pixels);
    glViewport(0, 0, picture_.width, picture_.height);
    glDisable(GL_DEPTH_TEST);
    resolveProgram_.use();
    resolveProgram_.set("points", kFilterUnit);
    resolveProgram_.set("pointsPerEdge", pointsPerEdge_);
    drawScreen();
}

Image Rasterizer::Context::readPicture()
{
    const int width = picture_.width, height = picture_.height;
    bytes_.resize(static_cast<std::size_t>(width) * height * 4);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, bytes_.data());
    return fromOpenGl(width, height, bytes_);
}

/// Makes the context that of this thread; the longest edge of a target.
int Rasterizer::Context::useContext()
{
    const std::lock_guard lock(mesaLock());
    if (!OSMesaMakeCurrent(mesa_, mesaWindow_.data(), GL_UNSIGNED_BYTE, 4, 4))
        failInOpenGl("cannot use its context");
    GLint largest = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    return largest;
}

/// Everything for which maps and bodies must be uploaded.
Image Rasterizer::Context::drawWithMesa(const View& view, int width, int height)
{
    const std::lock_guard lock(mesaLock());
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    resizePicture(picture_, width, height, pointsPerEdge_);
    drawPicture(view);
    if (pointsPerEdge_ > 1) averagePoints();
    Image image = readPicture();
    const GLenum error = glGetError();
    SCREE_CHECK(error == GL_NO_ERROR, "OpenGL error " + std::to_string(error));
    return image;
}

Image Rasterizer::Context::draw(const SceneFrame& frame, const Camera& camera, int width,
                                int height)
{
    SCREE_CHECK(frame.worldFromAsset.size() == looks_.size(), "a frame of another scene");
    const GLint largest = useContext() / pointsPerEdge_;
    if (width < 1 || height < 1 || width > largest || height > largest)
        throw Error(ErrorKind::usage, "a picture of " + std::to_string(width) + " x " +
                                          std::to_string(height) + " pixels cannot be drawn; the " +
                                          "largest is " + std::to_string(largest) + " x " +
                                          std::to_string(largest));

    const View view = measure(frame, camera, static_cast<double>(width) / height);
    placeBodies(view, pointsPerEdge_ * width, pointsPerEdge_ * height);
    drawSunDepths(view);
    drawSkyHeights(view);
    Image image = drawWithMesa(view, width, height);
    if (pointsPerEdge_ == 1 && settings_.smoothEdges) smoothEdges(image);
    return image;
}

Rasterizer::Rasterizer(const SceneDescription& scene, const std::vector<Look>& looks,
                       const RasterSettings& settings)
    : context_(std::make_unique<Context>(scene, looks, settings))
{
}

Rasterizer::~Rasterizer() = default;

void Rasterizer::setLooks(const std::vector<Look>& looks)
{
    context_->setLooks(looks);
}

Image Rasterizer::draw(const SceneFrame& frame, const Camera& camera, int width, int height,
                       int /*ofMix*/)
{
    return context_->draw(frame, camera, width, height);
}

}  // namespace scree
