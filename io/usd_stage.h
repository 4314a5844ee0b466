// What a USD file holds besides motion: the layer's header, materials, meshes to share, cameras.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/picture/scene_description.h"
#include "io/usd_text.h"

namespace scree {

/// Names and paths of prims. Everything stands under the root, so that a reference to the file
/// brings it all:
///
///   /<shot>/<body>                 bodies, under the names the shot gives them
///   /<shot>/<camera>
///   /<shot>/Materials/<material>   looks and physical properties
///   /<shot>/Prototypes/<mesh>      meshes that bodies refer to, abstract
///
/// A scope moves aside (Materials_2) when a body has its name. A name that USD cannot hold is
/// changed (io/unique_names.h), and the prim has the old one as the attribute userProperties:name.
struct UsdNames {
    explicit UsdNames(const SceneDescription& scene);

    std::string meshPath(std::size_t mesh) const;

    /// Empty for a material the scene does not know.
    std::string materialPath(const std::string& material) const;

    std::string root;
    std::vector<std::string> bodies, meshes, materials, cameras;  // parallel to the scene's
    std::string meshScope, materialScope, instancer;
    std::map<std::string, std::size_t> materialIndex;
};

/// Stage metadata: axes, unit, frames. Time codes are frame numbers.
void writeUsdHeader(AtomicFile& file, const UsdNames& names, const SceneDescription& scene,
                    double firstTime, double lastTime);

/// Preview surfaces with the shot's colours; density, friction and restitution for physics.
void writeUsdMaterials(UsdText& text, const UsdNames& names, const SceneDescription& scene);

/// The meshes that bodies use, with normals that are sharp at creases. Not subdivided by readers.
void writeUsdMeshes(UsdText& text, const UsdNames& names, const SceneDescription& scene);

/// As they are at each of `times` [frames].
void writeUsdCameras(UsdText& text, const UsdNames& names, const SceneDescription& scene,
                     const std::vector<double>& times);

/// An attribute over time, `values` parallel to `times`; without time where it stays the same.
/// Samples with equal text are equal to a reader.
void writeUsdTrack(UsdText& text, const std::string& attribute, const std::vector<double>& times,
                   const std::vector<std::string>& values);

/// Metadata of a prim that stands for `body`: its mesh, and the schemas of writeUsdBodyProperties.
std::vector<std::string> usdBodyMetadata(const UsdNames& names, const SceneBody& body,
                                         bool isInstance);

/// Material, mass, and what physics engines should take the body for: moved by its animation.
void writeUsdBodyProperties(UsdText& text, const UsdNames& names, const SceneDescription& scene,
                            const SceneBody& body);

/// Keeps a name that had to be changed.
void writeUsdOldName(UsdText& text, const std::string& wanted, const std::string& name);

}  // namespace scree
