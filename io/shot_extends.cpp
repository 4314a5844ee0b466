#include "io/shot_extends.h"

#include <algorithm>

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

bool isNamed(const ShotNode& item, const std::string& name)
{
    const ShotNode* own = item.find("name");
    return own && own->kind == ShotNode::Kind::text && own->text == name;
}

void lay(ShotNode& base, const ShotNode& over, const std::string& path);

/// Items of the same name are laid over each other, others follow.
void layList(ShotNode& base, const ShotNode& over, const std::string& path)
{
    for (const ShotNode& item : over.items) {
        const ShotNode* name = item.find("name");
        const auto same = std::find_if(base.items.begin(), base.items.end(), [&](const auto& own) {
            return name && isNamed(own, name->text);
        });
        if (same != base.items.end()) {
            lay(*same, item, path);
        } else {
            base.items.push_back(item);
        }
    }
}

void lay(ShotNode& base, const ShotNode& over, const std::string& path)
{
    base.where = over.where;
    for (const ShotEntry& entry : over.entries) {
        std::erase_if(base.entries, [&](const ShotEntry& own) {
            return own.key != entry.key && areExclusive(path, own.key, entry.key);
        });
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
