/// Like BENCHMARK_MAIN(), but on one thread.
#pragma once

#include "alcove/base/parallel.h"

#include <benchmark/benchmark.h>

namespace alcove {

inline int run_on_one_thread(int argc, char** argv) {
    const ThreadLimit limit(1);
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv))
        return 1;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

}
