#include <filesystem>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/python_package.hpp"

namespace pyroclast::app {

void study(const std::vector<std::string>& words) {
  std::vector<std::string> all{"--program", std::filesystem::read_symlink("/proc/self/exe")};
  all.insert(all.end(), words.begin(), words.end());
  become_package("pyroclast.study", all);
}

}  // namespace pyroclast::app
