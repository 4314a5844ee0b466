// What the outside asks of a running simulation: SIGINT, SIGTERM and SIGHUP to stop after the next
// sub-step that it can go on from, SIGUSR1 to save there and go on.
#pragma once

namespace scree {

/// To be called before anything that takes long. From now on the signals are noted instead of
/// obeyed. A second request to stop is obeyed at once; what stands on disk is whole at every
/// instant. Writing to a pipe nobody reads becomes an error of the call that writes.
void watchSignals();

/// From now on so does writing beyond a size limit, which would otherwise end the program and leave
/// half a file. For every command.
void takeFileLimitsAsErrors();

bool stopRequested();

/// True once for each SIGUSR1.
bool takeSaveRequest();

}  // namespace scree
