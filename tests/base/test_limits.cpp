#include "alcove/base/detail/limits.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "mesh/scratch_files.h"

#include <gtest/gtest.h>

#include <limits>

namespace alcove {
namespace {

TEST(Limits, ReadingFollowsMemoryUntilItIsSet) {
    EXPECT_EQ(memory_limit(), 0.5 * system_memory());
    limit_memory(1e9);
    EXPECT_EQ(memory_limit(), 1e9);
    EXPECT_EQ(read_limit(), 5e8);
    limit_memory(1e12);
    EXPECT_EQ(read_limit(), 4e9);
    limit_reading(3e9);
    EXPECT_EQ(read_limit(), 3e9);
    limit_memory(0.0);
    limit_reading(0.0);
}

TEST(Limits, BytesReadWell) {
    EXPECT_EQ(bytes_text(20.0), "20 bytes");
    EXPECT_EQ(bytes_text(1500.0), "1.5 kB");
    EXPECT_EQ(bytes_text(512e6), "512 MB");
    EXPECT_EQ(bytes_text(11.537e9), "11.5 GB");
    EXPECT_EQ(bytes_text(4.3e12), "4,300 GB");
}

using ControlGroups = ScratchFiles;

TEST_F(ControlGroups, TheLeastLimitOfAllThatContainTheProcessCounts) {
    std::filesystem::create_directories(path("groups/outer/inner"));
    std::filesystem::create_directory(path("groups/elsewhere"));
    write("membership", "9:memory:/elsewhere\n0::/outer/inner\n");
    const auto limit = [&] { return control_group_memory(path("membership"), path("groups")); };
    EXPECT_EQ(limit(), std::numeric_limits<double>::infinity());
    write("groups/outer/inner/memory.max", "max\n");
    write("groups/elsewhere/memory.max", "1000\n");
    EXPECT_EQ(limit(), std::numeric_limits<double>::infinity());
    write("groups/outer/memory.max", "2000000000\n");
    EXPECT_EQ(limit(), 2e9);
    write("groups/memory.max", "3000000000\n");
    EXPECT_EQ(limit(), 2e9);
    write("groups/outer/inner/memory.max", "1000000000\n");
    EXPECT_EQ(limit(), 1e9);
    // In a container, the group of the process is the root.
    write("membership", "0::/\n");
    EXPECT_EQ(limit(), 3e9);
}

}
}
