// Shot → World: builds every shape once and places the bodies. What a shot says of looks and
// cameras is not the world's business; tools hand that to render.
#pragma once

#include "core/picture/scene_description.h"
#include "core/scene/world.h"
#include "io/shot.h"

namespace scree {

/// How rough a mesh is that lies far from the origin of its file, since files keep coordinates in
/// single precision: a sentence without its subject. Empty when they are exact to that share of its
/// longest edge.
std::string roughnessOf(const TriMesh& mesh, double share);

/// The shot at time zero; bodies that are born at its first frame have been. Throws Error, located
/// in the shot file, when an asset cannot be read or is not a solid, or when a body that may not
/// wait finds its place taken. What takes time to make comes from `store` where that has it and
/// goes there where it has not; the world is the same with and without.
World buildWorld(const Shot& shot, ShapeStore* store = nullptr);

/// Names, meshes and masses of everything that is exported, in the shot's units. Planes become
/// quads of half width `planeHalfWidth` [shot units].
SceneDescription describeScene(const Shot& shot, const World& world, double planeHalfWidth);

/// Where everything stands now, in the shot's units; bodies as in describeScene.
SceneFrame captureFrame(const Shot& shot, const World& world);

}  // namespace scree
