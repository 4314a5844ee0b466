#include "tools/stop_signals.h"

#include <csignal>
#include <initializer_list>

namespace scree {
namespace {

// Signal handlers reach nothing but globals.
volatile std::sig_atomic_t stopWanted = 0;
volatile std::sig_atomic_t saveWanted = 0;

void noteStop(int)
{
    stopWanted = 1;
}
void noteSave(int)
{
    saveWanted = 1;
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
    return stopWanted != 0;
}

void heedStop(const std::string& outcome)
{
    if (stopRequested()) throw Stopped{outcome};
}

bool takeSaveRequest()
{
    const bool wanted = saveWanted != 0;
    saveWanted = 0;
    return wanted;
}

}  // namespace scree
