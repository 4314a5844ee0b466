#include "io/usd_instancer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <tuple>

#include "core/math/point_box.h"
#include "core/math/rotation.h"
#include "io/unique_names.h"

namespace scree {

namespace {

/// Which prototype each body uses, and a body to make each prototype from.
struct Prototypes {
    std::vector<std::size_t> ofBody;  // parallel to the instancer's bodies
    std::vector<std::size_t> models;  // indices into the scene's bodies
};

Prototypes findPrototypes(const SceneDescription& scene, const std::vector<std::size_t>& bodies)
{
    Prototypes result;
    std::map<std::tuple<std::size_t, std::string, double>, std::size_t> known;
    for (const std::size_t b : bodies) {
        const SceneBody& body = scene.bodies[b];
        const auto [entry, isNew] =
            known.emplace(std::tuple(body.mesh, body.material, body.mass), result.models.size());
        if (isNew) result.models.push_back(b);
        result.ofBody.push_back(entry->second);
    }
    return result;
}

void writePrototypes(UsdText& text, const UsdNames& names, const SceneDescription& scene,
                     const Prototypes& prototypes)
{
    UniqueNames taken;
    std::vector<std::string> prims;
    for (const std::size_t model : prototypes.models) {
        const SceneBody& body = scene.bodies[model];
        prims.push_back(taken.take(names.meshes[body.mesh] + "_" + body.material));
    }

    const std::string scope = "/" + names.root + "/" + names.instancer + "/Prototypes/";
    text.line("rel prototypes = " +
              usdArray(prims, [&](std::string& line, const std::string& name) {
                  line += "<" + scope + name + ">";
              }));
    text.openPrim(usdPrim("Scope", "Prototypes"));
    for (std::size_t k = 0; k < prims.size(); ++k) {
        const SceneBody& body = scene.bodies[prototypes.models[k]];
        text.openPrim(usdPrim("Xform", prims[k]), usdBodyMetadata(names, body, false));
        writeUsdBodyProperties(text, names, scene, body);
        text.closePrim();
    }
    text.closePrim();
}

// Positions are single precision. Measured from a place near the action they have the digits they
// need even when a shot stands far from its origin. A place that is a multiple of the action's size
// is the origin itself for shots that do not.
Vec3 placeOf(const std::vector<MotionSample>& samples)
{
    Aabb box;
    for (const MotionSample& sample : samples) box.include(sample.worldFromAsset.position);
    const double size = std::exp2(std::ceil(std::log2(std::max(box.diagonal(), 1.0))));
    return (box.centre() / size).array().round() * size;
}

class InstancerTimes {
public:
    InstancerTimes(UsdText& text, MotionSpool& motion, const FinishWatch& watch)
        : text_(text), motion_(motion), watch_(watch)
    {
    }

    /// Writes an array attribute at every time; `append` writes one body's value.
    void write(const char* attribute,
               const std::function<void(std::string& line, const MotionSample& sample)>& append)
    {
        writeValues(attribute, [&](const std::vector<MotionSample>& samples) {
            return usdArray(samples, append);
        });
    }

    void writeValues(
        const char* attribute,
        const std::function<std::string(const std::vector<MotionSample>& samples)>& valueText)
    {
        text_.openTimes(attribute);
        for (std::size_t i = 0; i < motion_.times().size(); ++i) {
            watch_(static_cast<double>(done_++) /
                   static_cast<double>(kAttributes * motion_.times().size()));
            text_.time(motion_.times()[i], valueText(motion_.readTime(i)));
        }
        text_.closeTimes();
    }

private:
    static constexpr std::size_t kAttributes = 6;

    UsdText& text_;
    MotionSpool& motion_;
    const FinishWatch& watch_;
    std::size_t done_ = 0;  // times, of all attributes
};

std::vector<Aabb> meshBoxes(const SceneDescription& scene)
{
    std::vector<Aabb> boxes;
    for (const SceneMesh& mesh : scene.meshes) boxes.push_back(boxOf(mesh.points));
    return boxes;
}

/// The box around the boxes of all bodies, measured from `place`.
std::string extentText(const SceneDescription& scene, const std::vector<std::size_t>& bodies,
                       const std::vector<Aabb>& boxes, const std::vector<MotionSample>& samples,
                       const Vec3& place)
{
    Aabb extent;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        const Aabb& box = boxes[scene.bodies[bodies[k]].mesh];
        if (box.isEmpty()) continue;
        const Pose& pose = samples[k].worldFromAsset;
        extent.include(
            transformed(box, pose.orientation.toRotationMatrix(), pose.position - place));
    }
    if (extent.isEmpty()) extent = {Vec3::Zero(), Vec3::Zero()};
    return "[" + usdTuple(extent.min.cast<float>().eval()) + ", " +
           usdTuple(extent.max.cast<float>().eval()) + "]";
}

/// Digits of half precision, which is all that `quath` holds.
void appendHalf(std::string& text, double value)
{
    std::array<char, 32> letters;
    const auto end = std::to_chars(letters.data(), letters.data() + letters.size(), value,
                                   std::chars_format::general, 5)
                         .ptr;
    text.append(letters.data(), end);
}

void appendHalfQuaternion(std::string& text, const MotionSample& sample)
{
    const Quat& q = sample.worldFromAsset.orientation;
    char before = '(';
    for (const double part : {q.w(), q.x(), q.y(), q.z()}) {
        text += before;
        if (before == ',') text += ' ';
        appendHalf(text, part);
        before = ',';
    }
    text += ')';
}

/// Who is not to be seen, at every time at which that changes. Who is there at the first frame is
/// there in its samples before it too.
void writeInvisibleIds(UsdText& text, const SceneDescription& scene, int firstFrame,
                       const MotionSpool& motion)
{
    const auto unseenAt = [&](double time) {
        std::vector<std::size_t> ids;
        for (const std::size_t body : motion.bodies()) {
            if (std::max<double>(time, firstFrame) < seenFrom(scene.bodies[body]))
                ids.push_back(body);
        }
        return ids;
    };
    std::vector<std::size_t> last = unseenAt(motion.times().front());
    const auto idsText = [&] { return usdArray(last, appendNumber<std::size_t>); };
    if (last.empty()) return text.line("int64[] invisibleIds = []");
    text.openTimes("int64[] invisibleIds");
    text.time(motion.times().front(), idsText());
    for (const double time : motion.times()) {
        std::vector<std::size_t> now = unseenAt(time);
        if (now == last) continue;
        last = std::move(now);
        text.time(time, idsText());
    }
    text.closeTimes();
}

void writeMotion(UsdText& text, const SceneDescription& scene, MotionSpool& motion,
                 const FinishWatch& watch)
{
    const Vec3 place = placeOf(motion.readTime(0));
    const std::vector<Aabb> boxes = meshBoxes(scene);
    InstancerTimes times(text, motion, watch);

    times.writeValues("float3[] extent", [&](const std::vector<MotionSample>& samples) {
        return extentText(scene, motion.bodies(), boxes, samples, place);
    });
    times.write("point3f[] positions", [&](std::string& line, const MotionSample& sample) {
        appendUsdTuple(line, (sample.worldFromAsset.position - place).cast<float>().eval());
    });
    // Half precision is off by up to 0.05°, but older readers know nothing else; newer ones take
    // orientationsf. The schema has nothing finer, so a reader sees no turn below 0.04°: slow ones
    // want a prim per body (see usdQuaternion).
    times.write("quath[] orientations", appendHalfQuaternion);
    times.write("quatf[] orientationsf", [](std::string& line, const MotionSample& sample) {
        appendUsdTuple(line, usdQuaternion(sample.worldFromAsset.orientation).cast<float>().eval());
    });
    times.write("vector3f[] velocities", [](std::string& line, const MotionSample& sample) {
        appendUsdTuple(line, sample.velocity.cast<float>().eval());
    });
    times.write("vector3f[] angularVelocities", [](std::string& line, const MotionSample& sample) {
        appendUsdTuple(line, (sample.angularVelocity * (180.0 / kPi)).cast<float>().eval());
    });

    if (place.isZero(0.0)) return;
    text.line("double3 xformOp:translate = " + usdTuple(place));
    text.line("uniform token[] xformOpOrder = [\"xformOp:translate\"]");
}

}  // namespace

void writeUsdInstancer(UsdText& text, const UsdNames& names, const SceneDescription& scene,
                       int firstFrame, MotionSpool& motion, const FinishWatch& watch)
{
    const std::vector<std::size_t>& bodies = motion.bodies();
    if (bodies.empty()) return;
    const Prototypes prototypes = findPrototypes(scene, bodies);

    text.openPrim(usdPrim("PointInstancer", names.instancer));
    text.line("int64[] ids = " + usdArray(bodies, appendNumber<std::size_t>));
    writeInvisibleIds(text, scene, firstFrame, motion);
    text.line("int[] protoIndices = " + usdArray(prototypes.ofBody, appendNumber<std::size_t>));

    // What else there is to know of a body, parallel to the ids.
    text.line(
        "string[] primvars:bodyName = " +
        usdArray(bodies, [&](std::string& line,
                             std::size_t body) { line += usdString(scene.bodies[body].name); }) +
        " (");
    text.line("    interpolation = \"vertex\"");
    text.line(")");
    text.line("float[] primvars:mass = " +
              usdArray(bodies,
                       [&](std::string& line, std::size_t body) {
                           appendNumber(line, static_cast<float>(scene.bodies[body].mass));
                       }) +
              " (");
    text.line("    interpolation = \"vertex\"");
    text.line(")");

    writeMotion(text, scene, motion, watch);
    writePrototypes(text, names, scene, prototypes);
    text.closePrim();
}

}  // namespace scree
