// Errors that a user can cause and mend: they say where, what was expected and what to do.
#pragma once

#include <stdexcept>
#include <string>

namespace scree {

/// What kind of trouble; the program's exit code follows from it (tools/exit_code.h).
enum class ErrorKind {
    usage,         ///< the command line
    badInput,      ///< a shot or an asset says something impossible
    missingInput,  ///< a file that should be read is not there
    internal,      ///< our own mistake
    cannotCreate,  ///< an output cannot be created
    inputOutput,   ///< reading or writing failed half way: disk full, file damaged
    qualityLimit,  ///< the simulation broke a limit the shot sets (overlap, NaN)
};

/// A place in a text file; line and column count from 1, 0 means unknown.
struct SourceLocation {
    std::string file;
    int line = 0;
    int column = 0;
};

/// "file:line:column", leaving out what is unknown.
std::string toString(const SourceLocation& location);

/// Thrown for everything a user can mend; `main` alone catches it. what() is the complete message
/// without the leading "Error:".
class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, const std::string& message);
    Error(ErrorKind kind, const SourceLocation& location, const std::string& message);

    ErrorKind kind() const { return kind_; }

private:
    ErrorKind kind_;
};

}  // namespace scree
