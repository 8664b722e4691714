#include "pyroclast/results/profile_files.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

/// Temperature of the isotherm, °C, below which the reduced cross-section of EN 1992-1-2 takes concrete as
/// whole.
constexpr double kIsotherm = 500.0;
/// Least change of a temperature of the line since the last row, K.
constexpr double kLeastChange = 1.0;

using Temperatures = std::span<const double>;

Temperatures row_of(const ProfileRows& rows, std::size_t row, std::size_t points) {
  return Temperatures(rows.temperature).subspan(row * points, points);
}

/// Returns the lines of one row of the profile.
std::string profile_lines(double time, const std::vector<double>& depths, Temperatures temperatures) {
  std::string text;
  for (std::size_t i = 0; i < depths.size(); ++i)
    text += std::isnan(temperatures[i])
                ? fmt::format("{:.9g},{:.9g},\n", time, depths[i])
                : fmt::format("{:.9g},{:.9g},{:.9g}\n", time, depths[i], temperatures[i]);
  return text;
}

/// Tells whether a point is at the isotherm or hotter; one that has left with a piece counts as hot.
bool is_hot(double temperature) {
  return !(temperature < kIsotherm);
}

/// Returns the depth to which all of the line is at the isotherm or hotter, m; its first point is.
double depth_of_isotherm(const std::vector<double>& depths, Temperatures temperatures) {
  for (std::size_t i = 1; i < depths.size(); ++i) {
    if (is_hot(temperatures[i])) continue;
    if (std::isnan(temperatures[i - 1])) return depths[i - 1];
    const double share = (temperatures[i - 1] - kIsotherm) / (temperatures[i - 1] - temperatures[i]);
    return depths[i - 1] + share * (depths[i] - depths[i - 1]);
  }
  return depths.back();
}

/// Returns the lines of the isotherm that a row adds to those of the rows before it.
std::string isotherm_lines(const ProfileRows& rows, std::size_t row, const std::vector<double>& depths) {
  const Temperatures now = row_of(rows, row, depths.size());
  const bool begins_hot = is_hot(now.front());
  std::string text;
  if (row > 0) {
    const double before = row_of(rows, row - 1, depths.size()).front();
    if (begins_hot != is_hot(before)) {
      const double share = std::isnan(now.front()) ? 1.0 : (kIsotherm - before) / (now.front() - before);
      text = fmt::format("{:.9g},0\n", rows.time[row - 1] + share * (rows.time[row] - rows.time[row - 1]));
    }
  }
  if (begins_hot) text += fmt::format("{:.9g},{:.9g}\n", rows.time[row], depth_of_isotherm(depths, now));
  return text;
}

/// Returns all lines of a file, with its header.
template <class LinesOfRow>
std::string table_text(std::string header, const ProfileRows& rows, LinesOfRow lines_of_row) {
  for (std::size_t row = 0; row < rows.time.size(); ++row) header += lines_of_row(row);
  return header;
}

/// Returns the line; throws Error where the rows are those of another one.
HeatedLine required(HeatedLine line, const ProfileRows& rows) {
  if (rows.temperature.size() != rows.time.size() * line.depths().size())
    throw Error(fmt::format("{} temperatures in {} rows are not those of a line of {} points",
                            rows.temperature.size(), rows.time.size(), line.depths().size()));
  return line;
}

}  // namespace

void ProfileRows::visit_state(StateVisitor& visitor) {
  const StateVisitor::Scope scope(visitor, "profile");
  visitor.visit("time", time, state::at_least(0));
  // a state holds no NaN
  for (double& t : temperature) t = std::isnan(t) ? kTemperatures.least : t;
  visitor.visit("temperature", temperature, kTemperatures);
  for (double& t : temperature) t = t == kTemperatures.least ? std::numeric_limits<double>::quiet_NaN() : t;
  visitor.require(time.empty() ? temperature.empty() : temperature.size() % time.size() == 0, "temperature",
                  "does not have as many values for each time");
}

ProfileFiles::ProfileFiles(const std::filesystem::path& folder, const Simulation& simulation, double duration,
                           const ProfileRows& rows)
    : line_(required(HeatedLine(simulation, duration), rows)),
      profile_(file_in(folder, "temperature_profile.csv"),
               table_text("heating_time_s,depth_m,temperature_degC\n", rows,
                          [&](std::size_t row) {
                            return profile_lines(rows.time[row], line_.depths(),
                                                 row_of(rows, row, line_.depths().size()));
                          })),
      isotherm_(file_in(folder, "isotherm.csv"),
                table_text(fmt::format("heating_time_s,depth_{:.0f}_degC_m\n", kIsotherm), rows,
                           [&](std::size_t row) { return isotherm_lines(rows, row, line_.depths()); })) {}

void ProfileFiles::write(const Simulation& simulation, bool is_wanted, ProfileRows& rows) {
  const std::vector<double>& depths = line_.depths();
  const double time = simulation.field().time();
  if (depths.empty() || (!rows.time.empty() && time <= rows.time.back())) return;
  const std::vector<double> now = line_.read(simulation.field());
  if (!rows.time.empty() && !is_wanted) {
    const Temperatures before = row_of(rows, rows.time.size() - 1, depths.size());
    double change = 0.0;
    bool some_left = false;
    for (std::size_t i = 0; i < now.size(); ++i) {
      some_left = some_left || std::isnan(now[i]) != std::isnan(before[i]);
      change = std::max(change, std::abs(now[i] - before[i]));
    }
    if (change < kLeastChange && !some_left) return;
  }
  rows.time.push_back(time);
  rows.temperature.insert(rows.temperature.end(), now.begin(), now.end());
  profile_.lines(profile_lines(time, depths, now));
  isotherm_.lines(isotherm_lines(rows, rows.time.size() - 1, depths));
}

}  // namespace pyroclast
