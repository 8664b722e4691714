#include "pyroclast/results/publish.hpp"

#include <cerrno>

#include "pyroclast/base/error.hpp"
#include "pyroclast/results/hdf5_file.hpp"
#include "pyroclast/results/text_file.hpp"
#include "results/folder.hpp"
#include "results/system_calls.hpp"

namespace pyroclast {
namespace {

using Log = std::vector<std::string>;

TEST_F(Results, ATextFileIsOnDiskBeforeItHasItsNameAndItsNameBeforeTheWriterGoesOn) {
  SystemCalls calls;
  write_text_file(folder_ / "a.txt", "whole");
  EXPECT_EQ(calls.log, (Log{"fsync a.txt.partial", "rename a.txt.partial a.txt",
                            "fsync " + folder_.filename().string()}));
}

TEST_F(Results, AnHdf5FileIsOnDiskBeforeItHasItsNameAndItsNameBeforeTheWriterGoesOn) {
  SystemCalls calls;
  Hdf5File file(folder_ / "a.h5");
  file.group("/g");
  EXPECT_EQ(calls.log, Log{});
  file.close();
  EXPECT_EQ(calls.log,
            (Log{"fsync a.h5.partial", "rename a.h5.partial a.h5", "fsync " + folder_.filename().string()}));
}

TEST_F(Results, AFileThatDoesNotReachTheDiskLeavesTheOneBefore) {
  write_text_file(folder_ / "a.txt", "before");
  SystemCalls calls;
  calls.fsync_error = EIO;
  try {
    write_text_file(folder_ / "a.txt", "after");
    FAIL() << "a failing disk took a file";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("a.txt"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("Input/output error"), std::string::npos);
  }
  EXPECT_EQ(content(folder_ / "a.txt"), "before");
  EXPECT_FALSE(fs::exists(folder_ / "a.txt.partial"));
}

}  // namespace
}  // namespace pyroclast
