// The program: picks a command, catches what went wrong, prints one line about it, returns a code.
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <ios>
#include <new>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "io/nearest_word.h"
#include "tools/command_line.h"
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
    "  73 cannot create output, 74 I/O error or disk full, 75 stopped when asked to (run again;\n"
    "  sim and settle go on with --resume), 79 quality limit broken";

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
        ->check(oneOf({"text", "json"}));
}

/// The long options of a command, as they are written.
void addOptionNames(const CLI::App& command, std::vector<std::string>& names)
{
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
}

/// The word where the command's name is expected: the first that is no option of the program and no
/// value of one.
std::string commandWord(const CLI::App& program, const std::vector<std::string>& words)
{
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (!words[i].starts_with('-')) return words[i];
        const CLI::Option* option = program.get_option_no_throw(words[i]);
        if (option && option->get_expected_min() > 0) ++i;
    }
    return "";
}

/// "no command 'simm'; did you mean 'sim'?" or the same of an option; empty where the words are all
/// known, and something else is wrong.
std::string unknownWord(const CLI::App& program, const std::vector<std::string>& words)
{
    if (words.empty()) return "";
    std::vector<std::string> commands, options;
    const CLI::App* command = nullptr;
    const std::string name = commandWord(program, words);
    for (const CLI::App* known : program.get_subcommands([](const CLI::App*) { return true; })) {
        commands.push_back(known->get_name());
        if (name == known->get_name()) command = known;
    }
    if (!command && !name.empty()) {
        return "no command '" + name + "'" + didYouMean(name, commands) +
               " (there are: " + joined(commands) + ")";
    }
    addOptionNames(program, options);
    if (command) addOptionNames(*command, options);
    for (const std::string& word : words) {
        const std::string option = word.substr(0, word.find('='));
        if (!option.starts_with("--") || option == "--") continue;
        if (std::find(options.begin(), options.end(), option) != options.end()) continue;
        return "no option '" + option + "'" +
               (command ? " of scree " + command->get_name() : std::string()) +
               didYouMean(option, options);
    }
    return "";
}

/// "-o=x" is the value "=x" to the parser of options, and a file of that name to whoever writes it.
void refuseShortEquals(const std::string& word)
{
    const bool isShort = word.size() >= 3 && word[0] == '-' && word[1] != '-' && word[2] == '=';
    if (!isShort) return;
    const std::string option = word.substr(0, 2), value = word.substr(3);
    throw Error(ErrorKind::usage, "\"" + word + "\": the value of " + option +
                                      " comes after a space" +
                                      (value.empty() ? "" : ": " + option + " " + value));
}

/// An empty word is a shell variable that was never set: taken for "not given" it would simulate
/// all frames, or write to another place, without a word.
void refuseEmptyWords(const std::vector<std::string>& words)
{
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        refuseShortEquals(word);
        const bool isOption = word.starts_with("--") && word.find('=') == word.size() - 1;
        if (!word.empty() && !isOption) continue;
        const bool followsOption = word.empty() && i > 0 && words[i - 1].starts_with("-");
        const std::string where = isOption        ? word.substr(0, word.size() - 1) + " has"
                                  : followsOption ? words[i - 1] + " has"
                                                  : "argument " + std::to_string(i + 1) + " is";
        throw Error(ErrorKind::usage,
                    where + (isOption || followsOption ? " an empty value" : " empty"));
    }
}

/// A command that has nothing better to say of a lack of memory is named itself.
int run(const Command& command, Console& console)
{
    try {
        return command.run(console);
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::internal, "memory ran out in scree " + command.options->get_name());
    }
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

    const std::vector<std::string> words(arguments + 1, arguments + argumentCount);
    refuseEmptyWords(words);

    // --help and --version arrive here too: they are printed by CLI11 and are no error.
    try {
        program.parse(argumentCount, arguments);
    } catch (const CLI::ParseError& problem) {
        if (problem.get_exit_code() == 0) {
            program.exit(problem);
            return kExitDone;
        }
        const std::string slip = unknownWord(program, words);
        throw Error(ErrorKind::usage,
                    (slip.empty() ? problem.what() : slip) + " (scree --help tells more)");
    }
    for (const Command& command : commands)
        if (command.options->parsed()) return run(command, console);
    return kExitUsage;
}

/// Whoever reads from the other end of stdout has had enough, as head has after ten lines.
bool isReaderGone()
{
    pollfd output{STDOUT_FILENO, POLLOUT, 0};
    return ::poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0;
}

/// A result that did not arrive is none: a full disk behind stdout shows when the last of it is
/// handed over.
void requireResultsWritten()
{
    errno = 0;
    if ((std::fflush(stdout) == 0 && std::ferror(stdout) == 0) || isReaderGone()) return;
    throw Error(ErrorKind::inputOutput,
                std::string("writing the results to stdout failed") +
                    (errno == 0 ? "" : std::string(": ") + std::strerror(errno)));
}

/// What the system says of a name that is to be read. Outputs have errors of their own, thrown
/// where it is known what was to be created.
int reportUnreachable(const std::filesystem::filesystem_error& problem, Console& console)
{
    console.error("\"" + problem.path1().string() +
                  "\" cannot be reached: " + problem.code().message());
    return exitCodeFor(ErrorKind::missingInput);
}

}  // namespace
}  // namespace scree

int main(int argumentCount, char** arguments)
{
    scree::Console console;
    scree::takeFileLimitsAsErrors();
    scree::watchSignals();
    try {
        const int code = scree::runProgram(argumentCount, arguments, console);
        scree::requireResultsWritten();
        return code;
    } catch (const scree::Stopped& stop) {
        console.info("stopped; " + stop.outcome);
        return scree::kExitStopped;
    } catch (const scree::Error& problem) {
        console.error(problem.what());
        return scree::exitCodeFor(problem.kind());
    } catch (const std::filesystem::filesystem_error& problem) {
        return scree::reportUnreachable(problem, console);
    } catch (const std::ios_base::failure& problem) {
        console.error(std::string("reading or writing failed: ") + problem.what());
        return scree::exitCodeFor(scree::ErrorKind::inputOutput);
    } catch (const std::bad_alloc&) {
        console.error("memory ran out");
        return scree::kExitInternal;
    } catch (const std::exception& problem) {
        console.error(std::string("internal: ") + problem.what());
        return scree::kExitInternal;
    }
}
