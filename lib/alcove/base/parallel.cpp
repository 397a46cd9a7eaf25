#include "alcove/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace alcove {
namespace {

thread_local const std::atomic<bool>* cancel_requested = nullptr;

}

Cancellable::Cancellable(const std::atomic<bool>* requested) : outer_(std::exchange(cancel_requested, requested)) {}

Cancellable::~Cancellable() {
    cancel_requested = outer_;
}

void check_cancelled() {
    if (cancel_requested != nullptr && cancel_requested->load(std::memory_order_relaxed))
        throw Cancelled();
}

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
    const std::size_t blocks = (count + grain - 1) / grain;
    const std::atomic<bool>* const requested = cancel_requested;
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
        const Cancellable scope(requested); // as a thread may work for several callers in turn
        check_cancelled();
        body(block * grain, std::min(count, (block + 1) * grain));
    });
}

std::size_t thread_count() {
    return std::min<std::size_t>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism),
                                 static_cast<std::size_t>(tbb::info::default_concurrency()));
}

ThreadLimit::ThreadLimit(unsigned threads) {
    constexpr unsigned max_threads = 4096; // above this, TBB allocates memory without limit
    if (threads > 0)
        control_ =
            new tbb::global_control(tbb::global_control::max_allowed_parallelism, std::min(threads, max_threads));
}

ThreadLimit::~ThreadLimit() {
    delete static_cast<tbb::global_control*>(control_);
}

}
