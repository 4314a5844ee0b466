// Text → Shot. A shot file is TOML; what it may say is in shot_schema.h. Reading happens in five
// steps, most of which add to one list of problems: TOML to a tree, that laid over the tree of the
// shot it extends (shot_extends.h), overrides into the tree, the
// tree against the schema (shot_check.h), the tree's meaning (shot_interpreter.h).
#pragma once

#include <string>
#include <vector>

#include "io/shot.h"

namespace scree {

/// Reads a shot file. `overrides` are "key=value" as after --set: key paths as in
/// "material.wood.friction", "body.ground.motion", "solver.substeps.max"; values as in TOML, text
/// also without quotes. Throws Error{missingInput} when the file is not there, and one
/// Error{badInput} with a line for each problem: "file:line:column: message", or "--set key=value:
/// message". Assets that hold more than `limits` are refused, now or when the world is built.
Shot parseShot(const std::string& path, const std::vector<std::string>& overrides = {},
               const ImportLimits& limits = {});

/// The same from text; `path` stands in messages, and files the shot names are found beside it. The
/// resolved text of a shot, parsed with the shot's own path, gives the shot again.
Shot parseShotText(const std::string& text, const std::string& path,
                   const std::vector<std::string>& overrides = {}, const ImportLimits& limits = {});

}  // namespace scree
