#include "core/dynamics/settings.h"

namespace scree {

void makeStrict(StepSettings& settings)
{
    settings.orientation = OrientationUpdate::euler;
    settings.freezeUnsupported = true;
    settings.frictionFallback = FrictionFallback::plainKinetic;
    settings.slideSmoothSamples = false;
    settings.curvatureScaling = false;
}

}  // namespace scree
