#include "pyroclast/base/environment.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

namespace pyroclast {
namespace {

TEST(Environment, TheCurrentFolderIsForgottenAndOtherFoldersStay) {
  const std::string path = environment("PATH");
  const auto forgotten = [](const char* name, const char* stated) {
    setenv(name, stated, 1);
    forget_current_folder();
    const char* const left = std::getenv(name);
    return std::string(left != nullptr ? left : "not set");
  };
  EXPECT_EQ(forgotten("CPATH", "/opt/include:/usr/local/include"), "/opt/include:/usr/local/include");
  EXPECT_EQ(forgotten("CPATH", ":/opt/include"), "/opt/include");
  EXPECT_EQ(forgotten("CPATH", "/a::/b:"), "/a:/b");
  EXPECT_EQ(forgotten("COMPILER_PATH", ".:./bin:../bin:bin"), "not set");
  EXPECT_EQ(forgotten("GCC_EXEC_PREFIX", "./"), "not set");
  EXPECT_EQ(forgotten("LD_LIBRARY_PATH", "lib:/lib:~/lib"), "/lib");
  EXPECT_EQ(forgotten("XDG_CONFIG_HOME", "settings"), "not set");
  EXPECT_EQ(forgotten("PYROCLAST_CACHE", "cache"), "cache") << "a folder that the user names";
  EXPECT_EQ(forgotten("PATH", (".:" + path).c_str()), path);
  for (const char* name : {"CPATH", "LD_LIBRARY_PATH", "PYROCLAST_CACHE"}) unsetenv(name);
}

}  // namespace
}  // namespace pyroclast
