// Names of objects in an OBJ file, which assimp takes to end at their first blank: "Left wheel" and
// "Left door" were one object called "Left", and so one rigid body.
#pragma once

#include <string>

namespace scree {

/// Puts something that is no blank in the place of the blanks inside the names of objects. Says
/// whether there were any; else the text stays as it is.
bool closeObjNames(std::string& text);

/// The name as the file has it.
std::string openedObjName(std::string name);

}  // namespace scree
