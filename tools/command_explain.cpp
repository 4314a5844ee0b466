#include <CLI/CLI.hpp>
#include <cstdio>

#include "core/base/error.h"
#include "io/shot_reference.h"
#include "io/shot_schema.h"
#include "tools/commands.h"
#include "tools/exit_code.h"

namespace scree {

Command addExplainCommand(CLI::App& program)
{
    struct Options {
        std::string key;
        bool all = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand("explain", "Say what a key of the shot file means");
    CLI::Option* key = command->add_option(
        "KEY", options->key, "For example solver.contact_iterations, or a table: solver");
    command->add_flag("--all", options->all, "All keys, as the text of shots/REFERENCE.md")
        ->excludes(key);
    command->footer("Example:\n  scree explain material.friction");
    return {command, [options](Console&) {
                if (!options->all && options->key.empty()) {
                    throw Error(ErrorKind::usage, "explain needs a KEY, or --all");
                }
                const std::string text = options->all ? shotReference() : explainKey(options->key);
                std::printf("%s%s", text.c_str(), text.ends_with('\n') ? "" : "\n");
                return kExitDone;
            }};
}

}  // namespace scree
