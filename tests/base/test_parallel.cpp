#include "alcove/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace alcove {
namespace {

constexpr std::size_t many = 1 << 20;

TEST(Cancellable, EndsALoopAndThoseInsideIt) {
    std::atomic<bool> requested{false};
    std::atomic<std::size_t> outer{0}, inner{0};
    const Cancellable scope(&requested);
    const auto loop = [&] {
        parallel_for(many, 1, [&](std::size_t, std::size_t) {
            ++outer;
            requested = true;
            parallel_for(many, 1, [&](std::size_t, std::size_t) { ++inner; });
        });
    };
    EXPECT_THROW(loop(), Cancelled);
    EXPECT_LE(outer, thread_count());
    EXPECT_EQ(inner, 0u);
    EXPECT_THROW(check_cancelled(), Cancelled);
}

TEST(Cancellable, LeavesOtherThreadsAndLaterWorkAlone) {
    const std::atomic<bool> requested{true};
    const auto count_to = [](std::size_t count) {
        std::atomic<std::size_t> done{0};
        parallel_for(count, 1, [&](std::size_t, std::size_t) { ++done; });
        return done.load();
    };
    {
        const Cancellable scope(&requested);
        std::size_t done = 0;
        std::thread([&] { done = count_to(1000); }).join();
        EXPECT_EQ(done, 1000u);
        const Cancellable never(nullptr);
        EXPECT_EQ(count_to(1000), 1000u);
    }
    EXPECT_EQ(count_to(1000), 1000u);
    EXPECT_NO_THROW(check_cancelled());
}

}
}
