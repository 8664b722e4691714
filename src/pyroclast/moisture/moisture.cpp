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
constexpr double kLeastStep = 1e-9;     ///< s, in which a crack that steam flows through keeps its water
constexpr double kGrowth = 1.5;         ///< of steps, where one converged
/// Share of a cell's water that a crack takes at most where it opens.
constexpr double kMostTaken = 0.1;

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

/// Returns the side that a phase comes from.
int upwind(const WithSlope& a, const WithSlope& b) {
  return a.value >= b.value ? 0 : 1;
}

void add_vapour(Flow& flow, double conductance, const Side& a, const Side& b) {
  const auto &wa = a.water, &wb = b.water;
  const int from = upwind(a.pressure, b.pressure);
  const WithSlope& mobility = from == 0 ? wa.vapour_mobility : wb.vapour_mobility;
  flow.add(conductance * 0.5 * (wa.vapour_density.value + wb.vapour_density.value), mobility, from,
           a.pressure, b.pressure);
  const double by_density = 0.5 * conductance * mobility.value * (a.pressure.value - b.pressure.value);
  flow.by[0] += by_density * wa.vapour_density.slope;
  flow.by[1] += by_density * wb.vapour_density.slope;
}

Flow flow_between(double area, const Side& a, const Side& b) {
  Flow flow;
  const double conductance = area / (a.length / a.permeability + b.length / b.permeability);
  const auto& [wa, pa, ka, la] = a;
  const auto& [wb, pb, kb, lb] = b;
  const int from_liquid = upwind(wa.liquid_pressure, wb.liquid_pressure);
  flow.add(conductance, from_liquid == 0 ? wa.liquid_mobility : wb.liquid_mobility, from_liquid,
           wa.liquid_pressure, wb.liquid_pressure);
  add_vapour(flow, conductance, a, b);
  const double drop = pa.value - pb.value;
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
  make_links();
}

bool Moisture::opens(int outer_face) const {
  const auto& condition = conditions_[outer_face];
  const auto* air = condition ? std::get_if<MoistAir>(&*condition) : nullptr;
  return condition && !(air && air->coefficient == 0.0);
}

/// Lists the nodes and the ways between them, for the cracks that the state has.
void Moisture::make_links() {
  const auto& cracks = state_.cracks;
  crack_at_.assign(mesh_.faces.size(), -1);
  volume_ = mesh_.volume;
  measured_over_ = mesh_.volume;
  for (std::size_t i = 0; i < cracks.size(); ++i) {
    const CellFace& face = mesh_.faces[cracks[i].face];
    crack_at_[cracks[i].face] = static_cast<int>(i);
    volume_.push_back(face.area * cracks[i].width);
    measured_over_.push_back(0.5 * (mesh_.volume[face.cells[0]] + mesh_.volume[face.cells[1]]));
  }
  links_.clear();
  const int first_crack = mesh_.cell_count();
  for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
    const CellFace& face = mesh_.faces[f];
    if (crack_at_[f] < 0) {
      links_.push_back({face.cells, face.area, face.lengths});
      continue;
    }
    for (int side = 0; side < 2; ++side)
      links_.push_back(
          {{face.cells[side], first_crack + crack_at_[f]}, face.area, {face.lengths[side], 0.0}});
  }
  std::vector<bool> open;
  for (int f = 0; f < std::ssize(conditions_); ++f) open.push_back(opens(f));
  CrackNetwork network = crack_network(mesh_, cracks, open, parameters_.roughness);
  for (const CrackConduit& conduit : network.conduits)
    links_.push_back({{first_crack + conduit.cracks[0], first_crack + conduit.cracks[1]},
                      conduit.conductance,
                      {0.0, 0.0},
                      true});
  mouths_ = std::move(network.mouths);
  make_pattern();
}

void Moisture::make_pattern() {
  const int nodes = node_count();
  std::vector<std::vector<int>> rows(nodes);
  for (int n = 0; n < nodes; ++n) rows[n].push_back(n);
  for (const Link& link : links_) {
    rows[link.nodes[0]].push_back(link.nodes[1]);
    rows[link.nodes[1]].push_back(link.nodes[0]);
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
  diagonal_.clear();
  for (int n = 0; n < nodes; ++n) diagonal_.push_back(entry(n, n));
  for (Link& link : links_) {
    const auto [a, b] = link.nodes;
    link.own = {diagonal_[a], diagonal_[b]};
    link.other = {entry(b, a), entry(a, b)};
  }
  entry_count_ = all.size();
  solver_.reset();
  if (nodes > 0) solver_.emplace(std::move(begin), std::move(all));
}

void Moisture::go_on_from(MoistureState state) {
  state_ = std::move(state);
  make_links();
}

void Moisture::apply(const std::vector<int>& outer_faces, const MoistureCondition& condition) {
  if (const auto* air = std::get_if<MoistAir>(&condition))
    require(air->coefficient >= 0.0, "moisture", "the coefficient of the air", air->coefficient,
            "0 m/s or more");
  for (const int face : outer_faces) conditions_.at(face) = condition;
  if (!state_.cracks.empty()) make_links();  // cracks open to the outside there
}

PoreConditions Moisture::conditions(int cell) const {
  return {pores(cell), state_.temperature[cell], state_.highest_temperature[cell]};
}

/// Returns the temperature of a crack, degC: the mean of the cells beside it.
double Moisture::crack_temperature(int face, const std::vector<double>& temperature) const {
  const auto [a, b] = mesh_.faces[face].cells;
  return 0.5 * (temperature[a] + temperature[b]);
}

PoreConditions Moisture::crack_conditions(int face, const std::vector<double>& temperature) const {
  const double mean = crack_temperature(face, temperature);
  return {pores(mesh_.faces[face].cells[0]), mean, mean};
}

/// Returns the part of one side in what flows through a face, from 0 to 1.
double Moisture::share_of_side(int face, int side) const {
  const CellFace& f = mesh_.faces[face];
  const auto conductance = [&](int of) { return conditions(f.cells[of]).permeability / f.lengths[of]; };
  const double here = conductance(side), there = conductance(1 - side);
  return here / (here + there);
}

double Moisture::face_pressure(int face) const {
  if (const int crack = crack_at_[face]; crack >= 0) return state_.crack_pressure[crack];
  const auto [a, b] = mesh_.faces[face].cells;
  const double share = share_of_side(face, 0);
  return share * state_.pressure[a] + (1.0 - share) * state_.pressure[b];
}

/// Puts water into a cell, kg; less than 0 takes it out.
void Moisture::add_to_cell(int cell, double water) {
  state_.content[cell] += water / mesh_.volume[cell];
  state_.pressure[cell] = pressure_of_content(conditions(cell), state_.content[cell], state_.pressure[cell]);
}

void Moisture::set_cracks(std::vector<OpenFace> cracks) {
  std::vector<double> water, guess;
  std::vector<bool> stays(state_.cracks.size());
  for (const OpenFace& crack : cracks) {
    const CellFace& face = mesh_.faces.at(crack.face);
    guess.push_back(face_pressure(crack.face));
    if (const int before = crack_at_[crack.face]; before >= 0) {
      stays[before] = true;
      water.push_back(state_.crack_water[before]);
      continue;
    }
    const PoreConditions at = crack_conditions(crack.face, state_.temperature);
    const double vapour = face.area * crack.width * vapour_density(at, guess.back());
    double taken = 0.0;
    for (const int cell : face.cells) {
      const double most = kMostTaken * mesh_.volume[cell] * state_.content[cell];
      const double part = std::min(0.5 * vapour, most);
      add_to_cell(cell, -part);
      taken += part;
    }
    water.push_back(taken);
  }
  for (std::size_t i = 0; i < stays.size(); ++i) {
    if (stays[i]) continue;
    const int face = state_.cracks[i].face;
    for (int side = 0; side < 2; ++side)
      add_to_cell(mesh_.faces[face].cells[side], share_of_side(face, side) * state_.crack_water[i]);
  }
  state_.cracks = std::move(cracks);
  state_.crack_water = std::move(water);
  state_.crack_pressure.clear();
  for (std::size_t i = 0; i < state_.cracks.size(); ++i) {
    const OpenFace& crack = state_.cracks[i];
    const double content = state_.crack_water[i] / (mesh_.faces[crack.face].area * crack.width);
    state_.crack_pressure.push_back(pressure_of_content(crack_conditions(crack.face, state_.temperature),
                                                        content, guess[i], crack_water<WithSlope>));
  }
  make_links();
}

void Moisture::reduce_to(MoistureMesh mesh, const std::vector<int>& outer) {
  const double before = stored();
  std::vector<int> cells;  // present cell of each one that stays
  for (const int block : mesh.block) cells.push_back(mesh_.cell_of_block[block]);
  for (auto* of_cells :
       {&state_.content, &state_.pressure, &state_.temperature, &state_.highest_temperature}) {
    std::vector<double> kept;
    for (const int cell : cells) kept.push_back((*of_cells)[cell]);
    *of_cells = std::move(kept);
  }
  std::vector<OpenFace> cracks;
  std::vector<double> crack_water, crack_pressure;
  for (std::size_t f = 0; f < mesh.cell_face.size(); ++f) {
    const int face = mesh.cell_face[f], earlier = mesh_.cell_face[f];
    if (face < 0 || crack_at_[earlier] < 0) continue;
    const int crack = crack_at_[earlier];
    cracks.push_back({face, state_.cracks[crack].width, state_.cracks[crack].at_ends});
    crack_water.push_back(state_.crack_water[crack]);
    crack_pressure.push_back(state_.crack_pressure[crack]);
  }
  state_.cracks = std::move(cracks);
  state_.crack_water = std::move(crack_water);
  state_.crack_pressure = std::move(crack_pressure);
  std::vector<std::optional<MoistureCondition>> conditions;
  for (const int face : outer) conditions.push_back(face < 0 ? std::nullopt : conditions_[face]);
  conditions_ = std::move(conditions);
  surface_mobility_.resize(conditions_.size());
  mesh_ = std::move(mesh);
  make_links();
  state_.ledger.removed += before - stored();
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
  for (const double water : state_.crack_water) sum += water;
  return sum;
}

double Moisture::imbalance() const {
  return stored() -
         (state_.ledger.at_start + state_.ledger.released - state_.ledger.left - state_.ledger.removed);
}

double Moisture::saturation(int cell) const {
  return pore_water(conditions(cell), state_.pressure[cell]).saturation;
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
  target_.resize(volume_.size());
  pressure_.resize(volume_.size());
  water_.resize(volume_.size());
  for (int c = 0; c < mesh_.cell_count(); ++c) {
    const double highest = std::max(state_.highest_temperature[c], temperature[c]);
    at_.emplace_back(pores(c), temperature[c], highest);
    target_[c] = state_.content[c] +
                 pores(c).cement * (dehydrated(highest) - dehydrated(state_.highest_temperature[c]));
    pressure_[c] =
        state_.pressure[c] * (at_[c].saturation_pressure / water::saturation_pressure(state_.temperature[c]));
  }
  for (std::size_t i = 0; i < state_.cracks.size(); ++i) {
    const int face = state_.cracks[i].face, node = mesh_.cell_count() + static_cast<int>(i);
    at_.push_back(crack_conditions(face, temperature));
    target_[node] = state_.crack_water[i] / volume_[node];
    pressure_[node] =
        state_.crack_pressure[i] * (at_[node].saturation_pressure /
                                    water::saturation_pressure(crack_temperature(face, state_.temperature)));
  }
  for (std::size_t f = 0; f < mesh_.outer_faces.size(); ++f) {
    const int c = mesh_.outer_faces[f].cell;
    const PoreWater<double> w = pore_water(at_[c], pressure_[c]);
    surface_mobility_[f] =
        at_[c].permeability * (w.liquid_mobility + w.vapour_mobility * w.vapour_density) + w.diffusion;
  }
}

/// Adds the flows through all faces to the nodes' outflow, kg/s, and their derivatives to the matrix. Returns
/// the flow out of the body, kg/s.
double Moisture::flow_out(double time) {
  const auto side = [&](int node, double length) {
    return Side{water_[node], {pressure_[node], pressure_[node]}, at_[node].permeability, length};
  };
  for (const Link& link : links_) {
    const auto [a, b] = link.nodes;
    Flow flow;
    if (link.is_conduit)
      add_vapour(flow, link.area, side(a, 0.0), side(b, 0.0));
    else
      flow = flow_between(link.area, side(a, link.lengths[0]), side(b, link.lengths[1]));
    outflow_[a] += flow.value;
    outflow_[b] -= flow.value;
    entries_[link.own[0]] += flow.by[0];
    entries_[link.other[0]] -= flow.by[0];
    entries_[link.own[1]] -= flow.by[1];
    entries_[link.other[1]] += flow.by[1];
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
  return left + flow_out_of_mouths(time);
}

/// Adds what leaves through the mouths of cracks, as flow_out does.
double Moisture::flow_out_of_mouths(double time) {
  double left = 0.0;
  for (const CrackMouth& mouth : mouths_) {
    const int node = mesh_.cell_count() + mouth.crack;
    const WithSlope outside =
        std::visit(Overloaded{[&](const MoistAir& air) { return air.vapour_density(time) * at_[node].gas; },
                              [&](const GivenPressure& given) { return given.pressure(time); }},
                   *conditions_[mouth.outer_face]);
    const PoreWater<WithSlope> there = crack_water(at_[node], outside);
    Flow flow;
    add_vapour(flow, mouth.conductance, {water_[node], {pressure_[node], pressure_[node]}, 0.0, 0.0},
               {there, outside, 0.0, 0.0});
    outflow_[node] += flow.value;
    entries_[diagonal_[node]] += flow.by[0];
    left += flow.value;
  }
  return left;
}

/// Computes the water of all nodes and the system of equations of a step. Returns the largest amount by which
/// a balance is off, kg/m3.
double Moisture::balance(double step) {
  const int cells = mesh_.cell_count();
  for (int n = 0; n < node_count(); ++n) {
    const WithSlope pressure(pressure_[n], pressure_[n]);
    water_[n] = n < cells ? pore_water(at_[n], pressure) : crack_water(at_[n], pressure);
    entries_[diagonal_[n]] = volume_[n] / step * water_[n].content.slope;
  }
  left_ = flow_out(state_.time + step);
  double worst = 0.0;
  step_.resize(volume_.size());
  for (int n = 0; n < node_count(); ++n) {
    const double off = volume_[n] / step * (water_[n].content.value - target_[n]) + outflow_[n];
    step_[n] = -off;
    worst = std::max(worst, std::abs(off) * step / measured_over_[n]);
  }
  return worst;
}

/// Books the flows of a step that converged. Water is what they make of the contents, and pressures follow.
void Moisture::end_step(double step, const std::vector<double>& temperature) {
  double released = 0.0;
  for (int c = 0; c < mesh_.cell_count(); ++c) {
    released += mesh_.volume[c] * (target_[c] - state_.content[c]);
    state_.content[c] = target_[c] - step / mesh_.volume[c] * outflow_[c];
    state_.pressure[c] = pressure_of_content(at_[c], state_.content[c], pressure_[c]);
    state_.temperature[c] = temperature[c];
    state_.highest_temperature[c] = std::max(state_.highest_temperature[c], temperature[c]);
  }
  for (std::size_t i = 0; i < state_.cracks.size(); ++i) {
    const int node = mesh_.cell_count() + static_cast<int>(i);
    state_.crack_water[i] -= step * outflow_[node];
    state_.crack_pressure[i] = pressure_of_content(at_[node], state_.crack_water[i] / volume_[node],
                                                   pressure_[node], crack_water<WithSlope>);
  }
  state_.ledger.released += released;
  state_.ledger.left += step * left_;
  state_.time += step;
  ++state_.steps;
}

/// Tells whether the flows of a step leave some water in each crack: a crack holds little.
bool Moisture::leaves_water_in_cracks(double step) const {
  for (std::size_t i = 0; i < state_.cracks.size(); ++i)
    if (!(state_.crack_water[i] > step * outflow_[mesh_.volume.size() + i])) return false;
  return true;
}

/// Changes pressures by an iteration. In a crack that comes to saturation from either side the search goes on
/// at saturation, where its content rises most steeply: from there Newton's method cannot run back and forth.
void Moisture::change_pressures() {
  for (int n = 0; n < node_count(); ++n) {
    const double before = pressure_[n], saturated = at_[n].saturation_pressure;
    pressure_[n] *= exp(std::clamp(step_[n], -kLargestChange, kLargestChange));
    if (n >= mesh_.cell_count() && (before - saturated) * (pressure_[n] - saturated) < 0.0)
      pressure_[n] = saturated;
  }
}

bool Moisture::try_step(double step, const std::vector<double>& temperature) {
  begin_trial(temperature);
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    ++state_.iterations;
    entries_.assign(entry_count_, 0.0);
    outflow_.assign(volume_.size(), 0.0);
    const double worst = balance(step);
    if (worst < kTolerance && leaves_water_in_cracks(step)) {
      end_step(step, temperature);
      return true;
    }
    if (!std::isfinite(worst) || !solver_->solve(entries_, step_)) return false;
    change_pressures();
  }
  return false;
}

}  // namespace pyroclast
