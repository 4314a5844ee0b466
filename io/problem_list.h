// Collects all problems of a shot before giving up, so that nobody has to mend a file one error at
// a time.
#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"

namespace scree {

class ProblemList {
public:
    /// Problems in `mainFile` are reported first, those of other files after it.
    explicit ProblemList(std::string mainFile) : mainFile_(std::move(mainFile)) {}

    /// `message` as one line, without the location.
    void add(const SourceLocation& where, const std::string& message,
             ErrorKind kind = ErrorKind::badInput);

    /// Something the shot's user should know that is no reason to refuse it; in the order of calls.
    void warn(const SourceLocation& where, const std::string& message);

    const std::vector<std::string>& warnings() const { return warnings_; }

    std::size_t count() const { return problems_.size(); }
    bool isEmpty() const { return problems_.empty(); }

    /// Throws one Error, a line "file:line:column: message" for each problem, in order of position.
    /// Its kind is missingInput when nothing is wrong but missing files, else badInput.
    void throwIfAny() const;

private:
    struct Problem {
        SourceLocation where;
        std::string message;
        ErrorKind kind;
    };

    std::string mainFile_;
    std::vector<Problem> problems_;
    std::vector<std::string> warnings_;  // with their location
};

}  // namespace scree
