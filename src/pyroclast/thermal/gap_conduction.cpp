#include "pyroclast/thermal/gap_conduction.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/model/outline.hpp"
#include "pyroclast/model/visit_contacts.hpp"
#include "pyroclast/thermal/require.hpp"
#include "pyroclast/thermal/zone_conduction.hpp"

namespace pyroclast {

namespace {

/// Conductance above which a contact joins its sides again, over that below which it parted them: so none
/// goes to and fro from exchange to exchange.
constexpr double kJoinsAbove = 2.0;

const GapHeat& checked(const GapHeat& law) {
  require(law.bridges >= 0.0 && std::isfinite(law.bridges), "heat through cracks",
          "the conductance of the bridges [W/(m2 K)]", law.bridges, "0 or greater");
  require(law.jump_distance > 0.0, "heat through cracks", "the jump distance [m]", law.jump_distance,
          "greater than 0");
  require(law.emissivity >= 0.0 && law.emissivity <= 1.0, "heat through cracks", "the emissivity",
          law.emissivity, "between 0 and 1");
  require(law.split_below > 0.0, "heat through cracks",
          "the conductance below which nodes are split [W/(m2 K)]", law.split_below, "greater than 0");
  return law;
}

}  // namespace

template <int Dim>
GapConduction<Dim>::GapConduction(const ModelOf<Dim>& model, const std::vector<bool>& conducts,
                                  const GapHeat& law, const TemperatureGrid& grid, Team& team)
    : model_(model),
      law_(checked(law)),
      grid_(grid),
      team_(team),
      gaps_(model.contacts.size()),
      parts_(model.contacts.size(), 0),
      by_chunk_(contacts_by_chunk(model)) {
  set_blocks(conducts);
  set_grid(grid);
}

template <int Dim>
void GapConduction<Dim>::set_blocks(const std::vector<bool>& conducts) {
  const auto conducting = gridpoints_of(model_, conducts);
  open_to_heat_.clear();
  for (const auto& c : model_.contacts) open_to_heat_.push_back(conducting[c.a] && conducting[c.b]);
}

template <int Dim>
void GapConduction<Dim>::set_grid(const TemperatureGrid& grid) {
  const Curve& gas = law_.gas_conductivity;
  const Interval range = grid.range();
  if (!gas.is_constant() && gas.axis() != temperature_axis())
    throw Error(fmt::format("the conductivity of the gas in cracks ({}) must be a curve of the temperature",
                            gas.describe()));
  if (!gas.holds(range))
    throw Error(
        fmt::format("the conductivity of the gas in cracks ({}) does not cover the run's temperature "
                    "range of {} to {} degC",
                    gas.describe(), range.lower, range.upper));
  if (const double least = gas.minimum(range.lower, range.upper); !(least > 0.0))
    throw Error(
        fmt::format("the conductivity of the gas in cracks ({}) falls to {}, but it must be greater "
                    "than 0 from {} to {} degC",
                    gas.describe(), least, range.lower, range.upper));
  grid_ = grid;
  gas_.clear();
  for (int knot = grid.first_cell(); knot <= grid.last_cell() + 1; ++knot)
    gas_.push_back(gas(std::clamp(TemperatureGrid::knot(knot), gas.range().lower, gas.range().upper)));
}

template <int Dim>
double GapConduction<Dim>::gas(double temperature) const {
  const int cell = grid_.cell(temperature);
  const double* value = gas_.data() + (cell - grid_.first_cell());
  return value[0] + TemperatureGrid::fraction(temperature, cell) * (value[1] - value[0]);
}

template <int Dim>
double GapConduction<Dim>::greatest_gas(double coldest, double hottest) const {
  const auto first = gas_.begin() - grid_.first_cell();
  return *std::max_element(first + grid_.cell(coldest), first + grid_.cell(hottest) + 2);
}

template <int Dim>
bool GapConduction<Dim>::set_gaps(std::vector<ContactGap> gaps, const std::vector<double>& temperature) {
  if (gaps.size() != gaps_.size())
    throw Error(
        fmt::format("heat through cracks: {} gaps are given for {} contacts", gaps.size(), gaps_.size()));
  for (const ContactGap& gap : gaps) {
    require(gap.damage >= 0.0 && gap.damage <= 1.0, "heat through cracks", "a contact's damage", gap.damage,
            "between 0 and 1");
    require(gap.opening >= 0.0 && std::isfinite(gap.opening), "heat through cracks",
            "a contact's opening [m]", gap.opening, "0 or greater");
  }
  gaps_ = std::move(gaps);
  bool changes = false;
  for (std::size_t i = 0; i < gaps_.size(); ++i) {
    if (!open_to_heat_[i]) continue;
    const auto& c = model_.contacts[i];
    const double h = conductance(static_cast<int>(i), temperature[c.a], temperature[c.b]);
    const bool parted = parts_[i] != 0;
    const bool parts = parted ? h <= kJoinsAbove * law_.split_below : h < law_.split_below;
    changes = changes || parts != parted;
    parts_[i] = parts ? 1 : 0;
  }
  return changes;
}

template <int Dim>
void GapConduction<Dim>::set_nodes(const ThermalNodes& nodes) {
  crossings_.clear();
  for (int i = 0; i < model_.contact_count(); ++i) {
    const auto& c = model_.contacts[i];
    const int a = nodes.of_gridpoint[c.a], b = nodes.of_gridpoint[c.b];
    if (open_to_heat_[i] && a != b) crossings_.push_back({i, a, b});
  }
  heat_.assign(crossings_.size(), 0.0);
  std::vector<int> contacts;
  for (const Crossing& x : crossings_) contacts.push_back(x.contact);
  crossing_ = contacts_by_chunk(by_chunk_, contacts);
  begin_.assign(static_cast<std::size_t>(nodes.count()) + 1, 0);
  for (const Crossing& x : crossings_)
    for (const int node : {x.a, x.b}) ++begin_[node + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  sides_.resize(2 * crossings_.size());
  auto next = begin_;
  for (int i = 0; i < static_cast<int>(crossings_.size()); ++i) {
    sides_[next[crossings_[i].a]++] = 2 * i;
    sides_[next[crossings_[i].b]++] = 2 * i + 1;
  }
}

template <int Dim>
void GapConduction<Dim>::update(const std::vector<double>& temperature) {
  team_.share(static_cast<std::ptrdiff_t>(crossings_.size()), fewest_for_threads,
              [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                for (auto i = begin; i < end; ++i) {
                  const Crossing& x = crossings_[i];
                  const double a = temperature[x.a], b = temperature[x.b];
                  heat_[i] = model_.contacts[x.contact].area * conductance(x.contact, a, b) * (a - b);
                }
              });
}

template <int Dim>
double GapConduction<Dim>::inflow(int node) const {
  double sum = 0.0;
  for (int i = begin_[node]; i < begin_[node + 1]; ++i) {
    const double heat = heat_[sides_[i] / 2];
    sum += sides_[i] % 2 == 0 ? -heat : heat;
  }
  return sum;
}

template <int Dim>
void GapConduction<Dim>::add_around(int node, const std::vector<double>& temperature, Interval& range) const {
  for (int i = begin_[node]; i < begin_[node + 1]; ++i) {
    const Crossing& x = crossings_[sides_[i] / 2];
    include(range, temperature[sides_[i] % 2 == 0 ? x.b : x.a]);
  }
}

template <int Dim>
void GapConduction<Dim>::add_row_bound(const Interval& temperatures, const std::vector<double>& hottest,
                                       std::vector<double>& rows) const {
  if (crossings_.empty()) return;
  const double gas = greatest_gas(temperatures.lower, temperatures.upper);
  for (const Crossing& x : crossings_) {
    const double steepest = model_.contacts[x.contact].area *
                            law_.steepest(gaps_[x.contact], gas, std::max(hottest[x.a], hottest[x.b]));
    rows[x.a] += 2.0 * steepest;  // once on the diagonal and once beside it
    rows[x.b] += 2.0 * steepest;
  }
}

template <int Dim>
std::vector<double> GapConduction<Dim>::conductances(const std::vector<double>& temperature) const {
  std::vector<double> result(gaps_.size());
  for (int i = 0; i < model_.contact_count(); ++i)
    if (open_to_heat_[i])
      result[i] = conductance(i, temperature[model_.contacts[i].a], temperature[model_.contacts[i].b]);
  return result;
}

template <int Dim>
double GapConduction<Dim>::area() const {
  return chunked_sum(crossing_.chunks, [&](int i) { return model_.contacts[crossing_.contacts[i]].area; });
}

template <int Dim>
void GapConduction<Dim>::visit_state(StateVisitor& visitor) {
  struct Gap {
    double damage, opening, parts;
  };
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i < gaps_.size(); ++i)
    gaps.push_back({gaps_[i].damage, gaps_[i].opening, static_cast<double>(parts_[i])});
  visit_contacts(visitor, "gaps", model_, gaps, state::at_least(0));
  for (std::size_t i = 0; i < gaps_.size(); ++i) {
    visitor.require(gaps[i].damage <= 1.0, "gaps", "has a damage above 1");
    visitor.require(gaps[i].parts == 0.0 || gaps[i].parts == 1.0, "gaps", "parts neither, nor joins");
    gaps_[i] = {gaps[i].damage, gaps[i].opening};
    parts_[i] = static_cast<std::uint8_t>(gaps[i].parts);
  }
}

template class GapConduction<2>;
template class GapConduction<3>;

}  // namespace pyroclast
