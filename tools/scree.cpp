// The program: picks a command, catches what went wrong, prints one line about it, returns a code.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <new>

#include "core/base/error.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/exit_code.h"
#include "tools/stop_signals.h"
#include "tools/version.h"

namespace scree {
namespace {

constexpr const char* kFooter =
    "Example:\n"
    "  scree sim shots/rings_100.toml\n"
    "  scree render takes/rings_100 && scree movie takes/rings_100 -o rings.mp4\n"
    "Exit codes: 0 done, 1 takes differ (diff), 64 usage, 65 bad shot or asset, 66 input missing, "
    "70 internal,\n"
    "  73 cannot create output, 74 I/O error or disk full, 75 stopped (run again with --resume),\n"
    "  79 quality limit broken";

/// Options that every command understands, before or after its name.
void addConsoleOptions(CLI::App& program, Console& console)
{
    program.add_flag("-v,--verbose", console.isVerbose, "Say more");
    program.add_flag("-q,--quiet", console.isQuiet, "Say only warnings and errors");
    program
        .add_option_function<std::string>(
            "--log-format",
            [&console](const std::string& word) {
                console.format = word == "json" ? LogFormat::json : LogFormat::text;
            },
            "Messages on stderr: text, or json with one object a line")
        ->check(CLI::IsMember({"text", "json"}));
}

int runProgram(int argumentCount, char** arguments, Console& console)
{
    CLI::App program("Scree simulates heaps of rigid bodies for film.", "scree");
    program.footer(kFooter);
    program.set_version_flag("--version", describeBuild(), "Name build and libraries");
    program.require_subcommand(1);
    program.fallthrough();
    addConsoleOptions(program, console);
    const Command commands[] = {
        addSimCommand(program),   addRenderCommand(program), addExportCommand(program),
        addSheetCommand(program), addMovieCommand(program),  addCheckCommand(program),
        addInfoCommand(program),  addStatsCommand(program),  addExplainCommand(program),
        addDiffCommand(program),  addSettleCommand(program), addVerifyCommand(program),
    };
    for (const Command& command : commands) command.options->fallthrough();

    // --help and --version arrive here too: they are printed by CLI11 and are no error.
    try {
        program.parse(argumentCount, arguments);
    } catch (const CLI::ParseError& problem) {
        if (problem.get_exit_code() == 0) {
            program.exit(problem);
            return kExitDone;
        }
        throw Error(ErrorKind::usage, std::string(problem.what()) + " (scree --help tells more)");
    }
    for (const Command& command : commands)
        if (command.options->parsed()) return command.run(console);
    return kExitUsage;
}

}  // namespace
}  // namespace scree

int main(int argumentCount, char** arguments)
{
    scree::Console console;
    scree::takeFileLimitsAsErrors();
    try {
        return scree::runProgram(argumentCount, arguments, console);
    } catch (const scree::Error& problem) {
        console.error(problem.what());
        return scree::exitCodeFor(problem.kind());
    } catch (const std::bad_alloc&) {
        console.error("not enough memory");
        return scree::kExitInternal;
    } catch (const std::exception& problem) {
        console.error(std::string("internal: ") + problem.what());
        return scree::kExitInternal;
    }
}
