// The parts of the table of shot_schema.h, one file for each. Help texts say what a key means and
// what goes wrong at the extremes.
#pragma once

#include <vector>

#include "io/shot_schema.h"

namespace scree {

void appendSetupKeys(std::vector<ShotKey>& keys);
void appendSolidsKeys(std::vector<ShotKey>& keys);
void appendWorldKeys(std::vector<ShotKey>& keys);
void appendLookKeys(std::vector<ShotKey>& keys);

}  // namespace scree
