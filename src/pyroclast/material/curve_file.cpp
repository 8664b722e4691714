#include "pyroclast/material/curve_file.hpp"

#include <charconv>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"

namespace pyroclast {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// The two cells of a line. Throws Error when there are not exactly two.
std::pair<std::string_view, std::string_view> two_cells(std::string_view line) {
  const auto comma = line.find(',');
  if (comma == std::string_view::npos || line.find(',', comma + 1) != std::string_view::npos) {
    throw Error(fmt::format("\"{}\" is not two cells separated by one comma", line));
  }
  return {trimmed(line.substr(0, comma)), trimmed(line.substr(comma + 1))};
}

/// The unit of a header cell "name [unit]".
std::string header_unit(std::string_view cell) {
  const auto open = cell.find('[');
  if (open == std::string_view::npos || cell.back() != ']') {
    throw Error(fmt::format("header cell \"{}\" is not of the form \"name [unit]\"", cell));
  }
  return std::string(trimmed(cell.substr(open + 1, cell.size() - open - 2)));
}

double number(std::string_view cell) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) {
    throw Error(fmt::format("\"{}\" is not a number", cell));
  }
  return value;
}

/// Takes the lines of a file one by one.
class TableReader {
 public:
  TableReader(const UnitConversion& convert_abscissa, const UnitConversion& convert_value)
      : convert_abscissa_(convert_abscissa), convert_value_(convert_value) {}

  void read(std::string_view line) {
    const auto [first, second] = two_cells(line);
    if (!has_header_) {
      abscissa_unit_ = header_unit(first);
      value_unit_ = header_unit(second);
      has_header_ = true;
      return;
    }
    const double x = convert_abscissa_(number(first), abscissa_unit_);
    if (!abscissae_.empty() && !(abscissae_.back() < x)) {
      throw Error(
          fmt::format("the first column must ascend strictly, {} is not above the line before", first));
    }
    abscissae_.push_back(x);
    values_.push_back(convert_value_(number(second), value_unit_));
  }

  Curve curve(const CurveAxis& axis) const { return Curve::table(abscissae_, values_, axis); }

 private:
  const UnitConversion& convert_abscissa_;
  const UnitConversion& convert_value_;
  bool has_header_ = false;
  std::string abscissa_unit_;
  std::string value_unit_;
  std::vector<double> abscissae_;
  std::vector<double> values_;
};

}  // namespace

Curve read_curve_csv(const std::filesystem::path& path, const CurveAxis& axis,
                     const UnitConversion& convert_abscissa, const UnitConversion& convert_value) {
  require_regular_file(path);
  std::ifstream file(path);
  if (!file) throw Error(fmt::format("cannot open the table file {}", path.string()));
  return read_curve_csv(file, path, axis, convert_abscissa, convert_value);
}

Curve read_curve_csv(std::istream& file, const std::filesystem::path& path, const CurveAxis& axis,
                     const UnitConversion& convert_abscissa, const UnitConversion& convert_value) {
  TableReader reader(convert_abscissa, convert_value);
  std::string line;
  for (int line_number = 1; std::getline(file, line); ++line_number) {
    const std::string_view content = trimmed(line);
    if (content.empty() || content.front() == '#') continue;
    try {
      reader.read(content);
    } catch (const Error& error) {
      throw Error(fmt::format("{}:{}: {}", path.string(), line_number, error.what()));
    }
  }
  if (file.bad()) throw Error(fmt::format("{}: reading the table file failed", path.string()));
  try {
    const Curve curve = reader.curve(axis);
    return curve.described_as(fmt::format("table file {}", path.filename().string()));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace pyroclast
