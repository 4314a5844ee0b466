// Three bones as implicit solids, in metres: what shots/bones_*.toml drops through its funnel.
//
// Not anatomy but what a heap asks of a prop: a shell that other bones enter, a ring with wings
// that hooks, a long bone that bridges. Everything is at least 5 cm thick.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/math/aabb.h"

namespace scree {

struct BoneForm {
    std::string name;
    int triangleCount;                       ///< of the finished mesh
    std::function<double(const Vec3&)> phi;  ///< negative inside, about distance [m]
    Aabb box;                                ///< holds it all [m]
};

/// skull, pelvis, femur: 3520, 8680 and 8160 triangles, as the paper's cranium, pelvis and femur.
std::vector<BoneForm> boneForms();

}  // namespace scree
