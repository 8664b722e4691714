#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pyroclast {

/// What this process asks of the file system, while one of these lives: fsync, rename and mkdir stand in this
/// program in place of those of the C library.
class SystemCalls {
 public:
  SystemCalls();
  ~SystemCalls();
  SystemCalls(const SystemCalls&) = delete;
  SystemCalls& operator=(const SystemCalls&) = delete;

  std::vector<std::string>
      log;  ///< "fsync FILE" and "rename FILE FILE" in order, last parts of the names only
  std::function<void(const std::string& path)> before_mkdir;
  int fsync_error = 0;  ///< errno that fsync fails with; 0: it does its work
};

}  // namespace pyroclast
