#include "run.h"

#include "alcove/base/parallel.h"

#include <pybind11/pybind11.h>

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <future>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace alcove::python {
namespace {

namespace py = pybind11;

/// A thread that does one piece of work after another for as long as the process runs.
class Worker {
  public:
    Worker() {
        std::thread([this] { serve(); }).detach();
    }

    std::future<void> start(const std::function<void()>& work) {
        std::packaged_task<void()> task(work);
        std::future<void> result = task.get_future();
        const std::lock_guard lock(mutex_);
        task_ = std::move(task);
        is_ready_.notify_one();
        return result;
    }

  private:
    [[noreturn]] void serve() {
        for (;;) {
            std::unique_lock lock(mutex_);
            is_ready_.wait(lock, [this] { return task_.valid(); });
            std::packaged_task<void()> task = std::move(task_);
            lock.unlock();
            task();
        }
    }

    std::mutex mutex_;
    std::condition_variable is_ready_;
    std::packaged_task<void()> task_;
};

/// Gives each call a worker of its own. Workers are reused, because Embree keeps memory for every thread that ever used
/// it. The GIL guards `idle`.
class Lease {
  public:
    Lease() {
        if (std::exchange(process, getpid()) != getpid())
            idle.clear(); // after a fork, because it copies no threads
        if (idle.empty())
            idle.push_back(new Worker); // never freed: its thread has no end
        worker_ = idle.back();
        idle.pop_back();
    }
    ~Lease() { idle.push_back(worker_); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;

    Worker& worker() { return *worker_; }

  private:
    static inline pid_t process = 0;
    static inline std::vector<Worker*> idle;
    Worker* worker_;
};

}

void run(const std::function<void()>& work, Gil gil) {
    constexpr std::chrono::milliseconds between_checks(50);
    std::atomic<bool> is_cancelled{false};
    Lease lease;
    std::future<void> result = lease.worker().start([&] {
        const Cancellable scope(&is_cancelled);
        work();
    });
    for (;;) {
        {
            std::optional<py::gil_scoped_release> released;
            if (gil == Gil::released)
                released.emplace(); // the work may need the GIL, to report progress
            if (is_cancelled)
                result.wait();
            if (result.wait_for(between_checks) == std::future_status::ready)
                break;
        }
        is_cancelled = PyErr_CheckSignals() != 0;
    }
    if (is_cancelled)
        throw py::error_already_set();
    result.get();
}

}
