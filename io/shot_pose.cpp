#include "io/shot_pose.h"

#include "core/math/rotation.h"
#include "io/pose_file.h"
#include "io/shot_values.h"

namespace scree {

Pose readPose(const ShotNode& node, ProblemList& problems)
{
    Pose pose;
    if (const ShotNode* position = node.find("position")) pose.position = toVec3(*position);
    if (const ShotNode* rotation = node.find("rotation")) {
        pose.orientation = fromEulerXyz(toVec3(*rotation) * kRadiansPerDegree);
    } else if (const ShotNode* q = node.find("orientation")) {
        const std::vector<ShotNode>& wxyz = q->items;
        if (!toOrientation(wxyz[0].number, wxyz[1].number, wxyz[2].number, wxyz[3].number,
                           pose.orientation)) {
            problems.add(q->where, "'orientation' must not be zero");
        }
    }
    return pose;
}

}  // namespace scree
