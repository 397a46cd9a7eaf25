/// Parallel loops. No header includes the threading library.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace alcove {

/// Called with the share of the work that is done, in [0, 1]; never by two threads at once.
using Progress = std::function<void(double done)>;

/// Thrown by cancelled work. Not a std::exception, so that error handlers do not catch it.
struct Cancelled {};

/// While this object exists, setting `requested` cancels the work that this thread started. Cancelled is then thrown at
/// the next block of parallel_for(), whichever thread runs it, or at the next check_cancelled().
class Cancellable {
  public:
    explicit Cancellable(const std::atomic<bool>* requested); ///< null: never cancelled
    ~Cancellable();
    Cancellable(const Cancellable&) = delete;
    Cancellable& operator=(const Cancellable&) = delete;

  private:
    const std::atomic<bool>* outer_;
};

/// \throw Cancelled if the work of this thread is cancelled. Cost: a few instructions.
void check_cancelled();

/// Calls `body(begin, end)` for disjoint ranges that cover [0, count). Each range starts at a multiple of `grain` and
/// is at most `grain` long, so the ranges do not depend on the number of threads. Returns when all ranges are done;
/// rethrows an exception of `body`.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// The number of threads that work on a parallel loop, at most one per core; ≥ 1.
std::size_t thread_count();

/// While this object exists, at most `threads` threads work on parallel loops; 0 means one per core.
class ThreadLimit {
  public:
    explicit ThreadLimit(unsigned threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

  private:
    void* control_ = nullptr;
};

}
