// Threads that stay together from one loop to the next.
//
// A step of a thousand bodies is some two hundred loops of 5 to 500 µs, and two in each sweep over
// the contacts. Threads that fall asleep between two of them cost more to wake than many of them
// take, so those of a team wait awake for a while. And each begins with its own share of the
// indices, the same in every loop of that length: what it wrote in the last sweep is in its cache.
// Given to TBB, the same loops took 4 % longer (a thousand rings, two threads).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace scree {

class ThreadTeam {
public:
    /// Of `count` threads, the one that calls share among them; at least 2. Throws Error{usage}
    /// when the system allows fewer.
    explicit ThreadTeam(int count);
    ~ThreadTeam();
    ThreadTeam(const ThreadTeam&) = delete;
    ThreadTeam& operator=(const ThreadTeam&) = delete;

    using Body = std::function<void(std::size_t begin, std::size_t end)>;

    /// Calls body(begin, end) for ranges of `grain` indices that together cover 0 … count − 1, and
    /// comes back when all are done. False, and nothing was done, inside of a range and while
    /// another thread shares: the team has no hands left. What the body throws comes out of here,
    /// once everybody has stopped; ranges not begun by then are left.
    bool share(std::size_t count, std::size_t grain, const Body& body);

private:
    /// Ranges next to end − 1 are for one thread, until it has done them and takes from others.
    /// Two lines of the cache each.
    struct alignas(128) Share {
        std::atomic<std::size_t> next = 0;
        std::size_t end = 0;
        std::atomic<int> calls = 0;  // what its thread waits for
    };
    struct Loop {
        const Body* body = nullptr;
        std::size_t count = 0, grain = 1;
        std::size_t shares = 0;  // in use: of few ranges not everybody gets one
    };

    void dismiss();
    void call(std::size_t shares);
    void help(std::size_t self);
    void waitForCall(const Share& own, int last) const;
    bool enter(std::uint64_t& lastLoop);
    void work(std::size_t first);
    void workOff(Share& share);
    void keep(std::exception_ptr error);

    std::mutex sharing_;
    Loop loop_;
    std::vector<Share> shares_;
    // Whether helpers may enter, how many are inside, and the number of the loop. Who comes late
    // finds the door shut: nobody waits for him.
    alignas(128) std::atomic<std::uint64_t> door_ = 0;
    alignas(128) std::atomic<bool> isOver_ = false;
    std::atomic<bool> hasFailed_ = false;
    std::mutex keeping_;
    std::exception_ptr error_;
    int pauses_ = 0;  // that a helper waits awake
    std::vector<std::thread> helpers_;
};

}  // namespace scree
