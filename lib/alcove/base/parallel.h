/// Threads behind one call, so that no other header knows which library runs them.
#pragma once

#include <cstddef>
#include <functional>

namespace alcove {

/// Calls `body(begin, end)` for disjoint ranges that cover [0, count), each at most `grain` long and starting
/// at a multiple of it: what a range holds does not depend on the number of threads. Blocks until all are
/// done; an exception thrown by `body` is rethrown here.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// How many threads work on a parallel loop from now on, as far as there are cores; ≥ 1.
std::size_t thread_count();

/// While alive, at most `threads` threads work on parallel loops; 0 means one per core.
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
