#include "tools/broken_frame.h"

namespace scree {

std::string complaintOf(const FrameReport& report, const World& world, int frame)
{
    const std::string where = "frame " + std::to_string(frame);
    if (!report.sum.nonFinite.empty()) {
        std::string names;
        for (const BodyId body : report.sum.nonFinite)
            names += (names.empty() ? "" : ", ") + world.info[body].name;
        return where + ", step " + std::to_string(report.steps) + ", after " +
               nameOf(report.sum.nonFinitePhase) + ": no longer finite: " + names;
    }
    const BirthReport& births = report.births;
    if (births.failed < 0) return "";
    return where + ": '" + world.info[births.failed].name + "' cannot be born, '" +
           world.info[births.occupant].name +
           "' stands in its place; clear = \"wait\" lets it wait, \"skip\" leaves it out";
}

}  // namespace scree
