#include "io/shot_tree.h"

#include <algorithm>
#include <cstdio>

#include "io/number_text.h"

namespace scree {

double ShotNode::asNumber() const
{
    return kind == Kind::integer ? static_cast<double>(integer) : number;
}

const ShotEntry* ShotNode::entry(std::string_view key) const
{
    for (const ShotEntry& candidate : entries) {
        if (candidate.key == key) return &candidate;
    }
    return nullptr;
}

ShotEntry* ShotNode::entry(std::string_view key)
{
    return const_cast<ShotEntry*>(static_cast<const ShotNode&>(*this).entry(key));
}

bool ShotNode::mentions(std::string_view key) const
{
    return std::any_of(entries.begin(), entries.end(), [&](const ShotEntry& candidate) {
        return candidate.key == key || candidate.meant == key;
    });
}

bool ShotNode::isUnclear(std::string_view key) const
{
    return std::any_of(entries.begin(), entries.end(), [&](const ShotEntry& candidate) {
        const bool isWrong = !candidate.isValid || candidate.isStandIn;
        return candidate.meant == key || (candidate.key == key && isWrong);
    });
}

const ShotNode* ShotNode::find(std::string_view key) const
{
    const ShotEntry* found = entry(key);
    return found && found->isValid ? &found->node : nullptr;
}

std::string toTomlText(double number)
{
    std::string text = numberText(number);
    // Without this a whole number would read back as an integer, and a large one not at all.
    const bool isFinite = text.find('n') == std::string::npos;
    if (isFinite && text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
}

std::string toTomlText(std::string_view text)
{
    std::string result = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            result += '\\';
            result += c;
        } else if (code < 0x20 || code == 0x7f) {
            char escape[8];
            std::snprintf(escape, sizeof escape, "\\u%04X", static_cast<unsigned>(code));
            result += escape;
        } else {
            result += c;
        }
    }
    return result + '"';
}

std::string toTomlText(const ShotNode& node)
{
    switch (node.kind) {
        case ShotNode::Kind::boolean:
            return node.boolean ? "true" : "false";
        case ShotNode::Kind::integer:
            return std::to_string(node.integer);
        case ShotNode::Kind::number:
            return toTomlText(node.number);
        case ShotNode::Kind::text:
            return toTomlText(std::string_view(node.text));
        case ShotNode::Kind::date:
            return node.text;
        case ShotNode::Kind::list: {
            std::string text;
            for (const ShotNode& item : node.items) {
                text += (text.empty() ? "" : ", ") + toTomlText(item);
            }
            return "[" + text + "]";
        }
        case ShotNode::Kind::table:
            break;
    }
    std::string text;
    for (const ShotEntry& entry : node.entries) {
        text += (text.empty() ? "" : ", ") + entry.key + " = " + toTomlText(entry.node);
    }
    return text.empty() ? "{}" : "{ " + text + " }";
}

}  // namespace scree
