#include "io/problem_list.h"

#include <algorithm>
#include <tuple>

namespace scree {

void ProblemList::add(const SourceLocation& where, const std::string& message, ErrorKind kind)
{
    // A lack of memory and our own mistakes are no fault of the shot, and end everything at once.
    if (kind == ErrorKind::internal) throw Error(kind, where, message);
    problems_.push_back({where, message, kind});
}

void ProblemList::warn(const SourceLocation& where, const std::string& message)
{
    warnings_.push_back(toString(where) + ": " + message);
}

void ProblemList::throwIfAny() const
{
    if (problems_.empty()) return;

    std::vector<Problem> sorted = problems_;
    const auto key = [this](const Problem& problem) {
        const SourceLocation& where = problem.where;
        return std::make_tuple(where.file != mainFile_, where.file, where.line, where.column);
    };
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const Problem& a, const Problem& b) { return key(a) < key(b); });

    std::string text;
    bool onlyMissing = true;
    for (const Problem& problem : sorted) {
        if (!text.empty()) text += '\n';
        text += toString(problem.where) + ": " + problem.message;
        onlyMissing = onlyMissing && problem.kind == ErrorKind::missingInput;
    }
    throw Error(onlyMissing ? ErrorKind::missingInput : ErrorKind::badInput, text);
}

}  // namespace scree
