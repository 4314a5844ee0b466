#include <CLI/CLI.hpp>
#include <cstdio>

#include "io/shot_schema.h"
#include "tools/commands.h"
#include "tools/exit_code.h"

namespace scree {

Command addExplainCommand(CLI::App& program)
{
    auto key = std::make_shared<std::string>();
    CLI::App* command = program.add_subcommand("explain", "Say what a key of the shot file means");
    command->add_option("KEY", *key, "For example solver.contact_iterations, or a table: solver")
        ->required();
    command->footer("Example:\n  scree explain material.friction");
    return {command, [key](Console&) {
                const std::string text = explainKey(*key);
                std::printf("%s%s", text.c_str(), text.ends_with('\n') ? "" : "\n");
                return kExitDone;
            }};
}

}  // namespace scree
