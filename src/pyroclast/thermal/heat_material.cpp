#include "pyroclast/thermal/heat_material.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/material/curve_integral.hpp"

namespace pyroclast {

namespace {

/// Number of a cell below absolute zero, from which cells are counted so that truncation rounds down.
constexpr int kLowestCell = -2732;

double clamp_to(const Interval& range, double x) {
  return std::clamp(x, range.lower, range.upper);
}

void require_usable(const Curve& curve, const std::string& title, const TemperatureGrid& grid) {
  const Interval range = grid.range();
  if (!curve.is_constant() && curve.axis() != temperature_axis())
    throw Error(fmt::format("{} ({}) is a function of {} [{}], but it must be one of the temperature", title,
                            curve.describe(), curve.axis().symbol, curve.axis().unit));
  if (!curve.holds(range))
    throw Error(fmt::format("{} ({}) does not cover the run's temperature range of {} to {} degC", title,
                            curve.describe(), range.lower, range.upper));
  const double first = std::max(curve.range().lower, TemperatureGrid::knot(grid.first_cell()));
  const double last =
      std::max(first, std::min(curve.range().upper, TemperatureGrid::knot(grid.last_cell() + 1)));
  if (const double least = curve.minimum(first, last); !(least > 0.0))
    throw Error(fmt::format("{} ({}) falls to {}, but it must be greater than 0 from {} to {} degC", title,
                            curve.describe(), least, first, last));
}

/// Integrates a curve over a cell; beyond its range the curve keeps its end values.
double cell_integral(const Curve& curve, int cell) {
  const double a = TemperatureGrid::knot(cell), b = TemperatureGrid::knot(cell + 1);
  const auto [lower, upper] = curve.range();
  const double from = clamp_to(curve.range(), a), to = clamp_to(curve.range(), b);
  double sum = from < to ? integral(curve, from, to) : 0.0;
  if (a < lower) sum += (std::min(b, lower) - a) * curve(lower);
  if (upper < b) sum += (b - std::max(a, upper)) * curve(upper);
  return sum;
}

/// Returns the knot at which the enthalpy is 0.
int datum_knot(const Curve& heat_capacity) {
  const double datum = clamp_to(heat_capacity.range(), kReferenceTemperature);
  return TemperatureGrid({datum, datum}).first_cell();
}

}  // namespace

TemperatureGrid::TemperatureGrid(const Interval& range)
    : range_(range), first_cell_(kLowestCell), last_cell_(std::numeric_limits<int>::max()) {
  const int first = cell(range.lower), last = cell(range.upper);
  first_cell_ = first;
  last_cell_ = range.upper > knot(last) ? last : std::max(first, last - 1);
}

int TemperatureGrid::cell(double temperature) const {
  const int cell = static_cast<int>(temperature * cells_per_kelvin - kLowestCell) + kLowestCell;
  return std::clamp(cell, first_cell_, last_cell_);
}

HeatTable::HeatTable(const HeatMaterial& material, const std::string& name, const TemperatureGrid& grid,
                     double window)
    : material_(material),
      name_(name),
      grid_(grid),
      bucket_width_(std::max(window, TemperatureGrid::width)),
      first_knot_(datum_knot(material.heat_capacity)) {
  extend(grid);
}

void HeatTable::extend(const TemperatureGrid& grid) {
  require_usable(material_.conductivity, fmt::format("material {}: the conductivity", name_), grid);
  require_usable(material_.heat_capacity, fmt::format("material {}: the heat capacity", name_), grid);
  grid_ = grid;
  const auto conductivity_at = [&](int knot) {
    return material_.conductivity(clamp_to(material_.conductivity.range(), TemperatureGrid::knot(knot)));
  };
  if (enthalpy_.empty()) {
    enthalpy_.push_back(0.0);
    conductivity_.push_back(conductivity_at(first_knot_));
  }
  for (int last = first_knot_ + static_cast<int>(enthalpy_.size()) - 1; last <= grid.last_cell(); ++last) {
    enthalpy_.push_back(enthalpy_.back() + cell_integral(material_.heat_capacity, last));
    conductivity_.push_back(conductivity_at(last + 1));
  }
  std::vector<double> enthalpy, conductivity;  // values below those that are there, downwards
  for (double lowest = enthalpy_.front(); first_knot_ > grid.first_cell();) {
    --first_knot_;
    lowest -= cell_integral(material_.heat_capacity, first_knot_);
    enthalpy.push_back(lowest);
    conductivity.push_back(conductivity_at(first_knot_));
  }
  enthalpy_.insert(enthalpy_.begin(), enthalpy.rbegin(), enthalpy.rend());
  conductivity_.insert(conductivity_.begin(), conductivity.rbegin(), conductivity.rend());
  find_bounds();
}

double HeatTable::conductivity(double temperature) const {
  const int cell = grid_.cell(temperature);
  const double* value = conductivity_.data() + (cell - first_knot_);
  return value[0] + TemperatureGrid::fraction(temperature, cell) * (value[1] - value[0]);
}

int HeatTable::bucket_number(double temperature) const {
  return static_cast<int>(std::floor(temperature / bucket_width_));
}

std::size_t HeatTable::bucket(double temperature) const {
  const int last = static_cast<int>(greatest_conductivity_.size()) - 1;
  return static_cast<std::size_t>(std::clamp(bucket_number(temperature) - first_bucket_, 0, last));
}

/// Finds the bounds of each bucket. Buckets are as wide as the window, so temperatures within the window of
/// another lie in its bucket or the neighbours.
void HeatTable::find_bounds() {
  const Interval range = grid_.range();
  first_bucket_ = bucket_number(range.lower);
  const int buckets = bucket_number(range.upper) - first_bucket_ + 1;
  greatest_conductivity_.assign(static_cast<std::size_t>(buckets), 0.0);
  least_capacity_.assign(static_cast<std::size_t>(buckets), std::numeric_limits<double>::infinity());
  for (int cell = grid_.first_cell(); cell <= grid_.last_cell(); ++cell) {
    const double capacity = (enthalpy(cell + 1) - enthalpy(cell)) * TemperatureGrid::cells_per_kelvin;
    const double* conductivity = conductivity_.data() + (cell - first_knot_);
    const int first = std::max(bucket_number(TemperatureGrid::knot(cell)) - 1 - first_bucket_, 0);
    const int last =
        std::min(bucket_number(TemperatureGrid::knot(cell + 1)) + 1 - first_bucket_, buckets - 1);
    for (int b = first; b <= last; ++b) {
      least_capacity_[b] = std::min(least_capacity_[b], capacity);
      greatest_conductivity_[b] = std::max({greatest_conductivity_[b], conductivity[0], conductivity[1]});
    }
  }
  greatest_ = *std::max_element(greatest_conductivity_.begin(), greatest_conductivity_.end());
  least_ = *std::min_element(least_capacity_.begin(), least_capacity_.end());
}

NodeEnthalpy::NodeEnthalpy(const TemperatureGrid& grid, const std::vector<HeatTable>& tables,
                           const std::vector<std::vector<NodeShare>>& shares)
    : grid_(grid), tables_(&tables), begin_{0} {
  for (const auto& of_node : shares) {
    shares_.insert(shares_.end(), of_node.begin(), of_node.end());
    begin_.push_back(static_cast<int>(shares_.size()));
  }
  set_grid(grid);
}

void NodeEnthalpy::set_grid(const TemperatureGrid& grid) {
  grid_ = grid;
  least_.clear();
  most_.clear();
  for (int node = 0; node + 1 < static_cast<int>(begin_.size()); ++node) {
    least_.push_back(enthalpy(node, grid.range().lower));
    most_.push_back(enthalpy(node, grid.range().upper));
  }
}

double NodeEnthalpy::at(int node, int knot) const {
  double sum = 0.0;
  for (int i = begin_[node]; i < begin_[node + 1]; ++i)
    sum += shares_[i].volume * (*tables_)[shares_[i].material].enthalpy(knot);
  return sum;
}

double NodeEnthalpy::enthalpy(int node, double temperature) const {
  const int cell = grid_.cell(temperature);
  const double lower = at(node, cell);
  return lower + TemperatureGrid::fraction(temperature, cell) * (at(node, cell + 1) - lower);
}

double NodeEnthalpy::temperature(int node, double enthalpy, double near) const {
  const auto [coldest, hottest] = grid_.range();
  if (!(enthalpy > least_[node])) return coldest;
  if (enthalpy >= most_[node]) return hottest;
  // Strides that double lead to a bracket, and halving leads to the cell. By rounding an end of the range may
  // lie beyond its knot, and the enthalpy between the two: then the cell at the end has it.
  int lower = grid_.cell(near), upper = lower + 1;
  for (int stride = 1; lower > grid_.first_cell() && enthalpy < at(node, lower); stride *= 2) {
    upper = lower;
    lower = std::max(grid_.first_cell(), lower - stride);
  }
  for (int stride = 1; upper <= grid_.last_cell() && enthalpy > at(node, upper); stride *= 2) {
    lower = upper;
    upper = std::min(grid_.last_cell() + 1, upper + stride);
  }
  while (upper - lower > 1) {
    const int middle = (lower + upper) / 2;
    (enthalpy < at(node, middle) ? upper : lower) = middle;
  }
  const double below = at(node, lower);
  const double temperature =
      TemperatureGrid::knot(lower) + TemperatureGrid::width * (enthalpy - below) / (at(node, upper) - below);
  return std::clamp(temperature, coldest, hottest);  // rounding
}

double NodeEnthalpy::excess(int node, double enthalpy) const {
  const auto beyond = [&](double heat, int end_cell) {
    return heat * TemperatureGrid::width / (at(node, end_cell + 1) - at(node, end_cell));
  };
  if (enthalpy < least_[node]) return beyond(enthalpy - least_[node], grid_.first_cell());
  if (enthalpy > most_[node]) return beyond(enthalpy - most_[node], grid_.last_cell());
  return enthalpy >= least_[node] ? 0.0 : std::numeric_limits<double>::infinity();  // infinite for NaN
}

double NodeEnthalpy::least_capacity(int node, double temperature) const {
  double sum = 0.0;
  for (int i = begin_[node]; i < begin_[node + 1]; ++i)
    sum += shares_[i].volume * (*tables_)[shares_[i].material].least_capacity(temperature);
  return sum;
}

double NodeEnthalpy::least_capacity(int node) const {
  double sum = 0.0;
  for (int i = begin_[node]; i < begin_[node + 1]; ++i)
    sum += shares_[i].volume * (*tables_)[shares_[i].material].least_capacity();
  return sum;
}

}  // namespace pyroclast
