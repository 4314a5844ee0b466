// How a surface appears; how it behaves is core's Material.
#pragma once

#include <vector>

#include "core/math/types.h"
#include "core/picture/scene_description.h"

namespace scree {

struct Look {
    Vec3 color = {0.6, 0.6, 0.6};  ///< share of light that is scattered back, linear, 0 … 1
    double roughness = 0.5;        ///< [-]; 0 polished, 1 chalk
};

/// Looks of all bodies, each a little lighter or darker and tinted another way than its material,
/// so that the eye can tell bodies of a heap apart. The draw is a hash of the body's name: it is
/// the same in every frame and does not depend on the other bodies. Bodies that do not move keep
/// their look. `looks` is parallel to scene.bodies; strength 0 changes nothing, 1 is right for
/// heaps.
std::vector<Look> variedLooks(const SceneDescription& scene, const std::vector<Look>& looks,
                              double strength = 1.0);

}  // namespace scree
