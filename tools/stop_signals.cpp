#include "tools/stop_signals.h"

#include <atomic>
#include <csignal>
#include <initializer_list>

namespace scree {
namespace {

// Signal handlers reach nothing but globals; threads read them.
std::atomic<bool> stopWanted = false, saveWanted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void noteStop(int)
{
    stopWanted = true;
}
void noteSave(int)
{
    saveWanted = true;
}

void handle(int signal, void (*handler)(int), int flags)
{
    struct sigaction action = {};
    action.sa_handler = handler;
    action.sa_flags = flags;
    sigemptyset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
}

bool isIgnored(int signal)
{
    struct sigaction action = {};
    return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void watchSignals()
{
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        if (signal == SIGHUP && isIgnored(signal)) continue;  // nohup: to outlive the terminal
        handle(signal, noteStop, static_cast<int>(SA_RESTART | SA_RESETHAND));
    }
    handle(SIGUSR1, noteSave, SA_RESTART);
    handle(SIGPIPE, SIG_IGN, 0);
}

void takeFileLimitsAsErrors()
{
    handle(SIGXFSZ, SIG_IGN, 0);
}

bool stopRequested()
{
    return stopWanted;
}

void heedStop(const std::string& outcome)
{
    if (stopRequested()) throw Stopped{outcome};
}

bool takeSaveRequest()
{
    return saveWanted.exchange(false);
}

}  // namespace scree
