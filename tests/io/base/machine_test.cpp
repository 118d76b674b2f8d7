// SPDX-License-Identifier: Apache-2.0
#include "io/base/machine.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <fstream>
#include <thread>

#include "tests/support/tiny_gltf.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;

/// A made-up machine: files of the control groups under a folder of its own.
class Machine {
  public:
    Machine() = default;
    /// With control groups of version 2, the process in one of them.
    explicit Machine(const std::string& group) {
        write("proc/self/mountinfo",
              "21 1 8:1 / / rw - ext4 /dev/sda1 rw\n"
              "29 1 0:26 / /sys/fs/cgroup rw,nosuid shared:4 - cgroup2 cgroup2 rw,nsdelegate");
        write("proc/self/cgroup", "0::" + group);
    }
    void write(const std::string& file, const std::string& text) const {
        const fs::path path = folder_.path / file;
        fs::create_directories(path.parent_path());
        std::ofstream(path) << text << '\n';
    }
    [[nodiscard]] int threads() const { return usable_threads(folder_.path); }
    [[nodiscard]] uint64_t memory_bytes() const { return usable_memory_bytes(folder_.path); }

  private:
    TempFolder folder_;
};

TEST(Machine, WithoutLimitsHasWhatTheSystemSays) {
    const Machine bare;
    EXPECT_GE(bare.threads(), 1);
    EXPECT_LE(bare.threads(), static_cast<int>(std::thread::hardware_concurrency()));
    EXPECT_GT(bare.memory_bytes(), uint64_t{1} << 28);
    const Machine open("/a");
    open.write("sys/fs/cgroup/a/cpu.max", "max 100000");
    open.write("sys/fs/cgroup/a/memory.max", "max");
    EXPECT_EQ(open.threads(), bare.threads());
    EXPECT_EQ(open.memory_bytes(), bare.memory_bytes());
}

TEST(Machine, ThreadsFollowTheAffinityMask) {
    cpu_set_t before, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
    CPU_ZERO(&one);
    for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++i)
        if (CPU_ISSET(i, &before)) CPU_SET(i, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    EXPECT_EQ(usable_threads(), 1);
    ASSERT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
}

TEST(Machine, ThreadsFollowTheQuotaOfVersion2) {
    const Machine machine("/a/b");
    machine.write("sys/fs/cgroup/a/b/cpu.max", "50000 100000");
    EXPECT_EQ(machine.threads(), 1);
    machine.write("sys/fs/cgroup/a/b/cpu.max", "100001 100000");
    EXPECT_EQ(machine.threads(), std::min(2, Machine().threads()));
    machine.write("sys/fs/cgroup/a/cpu.max", "20000 100000");  // a group above it
    EXPECT_EQ(machine.threads(), 1);
    machine.write("sys/fs/cgroup/a/cpu.max", "100000000 100000");
    machine.write("sys/fs/cgroup/a/b/cpu.max", "nonsense");
    EXPECT_EQ(machine.threads(), Machine().threads());
}

TEST(Machine, MemoryIsTheLeastOfAllGroupsAbove) {
    const Machine machine("/a/b");
    machine.write("sys/fs/cgroup/a/b/memory.max", "3000000");
    EXPECT_EQ(machine.memory_bytes(), 3'000'000u);
    machine.write("sys/fs/cgroup/a/memory.max", "2000000");
    EXPECT_EQ(machine.memory_bytes(), 2'000'000u);
    machine.write("sys/fs/cgroup/memory.max", "1000000");
    EXPECT_EQ(machine.memory_bytes(), 1'000'000u);
}

TEST(Machine, KnowsControlGroupsOfVersion1) {
    const Machine machine;
    machine.write("proc/self/mountinfo",
                  "32 31 0:29 / /cg/cpu,cpuacct rw - cgroup cgroup rw,cpu,cpuacct\n"
                  "35 31 0:32 / /cg/memory rw - cgroup cgroup rw,memory\n"
                  "36 31 0:33 / /cg/unified rw - cgroup2 cgroup2 rw");
    machine.write("proc/self/cgroup", "4:memory:/job/7\n2:cpu,cpuacct:/job\n1:cpuset:/x\n0::/");
    machine.write("cg/cpu,cpuacct/job/cpu.cfs_quota_us", "100000");
    machine.write("cg/cpu,cpuacct/job/cpu.cfs_period_us", "100000");
    machine.write("cg/cpu,cpuacct/cpu.cfs_quota_us", "-1");
    machine.write("cg/memory/job/7/memory.limit_in_bytes", "9223372036854771712");
    machine.write("cg/memory/job/memory.limit_in_bytes", "5000000");
    EXPECT_EQ(machine.threads(), 1);
    EXPECT_EQ(machine.memory_bytes(), 5'000'000u);
}

// A container sees its own group at the mount point, whatever path the process has outside.
TEST(Machine, FindsItsGroupInsideAContainer) {
    const Machine machine;
    machine.write("proc/self/mountinfo",
                  "29 1 0:26 /docker/5f /sys/fs/cgroup ro - cgroup2 cgroup rw");
    machine.write("proc/self/cgroup", "0::/docker/5f/inner");
    machine.write("sys/fs/cgroup/inner/memory.max", "4000000");
    EXPECT_EQ(machine.memory_bytes(), 4'000'000u);
    machine.write("sys/fs/cgroup/memory.max", "3000000");
    EXPECT_EQ(machine.memory_bytes(), 3'000'000u);
    machine.write("proc/self/cgroup", "0::/../elsewhere");
    EXPECT_EQ(machine.memory_bytes(), 3'000'000u);
}

}  // namespace
}  // namespace petzval::io
