// Runs abc_check.py, the independent validator and reader of Alembic files.
#pragma once

#include "tests/support/readers.h"

namespace scree::test {

/// `options` as on its command line, for instance "--strict" or "--dump-xforms --world".
inline CommandResult runAbcCheck(const std::filesystem::path& file, const std::string& options)
{
    return runCommand("python3 " + quoted(sourceFile("tests/support/abc_check.py")) + " " +
                      quoted(file) + " " + options);
}

}  // namespace scree::test
