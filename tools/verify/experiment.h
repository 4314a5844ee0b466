// The experiments that prove the method: each takes its scene from a shot under shots/verify (so
// that a user can also simulate it), runs it through the reader and the stepper that ship, and
// holds what it measures against theory. The few that test a part alone build their input in code
// and say so in their claim.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/verify/findings.h"

namespace scree::verify {

/// How much of an experiment is run.
enum class Form {
    brief,  ///< what a test suite has the time for
    full,   ///< every step length, seed and size that the experiment names
};

struct Context {
    std::filesystem::path shots;  ///< folder of the experiments' shot files
    Form form = Form::brief;
    std::string method = "paper";  ///< the solver.method of every shot
    std::uint64_t seed = 0;        ///< the shot.seed of every shot; 0: its own
    bool wantsPictures = false;    ///< drawing them takes longer than some experiments

    /// Folder of the takes of large shots, each in NAME_METHOD, that full forms judge.
    std::filesystem::path takes = "takes";
    /// Simulates a shot file with this method into a take, going on with one that is there; empty:
    /// only takes that are there are judged.
    std::function<void(const std::filesystem::path& shot, const std::string& method,
                       const std::filesystem::path& take)>
        simulate = {};

    bool isFull() const { return form == Form::full; }

    /// Of runs that leave out what only method paper needs (short steps, shock, vertex and edge
    /// samples): method scree does without, so for it they are only told.
    Weight controlOfPaper() const { return method == "paper" ? Weight::control : Weight::goal; }
};

struct Experiment {
    const char* id;     ///< "E2"
    const char* title;  ///< a few words
    bool isMust;        ///< or a goal
    const char* claim;  ///< what it shows, in a sentence
    const char* paper;  ///< the figure of the paper it repeats and what is seen there; or empty
    void (*run)(const Context& context, Findings& findings);
};

/// All experiments in the order of their numbers.
const std::vector<Experiment>& experiments();

/// Runs one. What breaks off because a body is no longer finite has failed: a row says so.
void runExperiment(const Experiment& experiment, const Context& context, Findings& findings);

/// Those with the given ids ("E2", "e2", "2"), all when there are none. Throws Error{usage} naming
/// the nearest id.
std::vector<const Experiment*> chooseExperiments(const std::vector<std::string>& ids);

/// The methods that this version knows and that `asked` ("paper", "scree" or "both") means. Throws
/// Error{usage} when a method was asked for by its name that this version does not have.
std::vector<std::string> methodsToRun(const std::string& asked);

/// The folder shots/verify of the working directory, else of the folder above the program's. Throws
/// Error{missingInput} when there is neither.
std::filesystem::path findShots();

}  // namespace scree::verify
