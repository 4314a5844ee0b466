#include "io/shot_extends.h"

#include <algorithm>
#include <vector>

#include "io/shot_schema.h"

namespace scree {
namespace {

bool areExclusive(const std::string& path, const std::string& a, const std::string& b)
{
    const auto excludes = [&](const std::string& one, const std::string& other) {
        const ShotKey* key = findShotKey(joinPath(path, one));
        if (!key) return false;
        const std::vector<std::string> words = splitWords(key->excludes);
        return std::find(words.begin(), words.end(), other) != words.end();
    };
    return excludes(a, b) || excludes(b, a);
}

/// Of an item of a list of tables; empty where it has none.
std::string nameOf(const ShotNode& item, const std::string& list)
{
    const ShotNode* own = item.find("name");
    return own ? own->text : nameByDefault(list);
}

void lay(ShotNode& base, const ShotNode& over, const std::string& path);

/// Items of the same name are laid over each other, others follow: also a second one of that name,
/// which is no way to say more of the first.
void layList(ShotNode& base, const ShotNode& over, const std::string& path)
{
    std::vector<bool> isFree(base.items.size(), true);
    for (const ShotNode& item : over.items) {
        const std::string name = nameOf(item, path);
        std::size_t same = 0;
        while (same < isFree.size() && !(isFree[same] && nameOf(base.items[same], path) == name))
            ++same;
        if (same == isFree.size() || name.empty()) {
            base.items.push_back(item);
        } else {
            isFree[same] = false;
            lay(base.items[same], item, path);
        }
    }
}

void lay(ShotNode& base, const ShotNode& over, const std::string& path)
{
    base.where = over.where;
    // Not what `over` itself says besides: that is an error.
    std::erase_if(base.entries, [&](const ShotEntry& own) {
        return !over.entry(own.key) && std::ranges::any_of(over.entries, [&](const auto& entry) {
            return areExclusive(path, own.key, entry.key);
        });
    });
    for (const ShotEntry& entry : over.entries) {
        ShotEntry* own = base.entry(entry.key);
        if (!own) {
            base.entries.push_back(entry);
            continue;
        }
        const ShotKey* key = findShotKey(joinPath(path, entry.key));
        const bool isSameKind = own->node.kind == entry.node.kind;
        if (key && isSameKind && entry.node.kind == ShotNode::Kind::table) {
            // Names that a shot gives, as in [material.wood], leave no trace in the schema's paths.
            if (key->type == KeyType::namedTables) {
                for (const ShotEntry& named : entry.node.entries) {
                    ShotEntry* ownNamed = own->node.entry(named.key);
                    if (ownNamed) {
                        lay(ownNamed->node, named.node, key->path);
                    } else {
                        own->node.entries.push_back(named);
                    }
                }
            } else {
                lay(own->node, entry.node, key->path);
            }
        } else if (key && isSameKind && key->type == KeyType::tableList && path.empty()) {
            layList(own->node, entry.node, key->path);
        } else {
            *own = entry;
        }
    }
}

void rebase(ShotNode& node, const std::string& path, const std::filesystem::path& folder)
{
    for (ShotEntry& entry : node.entries) {
        const ShotKey* key = findShotKey(joinPath(path, entry.key));
        if (!key) continue;
        ShotNode& value = entry.node;
        if (key->isFile && value.kind == ShotNode::Kind::text) {
            value.text = (folder / value.text).lexically_normal().string();
        }
        if (key->type == KeyType::namedTables) {
            for (ShotEntry& named : value.entries) rebase(named.node, key->path, folder);
        } else {
            rebase(value, key->path, folder);
        }
        for (ShotNode& item : value.items) rebase(item, key->path, folder);
    }
}

}  // namespace

ShotNode laidOver(ShotNode base, const ShotNode& over)
{
    lay(base, over, "");
    return base;
}

void rebaseFiles(ShotNode& tree, const std::filesystem::path& folder)
{
    rebase(tree, "", folder);
}

}  // namespace scree
