// What an FBX file says of the lenses of its cameras where it gives no angle of view, which assimp
// passes over.
#pragma once

#include <optional>
#include <string>

namespace scree {

struct FbxLens {
    /// Half the width of the film through the focal length; nothing where the file does not say
    /// both, or has cameras that differ: which is whose is not told here.
    std::optional<double> halfTangent;
    bool hasOneDegree = false;  ///< a camera has an angle of view of 1 degree, which others lack
};

/// Of a file in words or in binary.
FbxLens readFbxLens(const std::string& bytes);

}  // namespace scree
