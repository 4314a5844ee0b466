// The program itself as a shell or a farm starts it: exit code and what it said.
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

namespace scree::test {

struct Outcome {
    int code = -1;  ///< exit code, or minus the signal that ended it
    std::string out, err;
};

/// A running scree. Must be waited for.
class Program {
public:
    /// `prepare` runs in the child before the program starts, for limits.
    explicit Program(const std::vector<std::string>& arguments,
                     const std::function<void()>& prepare = {});

    void signal(int number) const;
    Outcome wait();

private:
    pid_t child_ = -1;
    std::string outPath_, errPath_;
};

/// Starts and waits.
Outcome runScree(const std::vector<std::string>& arguments);

}  // namespace scree::test
