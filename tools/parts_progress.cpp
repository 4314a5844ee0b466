#include "tools/parts_progress.h"

namespace scree {

PartsProgress::PartsProgress(Console& console, ProgressMode mode, int partCount,
                             std::chrono::milliseconds longestSilence)
    : console_(console),
      mode_(chosenMode(mode, console)),
      partCount_(partCount),
      longestSilence_(longestSilence),
      isAwaited_(mode != ProgressMode::automatic)
{
    if (isShown()) thread_ = std::thread([this] { beat(); });
}

PartsProgress::~PartsProgress()
{
    if (!thread_.joinable()) return;
    {
        const std::lock_guard guard(lock_);
        isOver_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void PartsProgress::partDone()
{
    const std::lock_guard guard(lock_);
    ++partsDone_;
    if (isShown() && isAwaited_) say();
}

void PartsProgress::beat()
{
    std::unique_lock guard(lock_);
    while (!wake_.wait_until(guard, said_ + longestSilence_, [this] { return isOver_; })) {
        if (std::chrono::steady_clock::now() >= said_ + longestSilence_) say();
    }
}

void PartsProgress::say()
{
    said_ = std::chrono::steady_clock::now();
    isAwaited_ = true;
    const std::string share = std::to_string(partCount_ > 0 ? 100 * partsDone_ / partCount_ : 100);
    console_.line(mode_ == ProgressMode::alf ? "ALF_PROGRESS " + share + "%"
                                             : "{\"progress\":" + share + "}");
}

}  // namespace scree
