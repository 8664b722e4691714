#include "pyroclast/material/jump_path.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int line, const std::string& what) {
  throw Error(fmt::format("{}:{}: {}", file.string(), line, what));
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> list;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) list.push_back(trimmed(cell));
  return list;
}

/// Which quantity a column holds, and the unit its numbers are in.
struct Column {
  double JumpPathPoint::*quantity;
  const Unit* dimension;
  std::string unit;
};

Column parse_column(const std::filesystem::path& file, int line, const std::string& header) {
  const auto open = header.find('[');
  const auto close = header.find(']');
  if (open == std::string::npos || close == std::string::npos || close < open)
    fail(file, line, fmt::format("column \"{}\" has no unit; write for example \"u_n [um]\"", header));
  const std::string name = trimmed(header.substr(0, open));
  const std::string given = trimmed(header.substr(open + 1, close - open - 1));
  if (name == "u_n") return {&JumpPathPoint::opening, &unit::length, given};
  if (name == "u_s") return {&JumpPathPoint::slip, &unit::length, given};
  if (name == "T") return {&JumpPathPoint::temperature, &unit::temperature, given};
  fail(file, line, fmt::format("column \"{}\" is unknown; allowed are u_n, u_s and T", name));
}

std::vector<Column> parse_header(const std::filesystem::path& file, int line,
                                 const std::vector<std::string>& row) {
  std::vector<Column> columns;
  for (const auto& header : row) {
    columns.push_back(parse_column(file, line, header));
    const auto same = [&](const Column& c) { return c.quantity == columns.back().quantity; };
    if (std::count_if(columns.begin(), columns.end(), same) > 1)
      fail(file, line, fmt::format("column \"{}\" stands twice", header));
  }
  return columns;
}

}  // namespace

std::vector<JumpPathPoint> read_jump_path(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw Error(fmt::format("{}: cannot be read", file.string()));
  return read_jump_path(stream, file);
}

std::vector<JumpPathPoint> read_jump_path(std::istream& stream, const std::filesystem::path& file) {
  std::vector<Column> columns;
  std::vector<JumpPathPoint> path;
  int number = 0;
  for (std::string text; std::getline(stream, text);) {
    ++number;
    if (trimmed(text).empty() || trimmed(text).front() == '#') continue;
    const auto row = cells(text);
    if (columns.empty()) {
      columns = parse_header(file, number, row);
      continue;
    }
    if (row.size() != columns.size())
      fail(file, number, fmt::format("{} values, but the header has {} columns", row.size(), columns.size()));
    JumpPathPoint point;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      try {
        point.*columns[i].quantity = parse_quantity(row[i] + " " + columns[i].unit, *columns[i].dimension);
      } catch (const Error& e) {
        fail(file, number, e.what());
      }
    }
    path.push_back(point);
  }
  if (path.empty())
    throw Error(fmt::format("{}: holds no path; a header and at least one row are needed", file.string()));
  return path;
}

}  // namespace pyroclast
