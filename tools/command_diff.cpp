// Where two takes part.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/math/rotation.h"
#include "io/take_diff.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/stop_signals.h"

namespace scree {
namespace {

constexpr std::size_t kNamed = 5;

void printText(const TakeComparison& comparison)
{
    for (const std::string& note : comparison.notes) std::printf("note: %s\n", note.c_str());
    if (!comparison.difference) {
        std::printf("the states of %d frames are the same to the last bit\n",
                    comparison.framesCompared);
        return;
    }
    const TakeDifference& first = *comparison.difference;
    std::printf("first difference: frame %d", first.frame);
    if (first.offset) std::printf(", already at %+g of a frame", *first.offset);
    if (first.stepsA > 0 && first.stepsB > 0) {
        std::printf(" (%d sub-steps in A, %d in B)", first.stepsA, first.stepsB);
    }
    std::printf("\n");
    if (first.isMemoryOnly) {
        std::printf("all stand and move alike; what they remember of their contacts differs\n");
    } else if (first.bodies.empty()) {
        std::printf("only the order in which bodies are processed differs\n");
        return;
    }
    std::printf("bodies that differ: %zu:", first.bodies.size());
    for (std::size_t i = 0; i < std::min(first.bodies.size(), kNamed); ++i) {
        std::printf(" %s", first.bodies[i].c_str());
    }
    if (first.bodies.size() > kNamed) std::printf(" ...");
    std::printf("\n");
    if (first.isMemoryOnly) return;
    std::printf("farthest off: %s by %.3g m and %.3g degrees\n", first.farthestBody.c_str(),
                first.farthest, first.largestTurn * 180.0 / kPi);
}

void printJson(const TakeComparison& comparison)
{
    nlohmann::ordered_json json = {{"same", comparison.isSame()},
                                   {"frames_compared", comparison.framesCompared},
                                   {"notes", comparison.notes},
                                   {"difference", nullptr}};
    if (comparison.difference) {
        const TakeDifference& first = *comparison.difference;
        json["difference"] = {{"frame", first.frame},
                              {"substeps", {first.stepsA, first.stepsB}},
                              {"bodies", first.bodies},
                              {"farthest_body", first.farthestBody},
                              {"farthest_m", first.farthest},
                              {"turn_rad", first.largestTurn},
                              {"memory_only", first.isMemoryOnly}};
        if (first.offset) json["difference"]["offset_frames"] = *first.offset;
    }
    std::printf("%s\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

}  // namespace

Command addDiffCommand(CLI::App& program)
{
    struct Options {
        std::string a, b;
        bool json = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand(
        "diff",
        "Say in which frame and body two takes differ; ends with 1 when they do, or hold other "
        "frames");
    command->add_option("A", options->a, "A take directory")->required();
    command->add_option("B", options->b, "Another")->required();
    command->add_flag("--json", options->json, "As one JSON object");
    command->footer("Example:\n  scree diff takes/rings_100 takes/rings_100_again");
    return {command, [options](Console&) {
                const TakeReader a(options->a), b(options->b);
                const TakeComparison comparison =
                    compareTakes(a, b, [] { heedStop("no difference was found so far"); });
                if (options->json)
                    printJson(comparison);
                else
                    printText(comparison);
                return comparison.isSame() ? kExitDone : kExitDiffers;
            }};
}

}  // namespace scree
