#include "pyroclast/app/written_decks.hpp"

#include <filesystem>
#include <string_view>

#include <fmt/format.h>

#include "pyroclast/app/say_aside.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"

namespace pyroclast::app {

namespace {

std::string_view first_line(std::string_view text) {
  return text.substr(0, text.find('\n') + 1);
}

void require_replaceable(const TextFile& file, bool overwrite) {
  const std::string name = file.path.string();
  const auto there = std::filesystem::symlink_status(file.path);
  if (!std::filesystem::exists(there)) return;
  if (!overwrite)
    throw Error(fmt::format(
        "{}: exists already, so nothing is written; choose another name, or --overwrite it", name));
  const std::string_view line = first_line(file.text);
  if (!std::filesystem::is_regular_file(there) || !read_file(file.path).starts_with(line))
    throw Error(
        fmt::format("{}: is no file of an earlier call, which would begin with \"{}\", so nothing is written",
                    name, line.substr(0, line.size() - 1)));
}

}  // namespace

void write_decks(const std::vector<TextFile>& files, bool overwrite) {
  for (const TextFile& file : files) require_replaceable(file, overwrite);
  write_text_files(files);
  for (const TextFile& file : files) say(fmt::format("{} is written\n", file.path.string()));
}

}  // namespace pyroclast::app
