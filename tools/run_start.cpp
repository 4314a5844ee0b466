#include "tools/run_start.h"

#include "io/shape_cache.h"
#include "tools/repair_report.h"
#include "tools/shot_warnings.h"
#include "tools/start_rule.h"
#include "tools/stoppable_build.h"

namespace scree {

World worldAtStart(const Shot& shot, bool noCache, Console& console)
{
    ShapeCache cache(noCache ? std::filesystem::path() : defaultCacheFolder());
    World world = buildStoppably(shot, cache, console);
    for (const std::string& repair : repairsOf(world)) console.info(repair);
    for (const std::string& note : notesBeforeStart(shot)) console.info(note);
    applyStartRule(shot, world, console);
    for (const std::string& warning : warningsBeforeStart(shot, world)) console.warning(warning);
    return world;
}

}  // namespace scree
