// A small glTF of three nodes, in words, with its bytes in a file of their own.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

#include "tests/support/support.h"

namespace scree::test {

/// A tetrahedron as glTF with its bytes in a file called `buffer`, under a node that turns it
/// upside down, moves and doubles it; shown by two more nodes as it is.
inline std::string gltfText(const std::string& buffer)
{
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],"nodes":[
{"name":"Mug.big","mesh":0,"translation":[1,2,3],"rotation":[1,0,0,0],"scale":[2,2,2]},
{"name":"Mug.small","mesh":0,"translation":[0,5,0]},{"name":"Bowl","mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
{"bufferView":1,"componentType":5125,"count":12,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":48}],
"buffers":[{"byteLength":96,"uri":")" +
           buffer + "\"}]}";
}

/// set.gltf with data.bin beside it.
inline void writeGltf(const TemporaryFolder& folder)
{
    const float points[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::uint32_t corners[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    std::ofstream data(folder / "data.bin", std::ios::binary);
    data.write(reinterpret_cast<const char*>(points), sizeof points);
    data.write(reinterpret_cast<const char*>(corners), sizeof corners);
    std::ofstream(folder / "set.gltf") << gltfText("data.bin");
}

}  // namespace scree::test
