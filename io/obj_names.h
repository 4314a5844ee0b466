// Names of objects in an OBJ file, as assimp does not read them. To it a name ends at its first
// blank: "Left wheel" and "Left door" were one object called "Left". Objects of one name are one to
// it, and every group begins an object of its own. Each is a rigid body to us.
#pragma once

#include <optional>
#include <string>

namespace scree {

/// The text with which assimp finds each object (`o`) that has faces, line by line what it was;
/// nothing where it finds them anyway. Another object of the same name becomes NAME.001. Groups
/// (`g`) are passed over when there are two objects or more, which is what other programs do; a
/// file with one or none may tell its bodies apart by groups.
std::optional<std::string> textWithObjNames(const std::string& text);

/// A name that assimp found, as the file has it.
std::string openedObjName(std::string name);

}  // namespace scree
