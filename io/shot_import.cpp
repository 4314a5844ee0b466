#include "io/shot_import.h"

#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>

#include "core/base/hash.h"
#include "io/mesh_import.h"
#include "io/nearest_word.h"

namespace scree {
namespace {

constexpr std::size_t kNamesTold = 12;

/// What is no letter, digit or _ becomes _; a digit never stands first.
std::string identifierOf(const std::string& name)
{
    std::string result;
    for (const unsigned char letter : name) {
        const bool isPlain = letter < 128 && (std::isalnum(letter) != 0 || letter == '_');
        result += isPlain ? static_cast<char>(letter) : '_';
    }
    if (result.empty()) return "node";
    return std::isdigit(static_cast<unsigned char>(result.front())) != 0 ? "_" + result : result;
}

/// Marks the nodes that one of the patterns fits.
std::vector<bool> chooseNodes(const ShotNode& patterns, const ImportedFile& file,
                              const std::string& path, ProblemList& problems)
{
    std::vector<std::string> names;
    for (const ImportedNode& node : file.nodes) names.push_back(node.name);
    std::vector<bool> isChosen(names.size(), false);
    const auto apply = [&](const ShotNode& pattern) {
        bool fitsAny = false;
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (::fnmatch(pattern.text.c_str(), names[i].c_str(), 0) != 0) continue;
            isChosen[i] = fitsAny = true;
        }
        if (fitsAny) return;
        std::vector<std::string> told(names.begin(),
                                      names.begin() + std::min(names.size(), kNamesTold));
        problems.add(pattern.where, "no node of '" + path + "' is called " + toTomlText(pattern) +
                                        didYouMean(pattern.text, names) +
                                        " (it has: " + joined(told) +
                                        (told.size() < names.size() ? ", …" : "") + ")");
    };
    for (const ShotNode& pattern : patterns.items) apply(pattern);
    if (patterns.items.empty()) apply(patterns);
    return isChosen;
}

/// Gives equal meshes one owner.
class MeshPool {
public:
    std::shared_ptr<const TriMesh> share(TriMesh mesh)
    {
        std::uint64_t hash = hashBytes(mesh.points.data(), sizeof(double) * mesh.points.size());
        hash = hashBytes(mesh.triangles.data(), sizeof(int) * mesh.triangles.size(), hash);
        hash = hashBytes(mesh.cornerUvs.data(), sizeof(float) * mesh.cornerUvs.size(), hash);
        auto& known = meshes_[hash];
        if (!known) known = std::make_shared<const TriMesh>(std::move(mesh));
        return known;
    }

private:
    std::map<std::uint64_t, std::shared_ptr<const TriMesh>> meshes_;
};

/// glTF's up is +y; a shot whose up is +z has its files turned upright.
Pose worldFromFile(const Shot& shot, const ImportedFile& file)
{
    const bool isTurned = shot.zUp && file.isYUp;
    const double half = std::sqrt(0.5);
    return {Vec3::Zero(), isTurned ? Quat(half, half, 0.0, 0.0) : Quat::Identity()};
}

}  // namespace

std::vector<PlacedNode> readImportedNodes(const ShotNode& node, const std::string& path,
                                          const Shot& shot, ProblemList& problems)
{
    std::vector<PlacedNode> result;
    ImportedFile file;
    try {
        file = importFile(path);
    } catch (const Error& error) {
        problems.add(node.find("file")->where, error.what(), error.kind());
        return result;
    }
    const std::vector<bool> isChosen = chooseNodes(*node.find("nodes"), file, path, problems);
    const double metres = file.metresPerUnit.value_or(shot.metresPerUnit);
    MeshPool pool;
    for (std::size_t i = 0; i < file.nodes.size(); ++i) {
        if (!isChosen[i]) continue;
        const ImportedNode& imported = file.nodes[i];
        PlacedNode placed;
        placed.name = identifierOf(imported.name);
        TriMesh mesh = transformed(imported.mesh, Pose(), Vec3::Constant(metres));
        placed.shape = {path, pool.share(std::move(mesh))};
        placed.worldFromNode = worldFromFile(shot, file) * imported.fileFromNode;
        placed.worldFromNode.position *= metres;
        result.push_back(std::move(placed));
    }
    return result;
}

}  // namespace scree
