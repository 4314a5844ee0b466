// One path a sample: a ray from the eye, one to a point of the sun's disc, one to a point of the
// sky. What a surface makes of the light is what the rasteriser's shaders make of it (shaders.h),
// so the two engines' pictures can be laid over each other.
//
// Rays are traced one by one: in Embree 3.13.5 packets of 16 occlusion rays marked as coherent do
// not return from scenes with instances. Where a sample goes is a hash of pixel and sample number.
// Positions are measured from the camera's target, so that single precision is enough anywhere.
#include "render/ray_tracer.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/check.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/math/rotation.h"
#include "core/picture/shaded_mesh.h"

namespace scree {
namespace {

constexpr int kLargestEdge = 16384;
constexpr double kLineWidth = 0.9;  // of the wireframe [pixels]

/// AVX2 on every machine and trees built on one thread, for equal bits; our own threads share the
/// rays out.
RTCDevice sharedDevice()
{
    static const RTCDevice device = rtcNewDevice("isa=avx2,max_isa=avx2");
    SCREE_CHECK(device != nullptr, "Embree cannot make a device");
    return device;
}

struct Ray {
    Vec3 origin, direction;  // a unit vector
};

/// What a ray meets first.
struct Hit {
    double distance = 0.0;
    Vec3 point, normal;  // towards the eye
    Vec3 color;
    double roughness = 0.5;
    double haze = 0.0;  // share of the background in front of it
};

struct Plane {
    PlaneSurface surface;
    Mat3 axes;
    std::size_t body = 0;
};

/// Two numbers in 0 … 1 that are spread evenly over the samples of a pixel (Roberts' sequence,
/// moved by a hash of pixel and purpose).
Eigen::Vector2d spread(std::uint64_t pixel, std::uint64_t purpose, int sample)
{
    const double u = randomUnit(pixel, purpose, 0) + 0.7548776662466927 * sample;
    const double v = randomUnit(pixel, purpose, 1) + 0.5698402909980532 * sample;
    return {u - std::floor(u), v - std::floor(v)};
}

/// A direction about `axis`, the more likely the closer: what a matt surface gathers light by.
Vec3 cosineDirection(const Vec3& axis, const Eigen::Vector2d& place)
{
    const double radius = std::sqrt(place.x()), angle = 2.0 * kPi * place.y();
    const Vec3 side = axis.unitOrthogonal();
    return radius * std::cos(angle) * side + radius * std::sin(angle) * axis.cross(side) +
           std::sqrt(std::max(1.0 - place.x(), 0.0)) * axis;
}

Vec3 mixed(const Vec3& a, const Vec3& b, double share)
{
    return (1.0 - share) * a + share * b;
}

/// The shaders' microfacet highlight.
double highlight(const Vec3& n, const Vec3& v, const Vec3& toSun, double facing, double roughness)
{
    const Vec3 h = (v + toSun).normalized();
    const double alpha = std::max(roughness * roughness, 0.02), a2 = alpha * alpha;
    const double nh = std::max(n.dot(h), 0.0), nv = std::max(n.dot(v), 0.05);
    const double vh = std::max(v.dot(h), 0.0), lobe = nh * nh * (a2 - 1.0) + 1.0, k = 0.5 * alpha;
    const double masking = 0.25 / ((nv * (1.0 - k) + k) * (facing * (1.0 - k) + k));
    const double fresnel = 0.04 + 0.96 * std::pow(1.0 - vh, 5.0);
    return std::min(a2 / (kPi * lobe * lobe) * masking * fresnel, 4.0);
}

}  // namespace

class RayTracer::Tracer {
public:
    Tracer(const SceneDescription& scene, const std::vector<Look>& looks,
           const TraceSettings& settings);
    ~Tracer();
    Tracer(const Tracer&) = delete;
    Tracer& operator=(const Tracer&) = delete;

    void setLooks(const std::vector<Look>& looks)
    {
        SCREE_CHECK(looks.size() == bodyMesh_.size(), "one look per body is needed");
        looks_ = looks;
    }
    Image draw(const SceneFrame& frame, const Camera& camera, int width, int height, int ofMix);

private:
    /// What all rays of a picture share.
    struct View {
        Vec3 origin, eye, right, up, forward;  // right and up reach to the picture's border
        double distance = 1.0, spacing = 1.0;
        int width = 0, height = 0;
        std::vector<Plane> planes;
    };

    void place(const SceneFrame& frame, const Vec3& origin);
    View measure(const SceneFrame& frame, const Camera& camera, int width, int height);
    Ray rayThrough(const View& view, double x, double y) const;
    Vec3 background(const Vec3& direction) const;
    bool isHidden(const Ray& ray, double reach) const;
    std::optional<Hit> firstBody(const View& view, const Ray& ray) const;
    std::optional<Hit> firstPlane(const View& view, const Ray& ray, double x, double y) const;
    double gridInk(const View& view, const Plane& plane, const Vec3& point, double x,
                   double y) const;
    Vec3 colorOf(const View& view, std::uint64_t pixel, int sample, double x, double y) const;
    Vec3 shaded(const View& view, const Hit& hit, std::uint64_t pixel, int sample) const;

    TraceSettings settings_;
    std::vector<Look> looks_;
    Vec3 up_, towardSun_;
    double typicalRadius_ = 1.0;
    std::vector<ShadedMesh> meshes_;         // empty for planes
    std::vector<char> isPlaneMesh_;          // parallel to meshes_
    std::vector<PlaneSurface> planeMeshes_;  // likewise
    std::vector<std::size_t> bodyMesh_;
    std::vector<int> seenFrom_;  // parallel to bodyMesh_
    std::vector<Mat3> turns_;    // of the bodies in the present picture
    std::vector<RTCScene> meshScenes_;
    RTCScene scene_ = nullptr;
    std::vector<RTCGeometry> instances_;  // parallel to the bodies; null for planes
};

RayTracer::Tracer::Tracer(const SceneDescription& scene, const std::vector<Look>& looks,
                          const TraceSettings& settings)
    : settings_(settings), looks_(looks), up_(upOf(scene)), towardSun_(sunOf(scene, settings))
{
    SCREE_CHECK(looks.size() == scene.bodies.size(), "one look per body is needed");
    const RTCDevice device = sharedDevice();
    std::vector<double> radii;
    for (const SceneMesh& mesh : scene.meshes) {
        isPlaneMesh_.push_back(mesh.isPlane);
        meshes_.push_back(mesh.isPlane ? ShadedMesh{} : shadeMesh(mesh));
        planeMeshes_.push_back(mesh.isPlane ? planeOf(mesh) : PlaneSurface{});
        radii.push_back(meshes_.back().radius);
        meshScenes_.push_back(rtcNewScene(device));
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        const ShadedMesh& drawn = meshes_.back();
        std::copy_n(drawn.points.data()->data(), mesh.isPlane ? 0 : 3 * drawn.points.size(),
                    static_cast<float*>(rtcSetNewGeometryBuffer(
                        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                        drawn.points.size())));
        std::copy(drawn.indices.begin(), drawn.indices.end(),
                  static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
                      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                      3 * sizeof(std::uint32_t), drawn.indices.size() / 3)));
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(meshScenes_.back(), geometry);
        rtcReleaseGeometry(geometry);
        onOneThread([&] { rtcCommitScene(meshScenes_.back()); });
    }
    typicalRadius_ = typicalRadius(scene, radii);

    scene_ = rtcNewScene(device);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST);
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        const std::size_t mesh = scene.bodies[body].mesh;
        bodyMesh_.push_back(mesh);
        seenFrom_.push_back(seenFrom(scene.bodies[body]));
        instances_.push_back(nullptr);
        if (meshes_[mesh].indices.empty()) continue;
        instances_[body] = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instances_[body], meshScenes_[mesh]);
        rtcAttachGeometryByID(scene_, instances_[body], static_cast<unsigned>(body));
    }
    turns_.resize(bodyMesh_.size());
}

RayTracer::Tracer::~Tracer()
{
    for (const RTCGeometry instance : instances_)
        if (instance) rtcReleaseGeometry(instance);
    if (scene_) rtcReleaseScene(scene_);
    for (const RTCScene scene : meshScenes_) rtcReleaseScene(scene);
}

/// Puts the bodies where they are in this frame.
void RayTracer::Tracer::place(const SceneFrame& frame, const Vec3& origin)
{
    for (std::size_t body = 0; body < bodyMesh_.size(); ++body) {
        if (!instances_[body]) continue;
        const Pose& pose = frame.worldFromAsset[body];
        if (frame.frame < seenFrom_[body] || !isFinite(pose)) {
            rtcDisableGeometry(instances_[body]);
            rtcCommitGeometry(instances_[body]);
            continue;
        }
        turns_[body] = pose.orientation.toRotationMatrix();
        std::array<float, 12> rows;  // 3×4
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column)
                rows[4 * row + column] = static_cast<float>(turns_[body](row, column));
            rows[4 * row + 3] = static_cast<float>(pose.position[row] - origin[row]);
        }
        rtcEnableGeometry(instances_[body]);
        rtcSetGeometryTransform(instances_[body], 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, rows.data());
        rtcCommitGeometry(instances_[body]);
    }
    onOneThread([&] { rtcCommitScene(scene_); });
}

RayTracer::Tracer::View RayTracer::Tracer::measure(const SceneFrame& frame, const Camera& camera,
                                                   int width, int height)
{
    View view;
    view.origin = camera.target;
    view.eye = camera.eye - camera.target;
    view.distance = std::max(view.eye.norm(), 1e-6);
    view.spacing = gridSpacing(view.distance);
    view.width = width;
    view.height = height;
    const Mat4 viewAxes = viewFromWorld(camera);
    const double reach = std::tan(camera.fovDegrees * kPi / 360.0);
    view.right = viewAxes.row(0).head<3>().transpose() * (reach * width / height);
    view.up = viewAxes.row(1).head<3>().transpose() * reach;
    view.forward = -viewAxes.row(2).head<3>().transpose();
    for (std::size_t body = 0; body < bodyMesh_.size(); ++body) {
        const Pose& pose = frame.worldFromAsset[body];
        const bool isShown = frame.frame >= seenFrom_[body] && isFinite(pose);
        if (!isPlaneMesh_[bodyMesh_[body]] || !isShown) continue;
        const PlaneSurface& plane = planeMeshes_[bodyMesh_[body]];
        const Vec3 normal = pose.orientation * plane.normal;
        view.planes.push_back(
            {{pose * plane.point - view.origin, normal}, planeAxes(normal), body});
    }
    return view;
}

/// `x` and `y` in pixels from the top left corner.
Ray RayTracer::Tracer::rayThrough(const View& view, double x, double y) const
{
    const Vec3 toPixel = view.forward + (2.0 * x / view.width - 1.0) * view.right +
                         (1.0 - 2.0 * y / view.height) * view.up;
    return {view.eye, toPixel.normalized()};
}

Vec3 RayTracer::Tracer::background(const Vec3& direction) const
{
    const double height = direction.dot(up_);
    return mixed(height > 0.0 ? kZenithColor : kNadirColor, kHorizonColor,
                 std::exp(-3.2 * std::abs(height)));
}

bool RayTracer::Tracer::isHidden(const Ray& ray, double reach) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay query{};
    query.org_x = static_cast<float>(ray.origin.x());
    query.org_y = static_cast<float>(ray.origin.y());
    query.org_z = static_cast<float>(ray.origin.z());
    query.dir_x = static_cast<float>(ray.direction.x());
    query.dir_y = static_cast<float>(ray.direction.y());
    query.dir_z = static_cast<float>(ray.direction.z());
    query.tfar = static_cast<float>(reach);
    query.mask = 0xffffffffu;
    rtcOccluded1(scene_, &context, &query);
    return query.tfar < 0.0f;
}

std::optional<Hit> RayTracer::Tracer::firstBody(const View& view, const Ray& ray) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray.org_x = static_cast<float>(ray.origin.x());
    query.ray.org_y = static_cast<float>(ray.origin.y());
    query.ray.org_z = static_cast<float>(ray.origin.z());
    query.ray.dir_x = static_cast<float>(ray.direction.x());
    query.ray.dir_y = static_cast<float>(ray.direction.y());
    query.ray.dir_z = static_cast<float>(ray.direction.z());
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = 0xffffffffu;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

    const std::size_t body = query.hit.instID[0];
    const ShadedMesh& mesh = meshes_[bodyMesh_[body]];
    const std::uint32_t* corner = mesh.indices.data() + 3 * query.hit.primID;
    const std::array<float, 3> weight = {1.0f - query.hit.u - query.hit.v, query.hit.u,
                                         query.hit.v};
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    for (int k = 0; k < 3; ++k) normal += weight[k] * mesh.normals[corner[k]];
    Vec3 flat = turns_[body] * Vec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
    Hit hit;
    hit.distance = query.ray.tfar;
    hit.point = ray.origin + hit.distance * ray.direction;
    hit.normal = (turns_[body] * normal.cast<double>()).normalized();
    if (flat.dot(ray.direction) > 0.0) hit.normal = -hit.normal;
    hit.color = looks_[body].color;
    hit.roughness = looks_[body].roughness;
    if (settings_.wireframe) {
        // Distance from the nearest side of the triangle, in pixels.
        const double pixel = 2.0 * view.up.norm() * hit.distance / view.height;
        const double twiceArea = flat.norm();
        double nearest = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 3; ++k) {
            const double side =
                (mesh.points[corner[(k + 2) % 3]] - mesh.points[corner[(k + 1) % 3]]).norm();
            nearest = std::min(nearest, weight[k] * twiceArea / std::max(side, 1e-30));
        }
        if (nearest < 0.5 * kLineWidth * pixel) hit.color *= 0.12;
    }
    return hit;
}

/// 1 on a line of the grid, averaged over the pixel: what the shaders do with derivatives is done
/// here with the neighbouring rays.
double RayTracer::Tracer::gridInk(const View& view, const Plane& plane, const Vec3& point, double x,
                                  double y) const
{
    const auto pointBeside = [&](double stepX, double stepY) -> Vec3 {
        const Ray ray = rayThrough(view, x + stepX, y + stepY);
        const double along = plane.surface.normal.dot(ray.direction);
        const double toPlane = plane.surface.normal.dot(plane.surface.point - ray.origin);
        return along < 0.0 ? Vec3(ray.origin + toPlane / along * ray.direction) : point;
    };
    const Vec3 stepX = pointBeside(1.0, 0.0) - point, stepY = pointBeside(0.0, 1.0) - point;
    const auto lines = [&](double spacing, double halfWidth) {
        double ink = 0.0;
        for (const int axis : {0, 2}) {
            const Vec3 direction = plane.axes.col(axis) / spacing;
            const double period = std::fmod(direction.dot(view.origin), kStrongLinePeriod);
            const double cell = direction.dot(point) + period;
            const double blur =
                std::max(std::abs(direction.dot(stepX)) + std::abs(direction.dot(stepY)), 1e-6);
            const double offLine = std::abs(cell - 0.5 - std::floor(cell - 0.5) - 0.5);
            ink = std::max(ink, std::clamp((halfWidth + blur - offLine) / blur, 0.0, 1.0) *
                                    std::min(2.0 * halfWidth / blur, 1.0) *
                                    std::clamp(1.5 - 3.0 * blur, 0.0, 1.0));
        }
        return ink;
    };
    return std::max(0.5 * lines(view.spacing, 0.010),
                    lines(kStrongLinePeriod * view.spacing, 0.0035));
}

std::optional<Hit> RayTracer::Tracer::firstPlane(const View& view, const Ray& ray, double x,
                                                 double y) const
{
    std::optional<Hit> first;
    for (const Plane& plane : view.planes) {
        const double along = plane.surface.normal.dot(ray.direction);
        const double height = plane.surface.normal.dot(ray.origin - plane.surface.point);
        if (!(height > 0.0) || !(along < 0.0)) continue;  // seen from inside the solid, or never
        const double distance = -height / along;
        if ((first && distance >= first->distance) || distance > kHazeEnd * view.distance) continue;
        const Look& look = looks_[plane.body];
        first = Hit{distance,
                    ray.origin + distance * ray.direction,
                    plane.surface.normal,
                    look.color,
                    look.roughness,
                    0.0};
        const double share =
            std::clamp((distance / view.distance - kHazeBegin) / (kHazeEnd - kHazeBegin), 0.0, 1.0);
        first->haze = share * share * (3.0 - 2.0 * share);
        if (settings_.groundLines)
            first->color *= 1.0 - 0.22 * gridInk(view, plane, first->point, x, y);
    }
    return first;
}

Vec3 RayTracer::Tracer::shaded(const View& view, const Hit& hit, std::uint64_t pixel,
                               int sample) const
{
    const Vec3 toEye = (view.eye - hit.point).normalized();
    const Vec3& n = hit.normal;
    const Vec3 lifted = hit.point + 2e-3 * typicalRadius_ * n + 1e-5 * hit.distance * toEye;

    const Eigen::Vector2d onSun = spread(pixel, 1, sample);
    const double width = std::tan(0.5 * settings_.sunDegrees * kPi / 180.0);
    const Vec3 side = towardSun_.unitOrthogonal();
    const double radius = width * std::sqrt(onSun.x()), angle = 2.0 * kPi * onSun.y();
    const Vec3 toSun = (towardSun_ + radius * std::cos(angle) * side +
                        radius * std::sin(angle) * towardSun_.cross(side))
                           .normalized();
    const double facing = std::max(n.dot(towardSun_), 0.0);
    const bool isSunny = facing > 0.0 && n.dot(toSun) > 0.0 &&
                         !isHidden({lifted, toSun}, std::numeric_limits<float>::infinity());
    const double sun = isSunny ? facing : 0.0;

    const Vec3 toSky = cosineDirection(n, spread(pixel, 2, sample));
    const double sky = isHidden({lifted, toSky}, settings_.skyReach * typicalRadius_) ? 0.0 : 1.0;
    const Vec3 ambient = mixed(kGroundLight, kSkyLight, 0.5 + 0.5 * n.dot(up_)) * sky;
    const double grazing = 0.04 + 0.5 * std::pow(1.0 - std::max(n.dot(toEye), 0.0), 4.0);
    const Vec3 reflected = 2.0 * n.dot(toEye) * n - toEye;
    const Vec3 mirrored = background(reflected) * grazing * (1.0 - hit.roughness) * sky;
    return hit.color.cwiseProduct(sun * kSunLight + ambient) + mirrored +
           sun * highlight(n, toEye, towardSun_, facing, hit.roughness) * kSunLight;
}

Vec3 RayTracer::Tracer::colorOf(const View& view, std::uint64_t pixel, int sample, double x,
                                double y) const
{
    const Ray ray = rayThrough(view, x, y);
    std::optional<Hit> hit = firstBody(view, ray);
    const std::optional<Hit> plane = firstPlane(view, ray, x, y);
    if (plane && (!hit || plane->distance < hit->distance)) hit = plane;
    const Vec3 behind = background(ray.direction);
    if (!hit) return tonedForDisplay(behind);
    return tonedForDisplay(mixed(shaded(view, *hit, pixel, sample), behind, hit->haze));
}

Image RayTracer::Tracer::draw(const SceneFrame& frame, const Camera& camera, int width, int height,
                              int ofMix)
{
    SCREE_CHECK(frame.worldFromAsset.size() == bodyMesh_.size(), "a frame of another scene");
    if (width < 1 || height < 1 || width > kLargestEdge || height > kLargestEdge)
        throw Error(ErrorKind::usage, "a picture of " + std::to_string(width) + " x " +
                                          std::to_string(height) + " pixels cannot be drawn");
    place(frame, camera.target);
    const View view = measure(frame, camera, width, height);
    Image image(width, height);
    parallelFor(height, 4, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < width; ++x) {
                const auto pixel = static_cast<std::uint64_t>(y) * width + x;
                Vec3 sum = Vec3::Zero();
                const int first = ofMix * settings_.samples;
                for (int sample = first; sample < first + settings_.samples; ++sample) {
                    const Eigen::Vector2d place = spread(pixel, 0, sample);
                    sum += colorOf(view, pixel, sample, x + place.x(), y + place.y());
                }
                image.set(x, y, (sum / settings_.samples).cast<float>());
            }
        }
    });
    return image;
}

RayTracer::RayTracer(const SceneDescription& scene, const std::vector<Look>& looks,
                     const TraceSettings& settings)
    : tracer_(std::make_unique<Tracer>(scene, looks, settings))
{
}

RayTracer::~RayTracer() = default;

void RayTracer::setLooks(const std::vector<Look>& looks)
{
    tracer_->setLooks(looks);
}

Image RayTracer::draw(const SceneFrame& frame, const Camera& camera, int width, int height,
                      int ofMix)
{
    return tracer_->draw(frame, camera, width, height, ofMix);
}

}  // namespace scree
