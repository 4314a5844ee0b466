#include "tools/repair_report.h"

#include <cstdio>
#include <set>

#include "io/text_forms.h"

namespace scree {
namespace {

/// What the shot asked to be done to a mesh; empty if nothing.
std::string describeAsked(const ShapeRepairs& done)
{
    switch (done.asked) {
        case MeshRepair::none:
            return "";
        case MeshRepair::wrap:
            return formatted("wrapped with voxels of %.3g m", done.voxel);
        case MeshRepair::shell:
            return formatted("made a shell with voxels of %.3g m", done.voxel);
        case MeshRepair::room:
            return formatted("put walls of %.3g m around it", done.behind);
        case MeshRepair::solidify:
            return formatted("given a back %.3g m behind it", done.behind);
        case MeshRepair::ground:
            break;
    }
    Eigen::Index axis;
    done.groundUp.cwiseAbs().maxCoeff(&axis);
    return formatted("closed %.3g m below its lowest point; its faces look along ", done.behind) +
           (done.groundUp[axis] > 0.0 ? '+' : '-') + "xyz"[axis];
}

}  // namespace

std::string describe(const MeshDeviation& drawnToColliding)
{
    const Vec3& place = drawnToColliding.place;
    char text[200];
    std::snprintf(text, sizeof text,
                  "what collides is up to %.3g m from what is drawn, at (%.4g, %.4g, %.4g) of %s",
                  drawnToColliding.distance, place.x(), place.y(), place.z(),
                  drawnToColliding.isOnFirst ? "what is drawn" : "what collides");
    return text;
}

std::vector<std::string> repairsOf(const World& world)
{
    std::vector<std::string> repairs;
    std::set<const Shape*> told;
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        const Shape& shape = world.shapeOf(body);
        if (!told.insert(&shape).second) continue;
        const ShapeRepairs& done = shape.repairs;
        if (!done.harmless.isNone()) {
            repairs.push_back("shape '" + shape.name + "': " + describe(done.harmless));
        }
        if (done.asked == MeshRepair::none && !done.hasCollisionMesh) continue;
        std::string text = "shape '" + shape.name + "': ";
        if (done.hasCollisionMesh) text += "collides as a mesh of its own";
        if (done.hasCollisionMesh && done.asked != MeshRepair::none) text += ", ";
        text += describeAsked(done);
        // What was put behind what is drawn is nowhere near it, nor need it be.
        const bool isExact = done.behind > 0.0;
        const bool isComparable = !isExact || done.hasCollisionMesh;
        repairs.push_back(isComparable ? text + "; " + describe(done.drawnToColliding) : text);
    }
    return repairs;
}

}  // namespace scree
