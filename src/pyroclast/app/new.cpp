#include <filesystem>

#include <fmt/format.h>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/starter_deck.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/results/text_file.hpp"

namespace pyroclast::app {

int make_deck(const std::string& name) {
  std::filesystem::path file = name;
  if (file.extension() != ".toml") file += ".toml";
  if (std::filesystem::exists(file))
    throw Error(
        fmt::format("{}: exists already, so it is not overwritten; choose another name", file.string()));
  write_text_file(file, kStarterDeck);
  fmt::print("{} is written. Next:\n  pyroclast check {}\n  pyroclast run {}\n", file.string(), file.string(),
             file.string());
  return 0;
}

}  // namespace pyroclast::app
