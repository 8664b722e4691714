#include "pyroclast/moisture/moisture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/overloaded.hpp"
#include "pyroclast/thermal/require.hpp"

namespace pyroclast {

namespace {

constexpr int kMostIterations = 20;
constexpr double kTolerance = 1e-6;     ///< of the balance of a cell in a step, kg/m3
constexpr double kLargestChange = 1.0;  ///< of ln p in an iteration
constexpr double kLeastStep = 1e-4;     ///< s
constexpr double kGrowth = 1.5;         ///< of steps, where one converged

/// Flow from one side of a face to the other, kg/s, and its derivatives by ln p of both sides.
struct Flow {
  double value = 0.0;
  double by[2] = {0.0, 0.0};

  /// Adds the flow conductance times mobility times the drop of a potential; the mobility is that of a side.
  void add(double conductance, const WithSlope& mobility, int side, const WithSlope& from,
           const WithSlope& to) {
    const double drop = from.value - to.value;
    value += conductance * mobility.value * drop;
    by[0] += conductance * mobility.value * from.slope;
    by[1] -= conductance * mobility.value * to.slope;
    by[side] += conductance * mobility.slope * drop;
  }
};

/// What stands on one side of a face.
struct Side {
  const PoreWater<WithSlope>& water;
  WithSlope pressure;   ///< of vapour, Pa
  double permeability;  ///< m2
  double length;        ///< to the face, m
};

Flow flow_between(double area, const Side& a, const Side& b) {
  Flow flow;
  const double conductance = area / (a.length / a.permeability + b.length / b.permeability);
  const auto upwind = [&](const WithSlope& from, const WithSlope& to) {
    return from.value >= to.value ? 0 : 1;
  };
  const auto& [wa, pa, ka, la] = a;
  const auto& [wb, pb, kb, lb] = b;
  const int from_liquid = upwind(wa.liquid_pressure, wb.liquid_pressure);
  flow.add(conductance, from_liquid == 0 ? wa.liquid_mobility : wb.liquid_mobility, from_liquid,
           wa.liquid_pressure, wb.liquid_pressure);
  const int from_vapour = upwind(pa, pb);
  const WithSlope& mobility = from_vapour == 0 ? wa.vapour_mobility : wb.vapour_mobility;
  flow.add(conductance * 0.5 * (wa.vapour_density.value + wb.vapour_density.value), mobility, from_vapour, pa,
           pb);
  const double drop = pa.value - pb.value, by_density = 0.5 * conductance * mobility.value * drop;
  flow.by[0] += by_density * wa.vapour_density.slope;
  flow.by[1] += by_density * wb.vapour_density.slope;
  const double da = wa.diffusion.value, db = wb.diffusion.value, both = la * db + lb * da;
  if (both > 0.0) {
    flow.add(area * da * db / both, WithSlope(1.0), 0, pa, pb);
    flow.by[0] += area * la * (db / both) * (db / both) * wa.diffusion.slope * drop;
    flow.by[1] += area * lb * (da / both) * (da / both) * wb.diffusion.slope * drop;
  }
  return flow;
}

}  // namespace

Moisture::Moisture(MoistureMesh mesh, std::vector<std::optional<PoreMaterial>> materials,
                   const MoistureParameters& parameters)
    : mesh_(std::move(mesh)), materials_(std::move(materials)), parameters_(parameters) {
  require(parameters_.largest_step > 0.0, "moisture", "the largest step", parameters_.largest_step,
          "above 0 s");
  require(parameters_.largest_temperature_step > 0.0, "moisture", "the largest change of a temperature",
          parameters_.largest_temperature_step, "above 0 K");
  for (const auto& material : materials_)
    if (material) material->check();
  conditions_.resize(mesh_.outer_faces.size());
  surface_mobility_.resize(mesh_.outer_faces.size());
  make_pattern();
}

void Moisture::make_pattern() {
  const int cells = mesh_.cell_count();
  std::vector<std::vector<int>> rows(cells);
  for (int c = 0; c < cells; ++c) rows[c].push_back(c);
  for (const CellFace& face : mesh_.faces) {
    rows[face.cells[0]].push_back(face.cells[1]);
    rows[face.cells[1]].push_back(face.cells[0]);
  }
  std::vector<int> begin{0}, all;
  for (auto& column : rows) {
    std::ranges::sort(column);
    column.erase(std::unique(column.begin(), column.end()), column.end());
    all.insert(all.end(), column.begin(), column.end());
    begin.push_back(static_cast<int>(all.size()));
  }
  const auto entry = [&](int row, int column) {
    const auto& of = rows[column];
    return begin[column] + static_cast<int>(std::ranges::lower_bound(of, row) - of.begin());
  };
  for (int c = 0; c < cells; ++c) diagonal_.push_back(entry(c, c));
  for (const CellFace& face : mesh_.faces) {
    const auto [a, b] = face.cells;
    slots_.push_back({{diagonal_[a], diagonal_[b]}, {entry(b, a), entry(a, b)}});
  }
  entry_count_ = all.size();
  if (cells > 0) solver_.emplace(std::move(begin), std::move(all));
}

void Moisture::apply(const std::vector<int>& outer_faces, const MoistureCondition& condition) {
  if (const auto* air = std::get_if<MoistAir>(&condition))
    require(air->coefficient >= 0.0, "moisture", "the coefficient of the air", air->coefficient,
            "0 m/s or more");
  for (const int face : outer_faces) conditions_.at(face) = condition;
}

PoreConditions Moisture::conditions(int cell) const {
  return {pores(cell), state_.temperature[cell], state_.highest_temperature[cell]};
}

void Moisture::start(double temperature) {
  state_ = {};
  state_.next_step = parameters_.largest_step;
  state_.temperature.assign(mesh_.volume.size(), temperature);
  state_.highest_temperature = state_.temperature;
  state_.pressure.resize(mesh_.volume.size());
  state_.content.resize(mesh_.volume.size());
}

void Moisture::start_with_saturation(double saturation, double temperature) {
  require(saturation > 0.0 && saturation <= 1.0, "moisture", "the saturation", saturation,
          "above 0 and at most 1");
  start(temperature);
  for (int c = 0; c < mesh_.cell_count(); ++c) {
    const PoreConditions at = conditions(c);
    state_.pressure[c] = pressure_of_saturation(at, saturation);
    state_.content[c] = pore_water(at, state_.pressure[c]).content;
  }
  state_.ledger.at_start = stored();
}

void Moisture::start_with_pressure(double pressure, double temperature) {
  require(pressure > 0.0, "moisture", "the vapour pressure", pressure, "above 0 Pa");
  start(temperature);
  for (int c = 0; c < mesh_.cell_count(); ++c) {
    state_.pressure[c] = pressure;
    state_.content[c] = pore_water(conditions(c), pressure).content;
  }
  state_.ledger.at_start = stored();
}

double Moisture::stored() const {
  double sum = 0.0;
  for (int c = 0; c < mesh_.cell_count(); ++c) sum += mesh_.volume[c] * state_.content[c];
  return sum;
}

double Moisture::imbalance() const {
  return stored() - (state_.ledger.at_start + state_.ledger.released - state_.ledger.left);
}

std::vector<double> Moisture::saturation() const {
  std::vector<double> found;
  for (int c = 0; c < mesh_.cell_count(); ++c)
    found.push_back(pore_water(conditions(c), state_.pressure[c]).saturation);
  return found;
}

std::vector<double> Moisture::pressure_ratio() const {
  std::vector<double> found;
  for (int c = 0; c < mesh_.cell_count(); ++c)
    found.push_back(state_.pressure[c] / water::saturation_pressure(state_.temperature[c]));
  return found;
}

void Moisture::advance(double duration, const std::vector<double>& temperature) {
  const std::vector<double> first = state_.temperature;
  double change = 0.0;
  for (std::size_t c = 0; c < first.size(); ++c)
    change = std::max(change, std::abs(temperature[c] - first[c]));
  const double of_temperature =
      change > 0.0 ? duration * parameters_.largest_temperature_step / change : duration;
  std::vector<double> next = temperature;
  for (double done = 0.0; done < duration;) {
    double step = std::min({state_.next_step, parameters_.largest_step, of_temperature});
    const bool is_last = duration - done <= step * (1.0 + 1e-9);
    if (is_last) step = duration - done;
    if (const double share = (done + step) / duration; is_last)
      next = temperature;
    else
      for (std::size_t c = 0; c < first.size(); ++c) next[c] = first[c] + share * (temperature[c] - first[c]);
    if (try_step(step, next)) {
      done = is_last ? duration : done + step;
      state_.next_step = std::min(parameters_.largest_step, std::max(state_.next_step, kGrowth * step));
    } else {
      ++state_.retries;
      state_.next_step = 0.5 * step;
      if (state_.next_step < kLeastStep)
        throw Error(
            fmt::format("moisture: no step of {:g} s or more converges at {:g} s", kLeastStep, state_.time));
    }
  }
}

void Moisture::begin_trial(const std::vector<double>& temperature) {
  at_.clear();
  target_.resize(temperature.size());
  pressure_.resize(temperature.size());
  water_.resize(temperature.size());
  for (int c = 0; c < mesh_.cell_count(); ++c) {
    const double highest = std::max(state_.highest_temperature[c], temperature[c]);
    at_.emplace_back(pores(c), temperature[c], highest);
    target_[c] = state_.content[c] +
                 pores(c).cement * (dehydrated(highest) - dehydrated(state_.highest_temperature[c]));
    pressure_[c] =
        state_.pressure[c] * (at_[c].saturation_pressure / water::saturation_pressure(state_.temperature[c]));
  }
  for (std::size_t f = 0; f < mesh_.outer_faces.size(); ++f) {
    const int c = mesh_.outer_faces[f].cell;
    const PoreWater<double> w = pore_water(at_[c], pressure_[c]);
    surface_mobility_[f] =
        at_[c].permeability * (w.liquid_mobility + w.vapour_mobility * w.vapour_density) + w.diffusion;
  }
}

/// Adds the flows through all faces to the cells' outflow, kg/s, and their derivatives to the matrix. Returns
/// the flow out of the body, kg/s.
double Moisture::flow_out(double time) {
  const auto side = [&](int cell, double length) {
    return Side{water_[cell], {pressure_[cell], pressure_[cell]}, at_[cell].permeability, length};
  };
  for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
    const CellFace& face = mesh_.faces[f];
    const auto [a, b] = face.cells;
    const Flow flow = flow_between(face.area, side(a, face.lengths[0]), side(b, face.lengths[1]));
    outflow_[a] += flow.value;
    outflow_[b] -= flow.value;
    entries_[slots_[f].own[0]] += flow.by[0];
    entries_[slots_[f].other[0]] -= flow.by[0];
    entries_[slots_[f].own[1]] -= flow.by[1];
    entries_[slots_[f].other[1]] += flow.by[1];
  }
  double left = 0.0;
  for (std::size_t f = 0; f < mesh_.outer_faces.size(); ++f) {
    if (!conditions_[f]) continue;
    const OuterFace& face = mesh_.outer_faces[f];
    const int c = face.cell;
    const WithSlope flow = std::visit(Overloaded{[&](const MoistAir& air) {
                                                   const double film = air.coefficient / at_[c].gas,
                                                                half = surface_mobility_[f] / face.length;
                                                   return WithSlope(face.area * film * half / (film + half)) *
                                                          (WithSlope(pressure_[c], pressure_[c]) -
                                                           WithSlope(air.vapour_density(time) * at_[c].gas));
                                                 },
                                                 [&](const GivenPressure& given) {
                                                   const WithSlope outside = given.pressure(time);
                                                   const PoreWater<WithSlope> w = pore_water(at_[c], outside);
                                                   const Flow out =
                                                       flow_between(face.area, side(c, face.length),
                                                                    {w, outside, at_[c].permeability, 0.0});
                                                   return WithSlope(out.value, out.by[0]);
                                                 }},
                                      *conditions_[f]);
    outflow_[c] += flow.value;
    entries_[diagonal_[c]] += flow.slope;
    left += flow.value;
  }
  return left;
}

bool Moisture::try_step(double step, const std::vector<double>& temperature) {
  begin_trial(temperature);
  const int cells = mesh_.cell_count();
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    ++state_.iterations;
    entries_.assign(entry_count_, 0.0);
    outflow_.assign(cells, 0.0);
    for (int c = 0; c < cells; ++c) {
      water_[c] = pore_water(at_[c], WithSlope(pressure_[c], pressure_[c]));
      entries_[diagonal_[c]] = mesh_.volume[c] / step * water_[c].content.slope;
    }
    const double left = flow_out(state_.time + step);
    double worst = 0.0;
    step_.resize(cells);
    for (int c = 0; c < cells; ++c) {
      const double off = mesh_.volume[c] / step * (water_[c].content.value - target_[c]) + outflow_[c];
      step_[c] = -off;
      worst = std::max(worst, std::abs(off) * step / mesh_.volume[c]);
    }
    if (worst < kTolerance) {
      double released = 0.0;
      for (int c = 0; c < cells; ++c) {
        released += mesh_.volume[c] * (target_[c] - state_.content[c]);
        state_.content[c] = target_[c] - step / mesh_.volume[c] * outflow_[c];
        state_.pressure[c] = pressure_of_content(at_[c], state_.content[c], pressure_[c]);
        state_.temperature[c] = temperature[c];
        state_.highest_temperature[c] = std::max(state_.highest_temperature[c], temperature[c]);
      }
      state_.ledger.released += released;
      state_.ledger.left += step * left;
      state_.time += step;
      ++state_.steps;
      return true;
    }
    if (!std::isfinite(worst) || !solver_->solve(entries_, step_)) return false;
    for (int c = 0; c < cells; ++c)
      pressure_[c] *= exp(std::clamp(step_[c], -kLargestChange, kLargestChange));
  }
  return false;
}

}  // namespace pyroclast
