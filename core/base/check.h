// Checks against our own mistakes. SCREE_CHECK is always on and must be cheap; SCREE_VALIDATE is
// for invariants that cost as much as the work they guard: it runs where SCREE_VALIDATION is
// defined, which is in the tests of core and in a build configured with -DSCREE_VALIDATION=ON. Only
// sources use it, not headers, so that both kinds of object can be had of each
// (tests/CMakeLists.txt).
#pragma once

#include <string>

namespace scree {

/// Throws Error{internal} naming the condition and the place in the code.
[[noreturn]] void failCheck(const char* condition, const char* file, int line,
                            const std::string& details);

}  // namespace scree

#define SCREE_CHECK(condition, details)                                                \
    do {                                                                               \
        if (!(condition)) ::scree::failCheck(#condition, __FILE__, __LINE__, details); \
    } while (false)

#ifdef SCREE_VALIDATION
#define SCREE_VALIDATE(condition, details) SCREE_CHECK(condition, details)
#else
#define SCREE_VALIDATE(condition, details)          \
    do {                                            \
        if (false) SCREE_CHECK(condition, details); \
    } while (false)
#endif
