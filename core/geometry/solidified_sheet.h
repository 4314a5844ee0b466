// A solid from an open sheet that is seen from one side and folds, such as the floor and the walls
// of a stage.  [A1]
#pragma once

#include <string>

#include "core/geometry/tri_mesh.h"

namespace scree {

/// Puts the sheet once more `thickness` [m] behind itself, and joins the two along the rim: what
/// touches it from the front touches what is drawn, to the last bit. Parts that are closed stay as
/// they are. Throws Error{badInput} naming `name` when nothing is open, or when what comes out is
/// no solid: folds that the thickness does not fit behind, faces that do not agree about the front.
TriMesh solidify(const TriMesh& sheet, double thickness, const std::string& name);

}  // namespace scree
