#include "run.h"

#include "alcove/base/parallel.h"

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <future>
#include <optional>

namespace alcove::python {

namespace py = pybind11;

void run(const std::function<void()>& work, Gil gil) {
    constexpr std::chrono::milliseconds between_checks(50);
    std::atomic<bool> is_cancelled{false};
    std::future<void> result = std::async(std::launch::async, [&] {
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
