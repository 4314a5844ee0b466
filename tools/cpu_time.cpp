#include "tools/cpu_time.h"

#include <ctime>

namespace scree {

double cpuSeconds()
{
    std::timespec time = {};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace scree
