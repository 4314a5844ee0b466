// Symbols: h length of the stretch between two keys, s share of it.
#include "core/picture/camera_motion.h"

#include <algorithm>

#include "core/math/monotone_slope.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// Eye, target, up and angle of view as one row of numbers: all go from key to key the same way.
using KeyValues = Eigen::Matrix<double, 10, 1>;

KeyValues valuesOf(const CameraKey& key)
{
    KeyValues values;
    values << key.eye, key.target, key.up, key.fovDegrees;
    return values;
}

double lengthOf(const std::vector<CameraKey>& keys, std::size_t stretch)
{
    return keys[stretch + 1].frame - keys[stretch].frame;
}

KeyValues meanSlope(const std::vector<CameraKey>& keys, std::size_t stretch)
{
    return (valuesOf(keys[stretch + 1]) - valuesOf(keys[stretch])) / lengthOf(keys, stretch);
}

/// At rest at the first and the last key.
KeyValues slopeAt(const std::vector<CameraKey>& keys, std::size_t key)
{
    KeyValues slope = KeyValues::Zero();
    if (key == 0 || key + 1 == keys.size()) return slope;
    const KeyValues before = meanSlope(keys, key - 1), after = meanSlope(keys, key);
    for (Eigen::Index i = 0; i < slope.size(); ++i)
        slope[i] = slopeBetween(before[i], lengthOf(keys, key - 1), after[i], lengthOf(keys, key));
    return slope;
}

KeyValues betweenKeys(const SceneCamera& camera, double frame)
{
    const std::vector<CameraKey>& keys = camera.keys;
    if (frame <= keys.front().frame) return valuesOf(keys.front());
    if (frame >= keys.back().frame) return valuesOf(keys.back());
    const auto after = std::find_if(keys.begin(), keys.end(),
                                    [&](const CameraKey& key) { return key.frame > frame; });
    const auto k = static_cast<std::size_t>(after - keys.begin()) - 1;
    const KeyValues from = valuesOf(keys[k]), to = valuesOf(keys[k + 1]);
    const double h = lengthOf(keys, k), s = (frame - keys[k].frame) / h;
    if (!camera.isSmooth) return from + s * (to - from);

    // Hermite's cubic, so written that between two equal keys nothing moves, not even by rounding.
    const double rest = 1.0 - s;
    return from + s * s * (3.0 - 2.0 * s) * (to - from) +
           h * s * rest * (rest * slopeAt(keys, k) - s * slopeAt(keys, k + 1));
}

/// 0° is in front, +z (−y when z is up); onwards against the clock, seen from above.
Vec3 eyeOnOrbit(const CameraOrbit& orbit, double frame, bool zUp)
{
    const double length = orbit.lastFrame - orbit.firstFrame;
    const double share =
        length > 0.0 ? std::clamp((frame - orbit.firstFrame) / length, 0.0, 1.0) : 0.0;
    double sine = 0.0, cosine = 0.0;
    sinCos((orbit.startDegrees + share * orbit.degrees) * kPi / 180.0, sine, cosine);
    const double right = orbit.radius * sine, front = orbit.radius * cosine;
    return orbit.centre +
           (zUp ? Vec3(right, -front, orbit.height) : Vec3(right, orbit.height, front));
}

}  // namespace

bool moves(const SceneCamera& camera)
{
    return camera.orbit.has_value() || camera.keys.size() > 1;
}

SceneCamera cameraAt(const SceneCamera& camera, double frame, bool zUp)
{
    SceneCamera now;
    now.name = camera.name;
    now.eye = camera.eye;
    now.target = camera.target;
    now.fovDegrees = camera.fovDegrees;
    now.up = camera.up;
    if (!camera.keys.empty()) {
        const KeyValues values = betweenKeys(camera, frame);
        now.eye = values.head<3>();
        now.target = values.segment<3>(3);
        now.up = values.segment<3>(6);
        now.fovDegrees = values[9];
    } else if (camera.orbit) {
        now.eye = eyeOnOrbit(*camera.orbit, frame, zUp);
        now.target = camera.orbit->centre;
    }
    return now;
}

Vec3 upOf(const SceneCamera& camera, bool zUp)
{
    if (!camera.up.isZero(0.0)) return camera.up;
    return zUp ? Vec3::UnitZ() : Vec3::UnitY();
}

Mat3 worldFromViewAxes(const Vec3& eye, const Vec3& target, const Vec3& up)
{
    Vec3 backward = eye - target;
    if (backward.norm() == 0.0) backward = Vec3::UnitZ();
    backward.normalize();
    Vec3 right = up.cross(backward);
    if (right.norm() < 1e-9 * up.norm()) right = backward.unitOrthogonal();
    right.normalize();
    Mat3 axes;
    axes << right, backward.cross(right), backward;
    return axes;
}

SceneCamera scaled(const SceneCamera& camera, double factor)
{
    SceneCamera result = camera;
    result.eye *= factor;
    result.target *= factor;
    for (CameraKey& key : result.keys) {
        key.eye *= factor;
        key.target *= factor;
    }
    if (!result.orbit) return result;
    result.orbit->centre *= factor;
    result.orbit->radius *= factor;
    result.orbit->height *= factor;
    return result;
}

}  // namespace scree
