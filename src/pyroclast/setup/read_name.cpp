#include "pyroclast/setup/read_name.hpp"

#include <algorithm>

namespace pyroclast {

std::string read_name(const Section& s, Meaning meaning) {
  const std::string name = s.text("name", meaning);
  const auto may_be_in_it = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (!std::ranges::all_of(name, may_be_in_it)) s.error("name", "may hold letters, digits and _ only");
  return name;
}

}  // namespace pyroclast
