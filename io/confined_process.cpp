#include "io/confined_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>

#include "core/base/error.h"

namespace scree {
namespace {

// The first byte of the answer.
constexpr char kResult = 'R', kRefusal = 'E', kNoMemory = 'M';

std::uint64_t addressSpaceInUse()
{
    unsigned long long pages = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
        std::fclose(file);
    }
    return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

/// False when the process is held to less already.
bool limit(int resource, std::uint64_t value)
{
    const rlimit both{value, value};
    rlimit before{};
    ::getrlimit(static_cast<__rlimit_resource>(resource), &before);
    if (before.rlim_cur < value) return false;
    return ::setrlimit(static_cast<__rlimit_resource>(resource), &both) == 0;
}

/// True when the memory is limited by `limits`, and not by what the whole program may have.
bool confine(const ConfinedLimits& limits)
{
    ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    ::prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    limit(RLIMIT_CPU, static_cast<std::uint64_t>(limits.seconds));
    const bool isOwnLimit = limit(RLIMIT_AS, addressSpaceInUse() + limits.memoryBytes);
    for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGTERM, SIGINT, SIGXCPU}) {
        std::signal(signal, SIG_DFL);
    }
    // Whatever a parser prints is nobody's business.
    const int nowhere = ::open("/dev/null", O_RDWR);
    for (const int stream : {0, 1, 2}) ::dup2(nowhere, stream);
    return isOwnLimit;
}

void writeAll(int descriptor, const char* bytes, std::size_t count)
{
    while (count > 0) {
        const ssize_t written = ::write(descriptor, bytes, count);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) ::_exit(1);
        bytes += written;
        count -= static_cast<std::size_t>(written);
    }
}

/// Never returns: neither destructors nor exit handlers of the parent may run twice.
[[noreturn]] void runChild(int output, const std::function<std::string()>& work,
                           const ConfinedLimits& limits)
{
    const bool isOwnLimit = confine(limits);
    char tag = kResult;
    std::string answer;
    try {
        answer = work();
    } catch (const std::bad_alloc&) {
        tag = isOwnLimit ? kRefusal : kNoMemory;
        answer = isOwnLimit
                     ? "it needs more memory than the " + std::to_string(limits.memoryBytes >> 20) +
                           " MB that an import may take; a damaged header may ask for them"
                     : "memory ran out";
    } catch (const std::exception& error) {
        tag = kRefusal;
        answer = error.what();
    }
    writeAll(output, &tag, 1);
    writeAll(output, answer.data(), answer.size());
    ::_exit(0);
}

/// Everything the child says; false when it took too long or said too much.
bool readAnswer(int input, const ConfinedLimits& limits, std::string& answer)
{
    using Clock = std::chrono::steady_clock;
    const auto deadline =
        Clock::now() + std::chrono::milliseconds(std::lround(1e3 * limits.clockSeconds));
    std::array<char, 65536> piece;
    while (answer.size() <= limits.resultBytes) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
        pollfd ready{input, POLLIN, 0};
        const int polled =
            left.count() <= 0 ? 0 : ::poll(&ready, 1, static_cast<int>(left.count()));
        if (polled < 0 && errno == EINTR) continue;
        if (polled <= 0) return false;
        const ssize_t count = ::read(input, piece.data(), piece.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return count == 0;
        answer.append(piece.data(), static_cast<std::size_t>(count));
    }
    return false;
}

std::string causeOf(int status)
{
    if (!WIFSIGNALED(status)) return "its reader ended without an answer";
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU || signal == SIGKILL)
        return "its reader took too long or too much memory";
    return std::string("its reader crashed (") + ::strsignal(signal) + ")";
}

}  // namespace

std::string runConfined(const std::string& what, const std::function<std::string()>& work,
                        const ConfinedLimits& limits)
{
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        throw Error(ErrorKind::inputOutput, what + ": no pipe: " + std::strerror(errno));
    }
    const pid_t child = ::fork();
    if (child == 0) runChild(ends[1], work, limits);
    ::close(ends[1]);
    if (child < 0) {
        ::close(ends[0]);
        throw Error(ErrorKind::inputOutput, what + ": no process: " + std::strerror(errno));
    }

    std::string answer;
    const bool isWhole = readAnswer(ends[0], limits, answer);
    ::close(ends[0]);
    if (!isWhole) ::kill(child, SIGKILL);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!isWhole || status != 0 || answer.empty()) {
        throw Error(ErrorKind::badInput, what + ": " + causeOf(status));
    }
    if (answer.front() == kNoMemory) {
        throw Error(ErrorKind::internal, what + ": " + answer.substr(1));
    }
    if (answer.front() != kResult) {
        throw Error(ErrorKind::badInput, what + ": " + answer.substr(1));
    }
    return answer.substr(1);
}

}  // namespace scree
