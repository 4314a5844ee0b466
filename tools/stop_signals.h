// What the outside asks of a running simulation: SIGINT, SIGTERM and SIGHUP to stop after the next
// sub-step that it can go on from, SIGUSR1 to save there and go on.
#pragma once

#include <string>

namespace scree {

/// From now on the signals are noted instead of obeyed, so that what is begun is ended tidily. For
/// every command: who takes long asks whether to stop. A second request is obeyed at once; what
/// stands on disk is whole at every instant. Writing to a pipe nobody reads becomes an error of the
/// call that writes.
void watchSignals();

/// From now on so does writing beyond a size limit, which would otherwise end the program and leave
/// half a file. For every command.
void takeFileLimitsAsErrors();

bool stopRequested();

/// Thrown where a request to stop is heeded and nothing is left behind; main ends with 75 for it.
struct Stopped {
    std::string outcome;  ///< "no page was written"
};

/// Throws Stopped when there was a request.
void heedStop(const std::string& outcome = "nothing was written");

/// True once for each SIGUSR1.
bool takeSaveRequest();

}  // namespace scree
