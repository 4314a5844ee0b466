#include "core/base/thread_team.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/error.h"

namespace scree {
namespace {

/// Who has waited for so long, 10 to 50 µs by the processor, lets others go first.
constexpr int kPausesBeforeYield = 1000;
/// About a millisecond; four were no faster. With more threads than processors somebody else needs
/// the time.
constexpr int kPausesAwake = 5000;

constexpr std::uint64_t kIsOpen = 1ull << 63, kOneInside = 1ull << 48;
constexpr std::uint64_t kInside = kIsOpen - kOneInside, kLoopNumber = kOneInside - 1;

/// Whether this thread is at work for a team.
thread_local bool isAtWork = false;

void pauseAfter(int pauses)
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
    if (pauses > kPausesBeforeYield) std::this_thread::yield();
}

}  // namespace

ThreadTeam::ThreadTeam(int count) : shares_(static_cast<std::size_t>(std::max(count, 2)))
{
    if (shares_.size() <= std::thread::hardware_concurrency()) pauses_ = kPausesAwake;
    try {
        for (std::size_t self = 1; self < shares_.size(); ++self)
            helpers_.emplace_back([this, self] { help(self); });
    } catch (const std::system_error& error) {
        const std::size_t started = helpers_.size() + 1;
        dismiss();
        throw Error(ErrorKind::usage, "cannot run " + std::to_string(shares_.size()) +
                                          " threads: this process may have " +
                                          std::to_string(started) + " (" + error.code().message() +
                                          "); choose fewer with --threads");
    }
}

ThreadTeam::~ThreadTeam()
{
    dismiss();
}

void ThreadTeam::dismiss()
{
    isOver_ = true;
    call(shares_.size());
    for (std::thread& helper : helpers_) helper.join();
}

bool ThreadTeam::share(std::size_t count, std::size_t grain, const Body& body)
{
    if (isAtWork) return false;  // who holds a mutex must not try it
    const std::unique_lock lock(sharing_, std::try_to_lock);
    if (!lock) return false;

    const std::size_t ranges = (count + grain - 1) / grain;
    loop_ = {&body, count, grain, std::min(ranges, shares_.size())};
    for (std::size_t s = 0; s < loop_.shares; ++s) {
        shares_[s].next = ranges * s / loop_.shares;
        shares_[s].end = ranges * (s + 1) / loop_.shares;
    }
    hasFailed_ = false;
    door_ = kIsOpen | ((door_ + 1) & kLoopNumber);
    call(loop_.shares);
    isAtWork = true;
    work(0);
    isAtWork = false;
    door_ &= ~kIsOpen;
    for (int pauses = 0; (door_ & kInside) != 0; ++pauses) pauseAfter(pauses);
    if (hasFailed_) std::rethrow_exception(std::exchange(error_, nullptr));
    return true;
}

/// The helpers that have one of the first shares. The others may sleep.
void ThreadTeam::call(std::size_t shares)
{
    for (std::size_t s = 1; s < shares; ++s) {
        ++shares_[s].calls;
        shares_[s].calls.notify_one();
    }
}

void ThreadTeam::help(std::size_t self)
{
    isAtWork = true;
    const Share& own = shares_[self];
    std::uint64_t lastLoop = 0;
    for (int last = 0; !isOver_; last = own.calls) {
        if (enter(lastLoop)) {
            work(self);
            door_ -= kOneInside;
        }
        waitForCall(own, last);
    }
}

void ThreadTeam::waitForCall(const Share& own, int last) const
{
    for (int pauses = 0; pauses < pauses_; ++pauses) {
        if (own.calls != last) return;
        pauseAfter(pauses);
    }
    own.calls.wait(last);
}

/// Into a loop that is still open and not the last one again.
bool ThreadTeam::enter(std::uint64_t& lastLoop)
{
    std::uint64_t door = door_;
    while ((door & kIsOpen) != 0 && (door & kLoopNumber) != lastLoop) {
        if (!door_.compare_exchange_weak(door, door + kOneInside)) continue;
        lastLoop = door & kLoopNumber;
        return true;
    }
    return false;
}

/// One's own share, then what others have left of theirs.
void ThreadTeam::work(std::size_t first)
{
    for (std::size_t s = 0; s < loop_.shares; ++s) workOff(shares_[(first + s) % loop_.shares]);
}

void ThreadTeam::workOff(Share& share)
{
    while (share.next < share.end && !hasFailed_) {
        const std::size_t range = share.next++;
        if (range >= share.end) return;
        try {
            const std::size_t begin = range * loop_.grain;
            (*loop_.body)(begin, std::min(begin + loop_.grain, loop_.count));
        } catch (...) {
            keep(std::current_exception());
        }
    }
}

void ThreadTeam::keep(std::exception_ptr error)
{
    const std::lock_guard lock(keeping_);
    if (!error_) error_ = std::move(error);
    hasFailed_ = true;
}

}  // namespace scree
