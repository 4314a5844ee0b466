#include "core/geometry/surface_rays.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <limits>
#include <new>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/geometry/triangle_distance.h"

namespace scree {
namespace {

/// One device for the process: AVX2 everywhere, the baseline of the build. Never with threads=1,
/// which ties all of the process to one thread; trees are built on one by onOneThread.
RTCDevice sharedDevice()
{
    static const RTCDevice device = rtcNewDevice("isa=avx2,max_isa=avx2");
    return device;
}

/// Embree tells of a lack of memory by a code, if it is asked, and by what it then does not make.
void requireMemory(RTCDevice device, bool isMade)
{
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE || !isMade) throw std::bad_alloc();
}

struct FacingContext {
    RTCIntersectContext base;
    SurfaceRays::Facing facing;
};

/// Rejects triangles that face the wrong way; the ray then goes on.
void keepFacing(const RTCFilterFunctionNArguments* arguments)
{
    const auto* context = reinterpret_cast<const FacingContext*>(arguments->context);
    if (arguments->valid[0] == 0 || context->facing == SurfaceRays::Facing::any) return;
    const auto* ray = reinterpret_cast<const RTCRay*>(arguments->ray);
    const auto* hit = reinterpret_cast<const RTCHit*>(arguments->hit);
    const float along = hit->Ng_x * ray->dir_x + hit->Ng_y * ray->dir_y + hit->Ng_z * ray->dir_z;
    const bool wanted = context->facing == SurfaceRays::Facing::along ? along > 0.0f : along < 0.0f;
    if (!wanted) arguments->valid[0] = 0;
}

/// Hands the triangles around a point to `visit`, and a thousandth more than the reach: the mesh in
/// single precision may lie a little farther.
void visitAround(RTCScene scene, const Vec3& point, double reach, RTCPointQueryFunction visit,
                 void* found)
{
    RTCPointQuery query;
    query.x = static_cast<float>(point.x());
    query.y = static_cast<float>(point.y());
    query.z = static_cast<float>(point.z());
    query.radius = static_cast<float>(reach * 1.001);
    query.time = 0.0f;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene, &query, &context, visit, found);
}

}  // namespace

struct SurfaceRays::Scene {
    RTCScene scene = nullptr;
    TriMesh mesh;

    ~Scene()
    {
        if (scene) rtcReleaseScene(scene);
    }
};

SurfaceRays::SurfaceRays() = default;
SurfaceRays::~SurfaceRays() = default;
SurfaceRays::SurfaceRays(SurfaceRays&&) noexcept = default;
SurfaceRays& SurfaceRays::operator=(SurfaceRays&&) noexcept = default;

SurfaceRays::SurfaceRays(const TriMesh& mesh) : scene_(std::make_unique<Scene>())
{
    const RTCDevice device = sharedDevice();
    requireMemory(device, device != nullptr);
    scene_->mesh = mesh;
    scene_->scene = rtcNewScene(device);
    rtcSetSceneFlags(scene_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_->scene, RTC_BUILD_QUALITY_MEDIUM);

    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.points.cols()));
    auto* corners = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.cols()));
    requireMemory(device, points && corners);
    for (Eigen::Index i = 0; i < mesh.points.size(); ++i) {
        points[i] = static_cast<float>(mesh.points.data()[i]);
    }
    for (Eigen::Index i = 0; i < mesh.triangles.size(); ++i) {
        corners[i] = static_cast<unsigned>(mesh.triangles.data()[i]);
    }
    rtcSetGeometryIntersectFilterFunction(geometry, keepFacing);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_->scene, geometry);
    rtcReleaseGeometry(geometry);
    onOneThread([&] { rtcCommitScene(scene_->scene); });
    requireMemory(device, true);
}

std::optional<SurfaceRays::Hit> SurfaceRays::firstHit(const Vec3& origin, const Vec3& direction,
                                                      double reach, Facing facing) const
{
    // Embree ends the program where a ray begins beyond what it takes for numbers. A step that led
    // there is told of when it is over.
    constexpr double kFarthest = 1e18;
    if (!(origin.array().abs() < kFarthest).all() || !direction.allFinite()) return std::nullopt;

    FacingContext context;
    rtcInitIntersectContext(&context.base);
    context.facing = facing;

    RTCRayHit query;
    query.ray.org_x = static_cast<float>(origin.x());
    query.ray.org_y = static_cast<float>(origin.y());
    query.ray.org_z = static_cast<float>(origin.z());
    query.ray.dir_x = static_cast<float>(direction.x());
    query.ray.dir_y = static_cast<float>(direction.y());
    query.ray.dir_z = static_cast<float>(direction.z());
    query.ray.tnear = 0.0f;
    query.ray.tfar = static_cast<float>(reach);
    query.ray.time = 0.0f;
    query.ray.mask = 0xffffffffu;
    query.ray.id = 0;
    query.ray.flags = 0;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_->scene, &context.base, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

    const int triangle = static_cast<int>(query.hit.primID);
    const TriangleCorners corners = cornersOf(scene_->mesh, triangle);
    const Vec3 normal = corners.areaVector();
    const double along = normal.dot(direction);
    const double distance = along != 0.0 ? normal.dot(corners.a - origin) / along : query.ray.tfar;
    return Hit{triangle, distance};
}

int SurfaceRays::closestTriangle(const Vec3& point, double reach) const
{
    struct Query {
        const TriMesh* mesh;
        Vec3 point;
        double best = std::numeric_limits<double>::infinity();
        int triangle = -1;
    } state{&scene_->mesh, point};

    visitAround(
        scene_->scene, point, reach,
        [](RTCPointQueryFunctionArguments* arguments) {
            auto& found = *static_cast<Query*>(arguments->userPtr);
            const int triangle = static_cast<int>(arguments->primID);
            const Vec3 closest =
                closestOnTriangle(found.point, cornersOf(*found.mesh, triangle)).point;
            const double distance = (found.point - closest).norm();
            if (distance > found.best || (distance == found.best && triangle > found.triangle)) {
                return false;
            }
            found.best = distance;
            found.triangle = triangle;
            // A hair more than the distance: ties must still be visited for the rule above.
            arguments->query->radius = static_cast<float>(distance * (1.0 + 1e-6));
            return true;
        },
        &state);
    SCREE_CHECK(state.triangle >= 0, "no triangle within reach");
    return state.triangle;
}

void SurfaceRays::trianglesWithin(const Vec3& point, double reach,
                                  std::vector<int>& triangles) const
{
    triangles.clear();
    visitAround(
        scene_->scene, point, reach,
        [](RTCPointQueryFunctionArguments* arguments) {
            auto& found = *static_cast<std::vector<int>*>(arguments->userPtr);
            found.push_back(static_cast<int>(arguments->primID));
            return false;  // the reach stays
        },
        &triangles);
    std::sort(triangles.begin(), triangles.end());
}

}  // namespace scree
