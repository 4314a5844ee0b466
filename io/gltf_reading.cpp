#include "io/gltf_reading.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <nlohmann/json.hpp>

namespace scree {
namespace {

using Json = nlohmann::json;

constexpr std::array<const char*, 4> kLost = {"EXT_mesh_gpu_instancing", "KHR_mesh_quantization",
                                              "EXT_meshopt_compression", "KHR_meshopt_compression"};

/// The words of a file: all of a .gltf, the first chunk of a .glb, after header and length.
std::string_view wordsOf(std::string_view bytes)
{
    constexpr std::size_t kLength = 12, kWords = 20;
    if (!bytes.starts_with("glTF") || bytes.size() < kWords) return bytes;
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + kLength, sizeof length);
    return bytes.substr(kWords, length);
}

/// The member of an object, or null; of what is no object, null.
const Json& memberOf(const Json& object, const char* key)
{
    static const Json nothing;
    const auto found = object.is_object() ? object.find(key) : object.end();
    return object.is_object() && found != object.end() ? *found : nothing;
}

/// The item of a list at a place that another member tells, or null.
const Json& itemOf(const Json& list, const Json& place)
{
    static const Json nothing;
    if (!list.is_array() || !place.is_number_unsigned()) return nothing;
    const auto index = place.get<std::size_t>();
    return index < list.size() ? list[index] : nothing;
}

std::string textOf(const Json& value)
{
    return value.is_string() ? value.get<std::string>() : "";
}

SampleJoin joinOf(const Json& sampler, const Json& accessors)
{
    // Exporters write one sample for what stands still, and call it a jump.
    const Json& count = memberOf(itemOf(accessors, memberOf(sampler, "input")), "count");
    if (!count.is_number_unsigned() || count.get<std::uint64_t>() < 2) return SampleJoin::straight;
    const std::string said = textOf(memberOf(sampler, "interpolation"));
    if (said == "STEP") return SampleJoin::jump;
    return said == "CUBICSPLINE" ? SampleJoin::curve : SampleJoin::straight;
}

void readJoins(const Json& file, GltfReading& reading)
{
    for (const Json& animation : memberOf(file, "animations")) {
        for (const Json& channel : memberOf(animation, "channels")) {
            const Json& target = memberOf(channel, "target");
            const std::string path = textOf(memberOf(target, "path"));
            if (path != "translation" && path != "rotation" && path != "scale") continue;
            const std::string node =
                textOf(memberOf(itemOf(memberOf(file, "nodes"), memberOf(target, "node")), "name"));
            const SampleJoin join =
                joinOf(itemOf(memberOf(animation, "samplers"), memberOf(channel, "sampler")),
                       memberOf(file, "accessors"));
            if (join == SampleJoin::straight || node.empty()) continue;
            if (path != "scale") {
                reading.joins.try_emplace(node, join);
            } else if (join == SampleJoin::jump) {
                reading.jumpingScales.insert(node);
            }
        }
    }
}

/// The node whose skin leaves out how its mesh was bound; empty: there is none.
std::string looselySkinnedNode(const Json& file)
{
    for (const Json& node : memberOf(file, "nodes")) {
        const Json& skin = itemOf(memberOf(file, "skins"), memberOf(node, "skin"));
        if (!skin.is_object() || !memberOf(skin, "inverseBindMatrices").is_null()) continue;
        const std::string name = textOf(memberOf(node, "name"));
        return name.empty() ? "without a name" : name;
    }
    return "";
}

}  // namespace

GltfReading readGltf(const std::string& bytes)
{
    GltfReading reading;
    const Json file = Json::parse(wordsOf(bytes), nullptr, /* allow_exceptions */ false);
    reading.isReadable = !file.is_discarded();
    for (const Json& buffer : memberOf(file, "buffers")) {
        const std::string uri = textOf(memberOf(buffer, "uri"));
        if (!uri.empty() && !uri.starts_with("data:")) reading.buffers.push_back(uri);
    }
    for (const Json& used : memberOf(file, "extensionsUsed")) {
        const auto lost = std::find(kLost.begin(), kLost.end(), textOf(used));
        if (lost != kLost.end()) reading.lostExtension = *lost;
    }
    reading.looselySkinned = looselySkinnedNode(file);
    readJoins(file, reading);
    return reading;
}

}  // namespace scree
