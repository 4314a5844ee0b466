// The build system knows all of this; it hands it over as macros for this file alone.
#include "tools/version.h"

namespace scree {

std::string programVersion()
{
    return SCREE_VERSION;
}

std::string describeBuild()
{
    return "scree " SCREE_VERSION "\nbuild: " SCREE_BUILD "\nlibraries: " SCREE_LIBRARIES;
}

}  // namespace scree
