// The commands of the program. Each adds itself to the command line and returns what to do when it
// is the one that was chosen; the action returns the exit code.
#pragma once

#include <functional>

#include "tools/console.h"

namespace CLI {
class App;
}

namespace scree {

struct Command {
    CLI::App* options = nullptr;
    std::function<int(Console&)> run;
};

Command addSimCommand(CLI::App& program);
Command addRenderCommand(CLI::App& program);
Command addExportCommand(CLI::App& program);
Command addSheetCommand(CLI::App& program);
Command addMovieCommand(CLI::App& program);
Command addCheckCommand(CLI::App& program);
Command addExplainCommand(CLI::App& program);
Command addInfoCommand(CLI::App& program);
Command addDiffCommand(CLI::App& program);
Command addSettleCommand(CLI::App& program);
Command addStatsCommand(CLI::App& program);
Command addVerifyCommand(CLI::App& program);

}  // namespace scree
