// What a glTF file says that assimp passes over without a word: other programs show it otherwise.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace scree {

/// How samples of a motion are joined.
enum class SampleJoin { straight, jump, curve };

struct GltfReading {
    bool isReadable = false;    ///< its JSON; otherwise nothing is known of what follows
    std::string lostExtension;  ///< one that moves, copies or packs points; empty: there is none
    /// A node whose skin has no inverse bind matrices: the format allows it, assimp crashes on it.
    std::string looselySkinned;
    /// By the name of the node, which of its moves do not go straight from sample to sample; nodes
    /// without a name are not told.
    std::map<std::string, SampleJoin> joins;
    std::vector<std::string> buffers;     ///< files beside it that its numbers stand in
    std::set<std::string> jumpingScales;  ///< nodes whose scale jumps, as of what appears and hides
};

/// Of a .glb or .gltf; of bytes that are neither, nothing.
GltfReading readGltf(const std::string& bytes);

}  // namespace scree
