#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/python_package.hpp"
#include "pyroclast/base/own_program.hpp"

namespace pyroclast::app {

void study(const std::vector<std::string>& words) {
  std::vector<std::string> all{"--program", own_program()};
  all.insert(all.end(), words.begin(), words.end());
  become_package("pyroclast.study", all);
}

}  // namespace pyroclast::app
