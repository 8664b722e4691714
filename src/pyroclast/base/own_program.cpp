#include "pyroclast/base/own_program.hpp"

#include <string>
#include <system_error>

namespace pyroclast {

std::filesystem::path own_program() {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path file = fs::read_symlink("/proc/self/exe", ignored);
  if (!file.filename().string().starts_with("ld-linux")) return file;
  return file.parent_path().parent_path() / "bin" / "pyroclast";
}

}  // namespace pyroclast
