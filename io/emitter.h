// What an emitter makes: each of its bodies from the seed of the shot, the name of the emitter and
// the number of the body, and from nothing else, so that one emitter more or one body more changes
// no other.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/problem_list.h"
#include "io/shot.h"
#include "io/shot_tree.h"

namespace scree {

/// Lengths [m], angles [rad], as in Shot.
struct Emitter {
    std::string name;
    std::vector<std::string> shapes;
    std::vector<double> weights;  ///< parallel to shapes
    std::string material;
    int count = 0;
    int firstBirth = 1001, lastBirth = 1001;            ///< frames
    Vec3 boxMin = Vec3::Zero(), boxMax = Vec3::Zero();  ///< where places are drawn
    std::vector<Pose> places;                           ///< if not empty: instead of the box
    bool placesHaveOrientations = false;                ///< they come from a file of poses
    bool anyOrientation = false;                        ///< instead of leaning by at most maxTilt
    double maxTilt = 0.0;
    Vec3 velocity = Vec3::Zero(), angularVelocity = Vec3::Zero();
    BirthClearance clearance = BirthClearance::wait;
};

/// Reads a checked [[emitter]]; files are found in `folder`. Reports what needs more than one key:
/// weights that do not fit the shapes, births outside the shot, a box turned inside out.
Emitter readEmitterTable(const ShotNode& node, const Shot& shot, const std::string& folder,
                         ProblemList& problems);

/// Body `index` of the emitter, without name and location.
ShotBody emittedBody(const Emitter& emitter, const Shot& shot, int index);

/// Places of a grid about the origin, x running fastest, then y, then z.
std::vector<Vec3> gridPlaces(const std::array<int, 3>& count, const Vec3& spacing);

/// Reads "A-B" or "A"; false when it is neither. Frames before 0 are allowed.
bool readFrameRange(const std::string& text, int& first, int& last);

}  // namespace scree
