/// Runs long work that Ctrl-C can end.
#pragma once

#include <functional>

namespace alcove::python {

enum class Gil {
    released,
    kept, ///< so that no other Python thread changes the data that the work reads
};

/// Calls `work` on another thread and waits for it, while this thread handles signals. If a signal handler raises, as
/// the handler of Ctrl-C does, the work is cancelled and the exception of the handler is thrown. \throw what `work`
/// throws
void run(const std::function<void()>& work, Gil gil = Gil::released);

}
