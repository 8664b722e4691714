#include "pyroclast/base/processors.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sched.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {
namespace {

namespace fs = std::filesystem;

/// A root with files of /proc and /sys as the kernel writes them.
class Quota : public testing::Test {
 protected:
  Quota() { fs::remove_all(root_); }
  ~Quota() override { fs::remove_all(root_); }

  void write(const fs::path& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  /// Of version 2, with what a mount shows at its place.
  void in_group_of_version_2(const std::string& group, const std::string& mounted = "/") const {
    write("proc/self/cgroup", "0::" + group + "\n");
    write("proc/self/mountinfo",
          "22 1 8:1 / / rw,relatime - ext4 /dev/sda1 rw\n"
          "30 22 0:26 " +
              mounted + " /sys/fs/cgroup rw,nosuid shared:4 - cgroup2 cgroup2 rw,nsdelegate\n");
  }
  void in_group_of_version_1(const std::string& group, const std::string& mounted = "/") const {
    write("proc/self/cgroup", "3:cpuset:/elsewhere\n2:cpu,cpuacct:" + group + "\n1:name=systemd:/init\n");
    write("proc/self/mountinfo",
          "31 22 0:27 / /sys/fs/cgroup/cpuset rw - cgroup cgroup rw,cpuset\n"
          "32 22 0:28 " +
              mounted + " /sys/fs/cgroup/cpu,cpuacct rw shared:9 - cgroup cgroup rw,cpu,cpuacct\n");
  }
  void bound_of_version_1(const std::string& group, const std::string& time,
                          const std::string& period) const {
    write("sys/fs/cgroup/cpu,cpuacct" + group + "/cpu.cfs_quota_us", time + "\n");
    write("sys/fs/cgroup/cpu,cpuacct" + group + "/cpu.cfs_period_us", period + "\n");
  }
  std::optional<double> quota() const { return processor_quota(root_); }

  fs::path root_ =
      fs::path(testing::TempDir()) /
      ("processors " + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(Quota, IsNoneWithoutControlGroups) {
  EXPECT_EQ(quota(), std::nullopt);
  write("proc/self/cgroup", "");
  write("proc/self/mountinfo", "22 1 8:1 / / rw,relatime - ext4 /dev/sda1 rw\n");
  EXPECT_EQ(quota(), std::nullopt);
}

TEST_F(Quota, IsThatOfTheGroupOfVersion2) {
  in_group_of_version_2("/job");
  write("sys/fs/cgroup/job/cpu.max", "150000 100000\n");
  EXPECT_EQ(quota(), 1.5);
  write("sys/fs/cgroup/job/cpu.max", "max 100000\n");
  EXPECT_EQ(quota(), std::nullopt);
}

TEST_F(Quota, IsTheSmallestOfTheGroupAndThoseAboveIt) {
  in_group_of_version_2("/slice/user/job");
  write("sys/fs/cgroup/slice/cpu.max", "250000 50000\n");
  write("sys/fs/cgroup/slice/user/job/cpu.max", "max 100000\n");
  write("sys/fs/cgroup/another/cpu.max", "1000 100000\n");
  EXPECT_EQ(quota(), 5.0);
  write("sys/fs/cgroup/slice/user/cpu.max", "300000 100000\n");
  EXPECT_EQ(quota(), 3.0);
  write("sys/fs/cgroup/slice/user/job/cpu.max", "50000 100000\n");
  EXPECT_EQ(quota(), 0.5);
}

TEST_F(Quota, IsThatOfTheGroupOfVersion1) {
  in_group_of_version_1("/docker/job");
  bound_of_version_1("/docker/job", "-1", "100000");
  EXPECT_EQ(quota(), std::nullopt);
  bound_of_version_1("/docker", "400000", "100000");
  EXPECT_EQ(quota(), 4.0);
  bound_of_version_1("/docker/job", "100000", "50000");
  EXPECT_EQ(quota(), 2.0);
}

// A container's own mount shows its group at the top, and /proc names it from the machine's root.
TEST_F(Quota, IsFoundWhereAContainerSeesItsOwnGroupAtTheTop) {
  in_group_of_version_1("/docker/4e11/job", "/docker/4e11");
  bound_of_version_1("", "200000", "100000");
  EXPECT_EQ(quota(), 2.0);
  bound_of_version_1("/job", "100000", "100000");
  EXPECT_EQ(quota(), 1.0);
}

TEST_F(Quota, IsThatOfTheMountWhereTheGroupStandsElsewhere) {
  in_group_of_version_2("/../other", "/");
  write("sys/fs/cgroup/cpu.max", "200000 100000\n");
  EXPECT_EQ(quota(), 2.0);
  in_group_of_version_2("/docker/other", "/docker/4e11");
  EXPECT_EQ(quota(), 2.0);
}

TEST_F(Quota, IsTheSmallerOneWhereBothVersionsAreMounted) {
  write("proc/self/cgroup", "1:cpu:/job\n0::/job\n");
  write("proc/self/mountinfo",
        "32 22 0:28 / /sys/fs/cgroup/cpu rw - cgroup cgroup rw,cpu\n"
        "33 22 0:29 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n");
  write("sys/fs/cgroup/cpu/job/cpu.cfs_quota_us", "300000\n");
  write("sys/fs/cgroup/cpu/job/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(quota(), 3.0);
  write("sys/fs/cgroup/unified/cpu.max", "200000 100000\n");
  EXPECT_EQ(quota(), 2.0);
}

TEST_F(Quota, IsFoundInAFolderWithASpace) {
  write("proc/self/cgroup", "0::/my job\n");
  write("proc/self/mountinfo", "30 22 0:26 / /sys/all\\040groups rw - cgroup2 cgroup2 rw\n");
  write("sys/all groups/my job/cpu.max", "100000 100000\n");
  EXPECT_EQ(quota(), 1.0);
}

TEST_F(Quota, IsNoneWhereFilesMakeNoSense) {
  in_group_of_version_2("/job");
  for (const char* text : {"", "much", "100000", "0 100000", "-5 100000", "100000 0", "nan nan"}) {
    write("sys/fs/cgroup/job/cpu.max", text);
    EXPECT_EQ(quota(), std::nullopt) << text;
  }
  write("proc/self/cgroup", "0\n:\n0:\n");
  write("proc/self/mountinfo", "\n30 22\n30 22 0:26 / /sys/fs/cgroup rw\n- cgroup2\n");
  EXPECT_EQ(quota(), std::nullopt);
}

TEST(Processors, AreAllowedOnesAsFarAsTheQuotaGoesAndAtLeastOne) {
  EXPECT_EQ(whole_processors(4, std::nullopt), 4);
  EXPECT_EQ(whole_processors(4, 8.0), 4);
  EXPECT_EQ(whole_processors(4, 3.0), 3);
  EXPECT_EQ(whole_processors(4, 1.9), 1);
  EXPECT_EQ(whole_processors(4, 0.2), 1);
  EXPECT_EQ(whole_processors(0, std::nullopt), 1);
  EXPECT_EQ(whole_processors(2, 1e300), 2);
}

// Bound to one processor, a process has one thread, however many it asks for.
TEST(Processors, AreThoseThatTheProcessMayRunOn) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  EXPECT_LE(free_processors(), CPU_COUNT(&before));
  EXPECT_GE(free_processors(), 1);
  EXPECT_EQ(usable_threads(0), free_processors());
  EXPECT_EQ(usable_threads(1), 1);
  EXPECT_EQ(usable_threads(1024), free_processors());
  EXPECT_THROW(usable_threads(-1), Error);
  int first = 0;
  while (!CPU_ISSET(first, &before)) ++first;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(first, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  EXPECT_EQ(free_processors(), 1);
  EXPECT_EQ(usable_threads(0), 1);
  EXPECT_EQ(usable_threads(8), 1);
  ASSERT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
}

}  // namespace
}  // namespace pyroclast
