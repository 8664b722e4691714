#include "pyroclast/thermal/heat_material.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/material/curve_integral.hpp"

namespace pyroclast {

namespace {

constexpr double kWidestCell = 0.1;  // K
constexpr int kFewestCells = 1000;

void require_usable(const Curve& curve, const std::string& title, const Interval& range) {
  if (!curve.is_constant() && curve.axis() != temperature_axis())
    throw Error(fmt::format("{} ({}) is a function of {} [{}], but it must be one of the temperature", title,
                            curve.describe(), curve.axis().symbol, curve.axis().unit));
  if (!(curve.range().lower <= range.lower && range.upper <= curve.range().upper))
    throw Error(fmt::format("{} ({}) does not cover the run's temperature range of {} to {} degC", title,
                            curve.describe(), range.lower, range.upper));
  if (const double least = curve.minimum(range.lower, range.upper); !(least > 0.0))
    throw Error(fmt::format("{} ({}) falls to {}, but it must be greater than 0 from {} to {} degC", title,
                            curve.describe(), least, range.lower, range.upper));
}

}  // namespace

TemperatureGrid::TemperatureGrid(const Interval& temperature_range)
    : range(temperature_range),
      cells(std::max(kFewestCells, static_cast<int>(std::ceil((range.upper - range.lower) / kWidestCell)))),
      width((range.upper - range.lower) / cells) {}

int TemperatureGrid::cell(double temperature) const {
  return std::clamp(static_cast<int>((temperature - range.lower) / width), 0, cells - 1);
}

HeatTable::HeatTable(const HeatMaterial& material, const std::string& name, const TemperatureGrid& grid,
                     double window)
    : grid_(grid), bucket_width_(std::min(window, grid.range.upper - grid.range.lower)) {
  require_usable(material.conductivity, fmt::format("material {}: the conductivity", name), grid.range);
  require_usable(material.heat_capacity, fmt::format("material {}: the heat capacity", name), grid.range);
  double sum = 0.0;
  for (int i = 0; i <= grid.cells; ++i) {
    if (i > 0) sum += integral(material.heat_capacity, grid.knot(i - 1), grid.knot(i));
    conductivity_.push_back(material.conductivity(grid.knot(i)));
    enthalpy_.push_back(sum);
  }
  find_bounds();
}

double HeatTable::conductivity(double temperature) const {
  const int cell = grid_.cell(temperature);
  const double fraction = (temperature - grid_.knot(cell)) / grid_.width;
  const double* value = conductivity_.data() + cell;
  return value[0] + fraction * (value[1] - value[0]);
}

std::size_t HeatTable::bucket(double temperature) const {
  const double last = static_cast<double>(greatest_conductivity_.size() - 1);
  return static_cast<std::size_t>(std::clamp((temperature - grid_.range.lower) / bucket_width_, 0.0, last));
}

/// Buckets are as wide as the window, so what lies within the window lies in a bucket or its neighbours.
void HeatTable::find_bounds() {
  const auto buckets =
      static_cast<std::size_t>(std::ceil((grid_.range.upper - grid_.range.lower) / bucket_width_));
  greatest_conductivity_.assign(buckets, 0.0);
  least_capacity_.assign(buckets, std::numeric_limits<double>::infinity());
  for (int cell = 0; cell < grid_.cells; ++cell) {
    const auto i = static_cast<std::size_t>(cell);
    const double capacity = (enthalpy_[i + 1] - enthalpy_[i]) / grid_.width;
    const double conductivity = std::max(conductivity_[i], conductivity_[i + 1]);
    const auto first = std::max<std::size_t>(bucket(grid_.knot(cell)), 1) - 1;
    const auto last = std::min(bucket(grid_.knot(cell + 1)) + 1, buckets - 1);
    for (std::size_t b = first; b <= last; ++b) {
      least_capacity_[b] = std::min(least_capacity_[b], capacity);
      greatest_conductivity_[b] = std::max(greatest_conductivity_[b], conductivity);
    }
  }
  greatest_ = *std::max_element(greatest_conductivity_.begin(), greatest_conductivity_.end());
  least_ = *std::min_element(least_capacity_.begin(), least_capacity_.end());
}

NodeEnthalpy::NodeEnthalpy(const TemperatureGrid& grid, const std::vector<HeatTable>& tables,
                           const std::vector<std::vector<NodeShare>>& shares)
    : grid_(grid), tables_(tables), begin_{0} {
  for (const auto& of_node : shares) {
    shares_.insert(shares_.end(), of_node.begin(), of_node.end());
    begin_.push_back(static_cast<int>(shares_.size()));
  }
}

double NodeEnthalpy::at(int node, int knot) const {
  double sum = 0.0;
  for (int i = begin_[node]; i < begin_[node + 1]; ++i)
    sum += shares_[i].volume * tables_[shares_[i].material].enthalpy(knot);
  return sum;
}

double NodeEnthalpy::enthalpy(int node, double temperature) const {
  const int cell = grid_.cell(temperature);
  const double lower = at(node, cell);
  return lower + (temperature - grid_.knot(cell)) / grid_.width * (at(node, cell + 1) - lower);
}

double NodeEnthalpy::temperature(int node, double enthalpy, double near) const {
  if (!(enthalpy > 0.0)) return grid_.range.lower;
  if (enthalpy >= at(node, grid_.cells)) return grid_.range.upper;
  // Strides that double lead to a bracket, halving to the cell.
  int lower = grid_.cell(near), upper = lower + 1;
  for (int stride = 1; enthalpy < at(node, lower); stride *= 2) {
    upper = lower;
    lower = std::max(0, lower - stride);
  }
  for (int stride = 1; enthalpy > at(node, upper); stride *= 2) {
    lower = upper;
    upper = std::min(grid_.cells, upper + stride);
  }
  while (upper - lower > 1) {
    const int middle = (lower + upper) / 2;
    (enthalpy < at(node, middle) ? upper : lower) = middle;
  }
  const double below = at(node, lower);
  return grid_.knot(lower) + grid_.width * (enthalpy - below) / (at(node, upper) - below);
}

double NodeEnthalpy::excess(int node, double enthalpy) const {
  if (enthalpy < 0.0) return enthalpy * grid_.width / at(node, 1);
  const double most = at(node, grid_.cells);
  if (enthalpy > most) return (enthalpy - most) * grid_.width / (most - at(node, grid_.cells - 1));
  return enthalpy >= 0.0 ? 0.0 : std::numeric_limits<double>::infinity();  // not a number
}

double NodeEnthalpy::least_capacity(int node, double temperature) const {
  double sum = 0.0;
  for (int i = begin_[node]; i < begin_[node + 1]; ++i)
    sum += shares_[i].volume * tables_[shares_[i].material].least_capacity(temperature);
  return sum;
}

double NodeEnthalpy::least_capacity(int node) const {
  double sum = 0.0;
  for (int i = begin_[node]; i < begin_[node + 1]; ++i)
    sum += shares_[i].volume * tables_[shares_[i].material].least_capacity();
  return sum;
}

}  // namespace pyroclast
