#include "core/base/check.h"

#include "core/base/error.h"

namespace scree {

void failCheck(const char* condition, const char* file, int line, const std::string& details)
{
    throw Error(ErrorKind::internal, {file, line, 0},
                std::string("internal check failed: ") + condition +
                    (details.empty() ? "" : " (" + details + ")"));
}

}  // namespace scree
