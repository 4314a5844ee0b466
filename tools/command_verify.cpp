// The experiments that prove the method, as a table, as JSON and as a page.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "core/base/parallel.h"
#include "io/atomic_file.h"
#include "tools/command_line.h"
#include "tools/commands.h"
#include "tools/cpu_time.h"
#include "tools/exit_code.h"
#include "tools/parts_progress.h"
#include "tools/simulation.h"
#include "tools/stop_signals.h"
#include "tools/take_export.h"
#include "tools/verify/heap_record.h"
#include "tools/verify/report.h"

namespace scree {
namespace {

struct VerifyOptions {
    std::vector<std::string> ids;
    std::string method = "both", report, shots, takes = "takes", progress = "auto";
    bool full = false, judgeOnly = false, json = false, list = false;
    std::optional<int> threads;
};

int listExperiments()
{
    for (const verify::Experiment& experiment : verify::experiments()) {
        std::printf("%-4s %-4s %s\n     %s\n", experiment.id, experiment.isMust ? "must" : "goal",
                    experiment.title, experiment.claim);
    }
    return kExitDone;
}

/// Goes on with the take to its end. Overlap beyond the shot's limit is for the experiment to
/// judge.
void simulateLargeShot(const std::filesystem::path& shot, const std::string& method,
                       const std::filesystem::path& take, const VerifyOptions& options,
                       const PartsProgress& progress, Console& console)
{
    SimOptions sim;
    sim.shot = shot.string();
    sim.take = take.string();
    sim.threads = options.threads;
    sim.resume = true;
    sim.overrides = {"solver.method=" + method};
    sim.printsTake = false;
    if (progress.isShown()) sim.progress = "none";  // each run's own would begin at 0 again
    simulate(sim, console);
}

int runVerify(const VerifyOptions& options, Console& console)
{
    if (options.list) return listExperiments();
    const ProgressMode mode = parseProgressMode(options.progress);
    verify::Context context;
    context.shots =
        options.shots.empty() ? verify::findShots() : std::filesystem::path(options.shots);
    context.form = options.full ? verify::Form::full : verify::Form::brief;
    context.wantsPictures = !options.report.empty();
    context.takes = options.takes;
    setThreadCount(threadsToUse(options.threads));
    if (!options.report.empty()) {  // now, not after hours
        requirePageName(options.report);
        createFolderOf(options.report, console);
        AtomicFile{options.report};
    }

    const auto chosen = verify::chooseExperiments(options.ids);
    const std::vector<std::string> methods = verify::methodsToRun(options.method);
    PartsProgress progress(console, mode, static_cast<int>(chosen.size() * methods.size()));
    if (options.full && !options.judgeOnly) {
        context.simulate = [&](const auto& shot, const std::string& method, const auto& take) {
            simulateLargeShot(shot, method, take, options, progress, console);
        };
    }
    std::vector<verify::Result> results;
    for (const std::string& method : methods) {
        context.method = method;
        for (const verify::Experiment* experiment : chosen) {
            console.detail(std::string(experiment->id) + " " + experiment->title + ", " + method);
            verify::Result result{experiment, method, {}, 0.0};
            const double before = cpuSeconds();
            verify::runExperiment(*experiment, context, result.findings);
            heedStop(verify::kTakesAreKept);
            result.cpuSeconds = cpuSeconds() - before;
            if (!options.json) std::printf("%s\n", verify::toText(result).c_str());
            std::fflush(stdout);
            results.push_back(std::move(result));
            progress.partDone();
        }
    }

    if (options.json) std::printf("%s", verify::toJson(results).c_str());
    if (!options.report.empty()) {
        AtomicFile file(options.report);
        file.write(verify::toHtml(results, context));
        file.commit();
        console.info("wrote " + options.report);
    }
    const verify::Summary summary = verify::summarize(results);
    if (!options.json) std::printf("%s", verify::toText(summary).c_str());
    return summary.isComplete() ? kExitDone : kExitQuality;
}

}  // namespace

Command addVerifyCommand(CLI::App& program)
{
    auto options = std::make_shared<VerifyOptions>();
    CLI::App* command =
        program.add_subcommand("verify", "Run the experiments that prove the method");
    command->add_option("EXPERIMENT", options->ids, "Which ones, like E1 E5 [all]");
    command->add_option("-o,--output", options->report,
                        "Write a report.html with plots and pictures");
    command->add_option("--method", options->method, "paper, scree or both [both]");
    command->add_flag("--full", options->full, "Every step length, seed and size: takes long");
    command->add_flag("--json", options->json, "The rows as JSON instead of a table");
    command->add_flag("--list", options->list, "Say what the experiments are, run none");
    command->add_option("--shots", options->shots,
                        "Folder of the experiments' shots [shots/verify]");
    command->add_option("--takes", options->takes,
                        "Folder of the large shots' takes, NAME_METHOD each: --full goes on with "
                        "what is there, hours if nothing is [takes]");
    command->add_flag("--judge-only", options->judgeOnly,
                      "Judge the large takes that are there, simulate none");
    command->add_option("--threads", options->threads, "Number of threads [all]");
    addProgress(*command, options->progress);
    command->footer(
        "Exit code 0 when all musts pass, 79 when one fails or could not be run.\n"
        "Example:\n  scree verify E1 E5 -o report.html");
    return {command, [options](Console& console) { return runVerify(*options, console); }};
}

}  // namespace scree
