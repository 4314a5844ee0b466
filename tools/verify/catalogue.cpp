// The table of all experiments, and choosing among them.
#include <unistd.h>
#include <algorithm>

#include "core/base/error.h"
#include "io/nearest_word.h"
#include "io/shot_schema.h"
#include "tools/verify/experiments.h"

namespace scree::verify {

const std::vector<Experiment>& experiments()
{
    static const std::vector<Experiment> all = {
        {"E1", "Block at rest", true,
         "A block whose collisions are elastic stays where it was put on a slope.",
         "Figure 3: a block on an inclined plane, elastic (e = 1), with friction enough to hold "
         "it. "
         "Left, the textbook order of the step: it tumbles down. Right, the paper's: it rests.",
         runBlockAtRest},
        {"E2", "Sliding with friction", true,
         "A sliding block follows Coulomb's law, speeding up and slowing down to a stop.",
         "Figure 4: a block sliding down a plane against the curve of theory; the two cannot be "
         "told apart.",
         runSliding},
        {"E3", "Line of billiard balls", true,
         "The last of five touching balls leaves with the whole momentum.",
         "Figure 5: billiard balls in a line, struck at one end; only the last one flies off.",
         runBilliards},
        {"E4", "Cube stack and heavy box on a plank", true,
         "Stacks stand; a heavy box on a plank throws a stack into the air.",
         "Figure 6: a heavy box falls on a plank and catapults a stack of boxes.",
         runStackAndPlank},
        {"E5", "See-saw", true, "Weight is felt through a plank: the heavy side goes down.",
         "Figure 7: a light and a heavy block on a see-saw. With shock propagation alone it stands "
         "still; contact before it lets it tip.",
         runSeeSaw},
        {"E6", "Contact graph", true,
         "Bodies that rest on each other in a circle are one level. Inputs are built in code.",
         "The section on the contact graph: dominoes in a circle, each leaning on the next.",
         runContactGraph},
        {"E7", "Rings on poles", true,
         "Five hundred and a thousand rings rain on twenty-five poles and come to rest.",
         "Figure 1: five hundred rings of nonconvex shape, thrown on poles, some threaded, the "
         "others in a heap. A frame took three minutes, with a thousand rings seven.",
         runRings},
        {"E8", "Bones through a funnel", true,
         "Five hundred bones, 2.77 million triangles, fall through a funnel into a pit.",
         "Figure 2: the three bones; figure 8: five hundred of them in a funnel; figure 9: the "
         "same "
         "as wireframe, 2.8 million triangles. A frame took about seven minutes.",
         runBones},
        {"E9", "Rolling and spinning friction", true,
         "Balls stop rolling and spinning when and where theory says, and never turn back.", "",
         runRolling},
        {"E10", "Mass properties", true,
         "Volumes, moments and axes are those of closed forms. Meshes are built in code.", "",
         runMassProperties},
        {"E11", "Push-out", true,
         "Push-out separates what overlaps, moves only what may move, and touches no velocity.", "",
         runPushOut},
        {"E12", "Fast and thin", true,
         "What is fast and thin does not pass through, because time steps are limited.", "",
         runFastAndThin},
        {"E13", "Free flight", true,
         "Without contact positions and momenta are exact. Inputs are built in code.", "",
         runFreeFlight},
        {"E14", "Torque-free tumbling", true,
         "A box spinning about its middle axis keeps its energy and flips when it should. Inputs "
         "are "
         "built in code.",
         "", runTumbling},
        {"E15", "Impulses", true,
         "Impulses obey Newton, Coulomb and the conservation laws. Random pairs are built in code.",
         "", runImpulses},
        {"E16", "Bounce", true, "An elastic ball loses no more height than a step of its fall.", "",
         runBounce},
        {"E17", "Accelerated frames", true,
         "Lifts carry, turntables fling and rams push as they should.", "", runAcceleratedFrames},
        {"E18", "Free cluster and shock", true,
         "Shock propagation creates no momentum in a cluster that nothing supports.", "",
         runFreeCluster},
        {"E19", "Determinism", true,
         "Same shot, same bits: any number of threads, cut in two or not.", "", runDeterminism},
        {"E20", "Heap quality", false, "Mixed nonconvex bodies come to rest in a bin.", "",
         runHeapQuality},
        {"E21", "Distance field", true,
         "The distance field is exact where it decides, in both storages. Shapes are built in "
         "code.",
         "", runDistanceField},
        {"E22", "Variants", true,
         "Lagged collisions end in like heaps; the paper without repairs passes what it should.",
         "", runVariants},
        {"E23", "Edge against edge", true, "Crossed beams meet although no vertex is near.", "",
         runEdgeAgainstEdge},
        {"E24", "No missed bounce", true,
         "Contact treats inelastically only what collision has seen.", "", runNoMissedBounce},
        {"E25", "Drop to rest with all defaults", true,
         "Cube, ring and a wedge of twelve triangles come to rest on the floor.", "",
         runDropToRest},
        {"E26", "What shock propagation buys", true,
         "With shock propagation a stack needs a fraction of the contact sweeps.", "",
         runWhatShockBuys},
        {"E27", "Tall and heavy", true,
         "Method scree: tall stacks and heavy tops stand at one step a frame.", "",
         runTallAndHeavy},
        {"E28", "Bounce height", true,
         "Method scree: a rebound is within 1 % of e^2 h and never above the start.", "",
         runBounceHeight},
    };
    return all;
}

void runExperiment(const Experiment& experiment, const Context& context, Findings& findings)
{
    try {
        experiment.run(context, findings);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::qualityLimit) throw;
        findings.equal(Weight::must, "comes to its end", 0, 1, error.what());
    }
}

std::vector<const Experiment*> chooseExperiments(const std::vector<std::string>& ids)
{
    std::vector<const Experiment*> chosen;
    std::vector<std::string> wanted, known;
    for (const std::string& id : ids) {
        const bool hasLetter = !id.empty() && (id[0] == 'E' || id[0] == 'e');
        wanted.push_back("E" + (hasLetter ? id.substr(1) : id));
    }
    for (const Experiment& experiment : experiments()) {
        known.push_back(experiment.id);
        const bool isWanted = std::count(wanted.begin(), wanted.end(), experiment.id) > 0;
        if (wanted.empty() || isWanted) chosen.push_back(&experiment);
    }
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (std::count(known.begin(), known.end(), wanted[i])) continue;
        throw Error(ErrorKind::usage, "there is no experiment '" + ids[i] + "'" +
                                          didYouMean(wanted[i], known) +
                                          " (known: " + joined(known) + ")");
    }
    return chosen;
}

std::vector<std::string> methodsToRun(const std::string& asked)
{
    const std::vector<std::string> known = splitWords(findShotKey("solver.method")->choices);
    if (asked == "both") return known;
    if (std::count(known.begin(), known.end(), asked)) return {asked};
    throw Error(ErrorKind::usage, "this version has no method '" + asked + "'" +
                                      didYouMean(asked, known) + " (known: " + joined(known) + ")");
}

std::filesystem::path findShots()
{
    const std::filesystem::path here = "shots/verify";
    if (std::filesystem::is_directory(here)) return here;
    std::error_code unreadable;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", unreadable);
    const auto beside = program.parent_path().parent_path() / here;
    if (!unreadable && std::filesystem::is_directory(beside)) return beside;
    throw Error(ErrorKind::missingInput,
                "the experiments' shots are not found: no folder shots/verify here or beside the "
                "program's; name it with --shots");
}

}  // namespace scree::verify
