// How long the processor has worked.
#pragma once

namespace scree {

/// Of all threads of the program since it began [s].
double cpuSeconds();

}  // namespace scree
