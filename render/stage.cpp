// Light, planes and sizes that all engines share.
#include "render/stage.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace scree {
namespace {

std::string glslConstant(const char* name, const Vec3& value)
{
    char text[160];
    std::snprintf(text, sizeof text, "const vec3 %s = vec3(%.9g, %.9g, %.9g);\n", name, value.x(),
                  value.y(), value.z());
    return text;
}

std::string glslConstant(const char* name, double value)
{
    char text[80];
    std::snprintf(text, sizeof text, "const float %s = %.9g;\n", name, value);
    return text;
}

}  // namespace

double gridSpacing(double distanceToTarget)
{
    return std::pow(10.0, std::floor(std::log10(distanceToTarget / 5.0)));
}

Vec3 upOf(const SceneDescription& scene)
{
    return scene.zUp ? Vec3::UnitZ() : Vec3::UnitY();
}

Vec3 sunOf(const SceneDescription& scene, const StageSettings& settings)
{
    const Vec3 sun = settings.towardSun.normalized();
    return scene.zUp ? Vec3(sun.x(), -sun.z(), sun.y()) : sun;
}

bool isFinite(const Pose& pose)
{
    return pose.position.allFinite() && pose.orientation.coeffs().allFinite();
}

PlaneSurface planeOf(const SceneMesh& mesh)
{
    const Vec3 a = mesh.points.col(mesh.triangles(0, 0)), b = mesh.points.col(mesh.triangles(1, 0)),
               c = mesh.points.col(mesh.triangles(2, 0));
    return {mesh.points.rowwise().mean(), (b - a).cross(c - a).normalized()};
}

Mat3 planeAxes(const Vec3& normal)
{
    Eigen::Index least = 0;
    normal.cwiseAbs().minCoeff(&least);
    const Vec3 u = (Vec3::Unit(least) - normal[least] * normal).normalized();
    Mat3 axes;
    axes << u, normal, u.cross(normal);
    return axes;
}

double typicalRadius(const SceneDescription& scene, const std::vector<double>& meshRadii)
{
    std::vector<double> all, moving;
    for (const SceneBody& body : scene.bodies) {
        const double radius = meshRadii[body.mesh];
        if (!(radius > 0.0) || !body.isVisible) continue;
        all.push_back(radius);
        if (body.moves) moving.push_back(radius);
    }
    std::vector<double>& radii = moving.empty() ? all : moving;
    if (radii.empty()) return 1.0;
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    return *middle;
}

Vec3 tonedForDisplay(const Vec3& light)
{
    Vec3 shown;
    for (int i = 0; i < 3; ++i) {
        const double toned = kFilmGain * light[i] * light[i] / (light[i] + kFilmToe);
        const double over = std::max(toned - kFilmShoulder, 0.0) / (1.0 - kFilmShoulder);
        shown[i] = std::min(toned, kFilmShoulder) + (1.0 - kFilmShoulder) * (1.0 - std::exp(-over));
    }
    return shown;
}

std::string lightConstantsInGlsl()
{
    return glslConstant("kSun", kSunLight) + glslConstant("kZenith", kZenithColor) +
           glslConstant("kHorizon", kHorizonColor) + glslConstant("kNadir", kNadirColor) +
           glslConstant("kSkyLight", kSkyLight) + glslConstant("kGroundLight", kGroundLight) +
           glslConstant("kFilmToe", kFilmToe) + glslConstant("kFilmGain", kFilmGain) +
           glslConstant("kFilmShoulder", kFilmShoulder);
}

}  // namespace scree
