#include "pyroclast/thermal/conduction.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/thermal/require.hpp"

namespace pyroclast {

namespace {

/// Excess over the temperature range, as a fraction of its width, that can still be numerical where a given
/// flux or a gas outside the range may truly take the body out of it. (Zones of a random
/// tessellation in the standard fire of ISO 834 showed 0.00015.)
constexpr double kDoubtfulExcess = 0.01;

/// Product of zones and stages that takes some tenths of a second on one thread.
constexpr std::int64_t kZonesPerBatch = 4'000'000;

/// Change of temperature that limits take away in a step, over `kAllowedBeyond`, above which they stay on: a
/// step that is done twice costs more than one that is limited without need.
constexpr double kLimitsMatter = 0.1;

/// Stages of a step whose sums are kept until they travel to other ranks.
constexpr std::int64_t kMostKept = 1000;

const Interval& checked(const Interval& range) {
  if (!(absolute_zero <= range.lower && range.lower <= range.upper && std::isfinite(range.upper)))
    throw Error(fmt::format(
        "heat conduction: the temperature range is {} to {} degC, but it must not descend, and begin "
        "no lower than {} degC",
        range.lower, range.upper, absolute_zero));
  return range;
}

const HeatParameters& checked(const HeatParameters& p) {
  checked(p.temperature_range);
  require(p.temperature_range.contains(p.initial_temperature), "heat conduction", "the initial temperature",
          p.initial_temperature, "within the temperature range");
  require(p.safety > 0.0 && p.safety <= 1.0, "heat conduction", "the safety factor", p.safety,
          "greater than 0 and at most 1");
  require(p.largest_change > 0.0, "heat conduction", "the largest change per step [K]", p.largest_change,
          "greater than 0");
  require(p.largest_step > 0.0, "heat conduction", "the largest step [s]", p.largest_step, "greater than 0");
  return p;
}

/// Numbers the materials that conduct; -1 for the others.
std::vector<int> table_indices(const std::vector<std::string>& names,
                               const std::vector<std::optional<HeatMaterial>>& materials) {
  if (materials.size() != names.size())
    throw Error(fmt::format("heat conduction: {} materials are given, but the model has {}", materials.size(),
                            names.size()));
  std::vector<int> index;
  int next = 0;
  for (const auto& material : materials) index.push_back(material ? next++ : -1);
  return index;
}

std::vector<bool> conducting(const Model& model, const std::vector<int>& table_of_material) {
  std::vector<bool> materials;
  for (const int table : table_of_material) materials.push_back(table >= 0);
  return blocks_of(model, materials);
}

std::vector<HeatTable> make_tables(const std::vector<std::string>& names,
                                   const std::vector<std::optional<HeatMaterial>>& materials,
                                   const TemperatureGrid& grid, double window) {
  std::vector<HeatTable> tables;
  for (std::size_t m = 0; m < materials.size(); ++m)
    if (materials[m]) tables.emplace_back(*materials[m], names[m], grid, window);
  return tables;
}

std::vector<double> total_volumes(const std::vector<std::vector<NodeShare>>& shares) {
  std::vector<double> volume;
  for (const auto& of_node : shares)
    volume.push_back(std::accumulate(of_node.begin(), of_node.end(), 0.0,
                                     [](double sum, const NodeShare& share) { return sum + share.volume; }));
  return volume;
}

/// Returns the strictest step of own nodes. By Gershgorin's theorem no rate of decay exceeds the largest row
/// sum over capacity.
template <class Capacity>
HeatStepLimit strictest(const std::vector<double>& rows, double safety, const ChunkList& nodes,
                        Capacity capacity) {
  HeatStepLimit limit{std::numeric_limits<double>::infinity(), 0};
  for (auto [node, last] = nodes.own(); node < last; ++node) {
    const double step = safety * 2.0 * capacity(node) / rows[node];
    if (step < limit.step) limit = {step, node};
  }
  return limit;
}

/// Returns the factor of the boundaries in the limit of a step, see Conduction::own_limit.
double weight_of_boundary(bool limits_flows) {
  return limits_flows ? 2.0 : 1.0;
}

}  // namespace

template <int Dim>
Conduction<Dim>::Conduction(const ModelOf<Dim>& model,
                            const std::vector<std::optional<HeatMaterial>>& materials,
                            const HeatParameters& parameters, std::shared_ptr<Team> team)
    : model_(model),
      parameters_(checked(parameters)),
      team_(team ? std::move(team) : std::make_shared<Team>()),
      grid_(parameters.temperature_range),
      table_of_material_(table_indices(model.material_names, materials)),
      conducts_(conducting(model, table_of_material_)),
      tables_(make_tables(model.material_names, materials, grid_, parameters.largest_change)),
      geometry_(zone_geometry(model)),
      outline_(pyroclast::outline(model, geometry_, conducts_)),
      zones_(tables_, *team_),
      store_(grid_, tables_, {}),
      prescriptions_(model.position.size()) {
  zones_.set_blocks(model, geometry_, table_of_blocks());
  if (parameters_.gaps) gaps_.emplace(model, conducts_, *parameters_.gaps, grid_, *team_);
  set_nodes(join_through_contacts(model, conducts_));
  if (!model.ranks().any(nodes_.count() > 0))
    throw Error("heat conduction: no block is of a material that conducts heat");
  state_.temperature_range = parameters.temperature_range;
  set_uniform_temperature(parameters.initial_temperature);
}

// ---- Nodes -----------------------------------------------------------------------------------------------

/// Sets up all that follows from which gridpoints share a node, except for their heat.
template <int Dim>
void Conduction<Dim>::set_nodes(ThermalNodes nodes) {
  nodes_ = std::move(nodes);
  zones_.set_nodes(nodes_);
  if (gaps_) gaps_->set_nodes(nodes_);
  const auto shares = zones_.shares();
  store_ = NodeEnthalpy(grid_, tables_, shares);
  volume_ = total_volumes(shares);
  node_chunks_ = model_.gridpoint_chunks().of_some(nodes_.gridpoint);
  halo_ = node_halo(model_, nodes_, node_chunks_);
  total_volume_ = chunked_sum(node_chunks_, [&](int node) { return volume_[node]; });
  for (auto* field : {&trial_.increment, &trial_.before, &trial_.first_rate, &boundary_heat_})
    field->assign(volume_.size(), 0.0);
  reach_.resize(volume_.size());
  shares_.resize(volume_.size());
  boundary_.clear();
  for (const Applied& applied : applied_) add_to_boundary(applied);
  prescriptions_.set_nodes(nodes_, node_chunks_);
}

template <int Dim>
void Conduction<Dim>::set_gaps(std::vector<ContactGap> gaps) {
  if (!gaps_) throw Error("heat conduction: nothing says how heat crosses gaps");
  drop_trial();
  const bool changes = gaps_->set_gaps(std::move(gaps), gridpoint_temperatures(grid_.range().lower));
  auto nodes = changes ? join_through_contacts(model_, conducts_, gaps_->parts()) : nodes_;
  if (model_.ranks().any(nodes.of_gridpoint != nodes_.of_gridpoint)) move_heat_to(std::move(nodes), [] {});
}

template <int Dim>
void Conduction<Dim>::remove(const std::vector<int>& blocks) {
  drop_trial();
  for (const int block : blocks) conducts_[block] = false;
  const std::vector<OutlineFace<Dim>> earlier = std::move(outline_);
  outline_ = pyroclast::outline(model_, geometry_, conducts_);
  const std::vector<int> of_earlier = earlier_faces(earlier, outline_);
  const auto follow = [&](std::vector<int>& faces) {
    std::vector<bool> acts(earlier.size());
    for (const int face : faces) acts[face] = true;
    faces.clear();
    for (int f = 0; f < std::ssize(of_earlier); ++f)
      if (of_earlier[f] >= 0 && acts[of_earlier[f]]) faces.push_back(f);
  };
  for (Applied& applied : applied_) follow(applied.faces);
  prescriptions_ = Prescriptions(model_.position.size());
  for (Prescribed& prescribed : prescribed_) {
    follow(prescribed.faces);
    hold(prescribed.faces, prescribed.temperature);
  }
  const std::vector<std::uint8_t> none;
  auto nodes = join_through_contacts(model_, conducts_, gaps_ ? gaps_->parts() : none);
  move_heat_to(std::move(nodes), [&] {
    zones_.set_blocks(model_, geometry_, table_of_blocks());
    if (gaps_) gaps_->set_blocks(conducts_);
  });
}

/// Moves the heat to other nodes: each gridpoint takes its share of its node's heat along. Heat that waits at
/// an end of the temperature range is shared out by volume, with what rounding leaves. Gridpoints without a
/// node take theirs out of the body.
/// \param before_set  function called before the nodes are set
template <int Dim>
template <class Before>
void Conduction<Dim>::move_heat_to(ThermalNodes nodes, Before before_set) {
  constexpr int kNone = -1, kSeveral = -2;
  halo_.spread(state_.enthalpy);  // an own node may have been a foreign one
  const ThermalNodes before = nodes_;
  const HeatState was = state_;
  const auto shares = gridpoint_shares();
  const NodeEnthalpy store(grid_, tables_, shares);
  std::vector<double> heat(shares.size()), left = was.enthalpy;
  std::vector<int> size_before(was.enthalpy.size()), size(static_cast<std::size_t>(nodes.count()));
  std::vector<int> from(size.size(), kNone);  // earlier node of all gridpoints of each node
  for (int g = 0; g < model_.gridpoint_count(); ++g) {
    const int old = before.of_gridpoint[g], now = nodes.of_gridpoint[g];
    if (old < 0) continue;
    heat[g] = store.enthalpy(g, was.temperature[old]);
    left[old] -= heat[g];
    ++size_before[old];
    if (now < 0) continue;
    ++size[now];
    from[now] = from[now] == kNone || from[now] == old ? old : kSeveral;
  }
  std::vector<double> enthalpy(size.size());
  for (int g = 0; g < model_.gridpoint_count(); ++g) {
    const int old = before.of_gridpoint[g], now = nodes.of_gridpoint[g];
    if (old < 0) continue;
    const double taken = heat[g] + left[old] * shares[g].front().volume / volume_[old];
    if (now >= 0) {
      enthalpy[now] += taken;
      continue;
    }
    const double at_start = store.enthalpy(g, parameters_.initial_temperature);
    state_.stored_at_start -= at_start;
    state_.ledger.removed += taken - at_start;
  }
  before_set();
  set_nodes(std::move(nodes));
  state_.enthalpy = std::move(enthalpy);
  state_.temperature.resize(size.size());
  for (int node = 0; node < nodes_.count(); ++node) {
    const int old = from[node];
    if (old == kSeveral) {
      const double near = was.temperature[before.of_gridpoint[nodes_.gridpoint[node]]];
      state_.temperature[node] = store_.temperature(node, state_.enthalpy[node], near);
      continue;
    }
    state_.temperature[node] = was.temperature[old];
    if (size[node] == size_before[old]) state_.enthalpy[node] = was.enthalpy[old];
  }
  halo_.spread(state_.temperature);  // of a foreign node a part may lack gridpoints
  halo_.spoil(state_.enthalpy);
}

/// Returns the share of each gridpoint: an equal part of every zone, all of the material of its block.
template <int Dim>
std::vector<std::vector<NodeShare>> Conduction<Dim>::gridpoint_shares() const {
  std::vector<std::vector<NodeShare>> shares(model_.position.size());
  for (int b = 0; b < model_.block_count(); ++b) {
    const int table = table_of_material_[model_.block_material[b]];
    if (table < 0) continue;
    for (int z = model_.block_zones[b]; z < model_.block_zones[b + 1]; ++z)
      for (int g : model_.zones[z]) {
        if (shares[g].empty()) shares[g].push_back({table, 0.0});
        shares[g].front().volume += geometry_.volume[z] / (Dim + 1);
      }
  }
  return shares;
}

/// Returns the index into the tables of each block; -1 where it conducts no heat.
template <int Dim>
std::vector<int> Conduction<Dim>::table_of_blocks() const {
  std::vector<int> tables;
  for (int b = 0; b < model_.block_count(); ++b)
    tables.push_back(conducts_[b] ? table_of_material_[model_.block_material[b]] : -1);
  return tables;
}

template <int Dim>
std::optional<double> Conduction<Dim>::hottest_gas() const {
  std::optional<double> hottest;
  const auto take = [&](const auto& condition) {
    if constexpr (requires { condition.gas_temperature; }) {
      const double gas = condition.gas_temperature(time());
      hottest = std::max(hottest.value_or(gas), gas);
    }
  };
  for (const Applied& applied : applied_) std::visit(take, applied.condition);
  return hottest;
}

template <int Dim>
void Conduction<Dim>::add_to_boundary(const Applied& applied) {
  std::vector<double> area(volume_.size());
  for (int face : applied.faces)
    for (int g : outline_.at(face).gridpoints) area[nodes_.of_gridpoint[g]] += outline_[face].area / Dim;
  std::vector<BoundaryPatch> patches;
  for (int node = 0; node < nodes_.count(); ++node)
    if (area[node] > 0.0) patches.push_back({node, area[node]});
  boundary_.add(applied.condition, std::move(patches), node_chunks_);
}

// ---- What acts on the body -------------------------------------------------------------------------------

template <int Dim>
void Conduction<Dim>::apply(const std::vector<int>& faces, const BoundaryCondition& condition) {
  drop_trial();
  const Applied applied{faces, condition};
  add_to_boundary(applied);
  applied_.push_back(applied);
}

template <int Dim>
void Conduction<Dim>::prescribe_temperature(const std::vector<int>& faces, const Curve& temperature) {
  drop_trial();
  prescribed_.push_back({faces, temperature});
  hold(faces, temperature);
  prescriptions_.set_nodes(nodes_, node_chunks_);
}

template <int Dim>
void Conduction<Dim>::hold(const std::vector<int>& faces, const Curve& temperature) {
  std::vector<int> gridpoints;
  for (int face : faces)
    for (int g : outline_.at(face).gridpoints) gridpoints.push_back(g);
  prescriptions_.add(gridpoints, temperature);
}

template <int Dim>
void Conduction<Dim>::widen_temperature_range(const Interval& range) {
  drop_trial();
  checked(range);
  const Interval present = grid_.range();
  const Interval wider{std::min(present.lower, range.lower), std::max(present.upper, range.upper)};
  if (wider == present) return;
  std::vector<int> waiting;  // nodes whose heat beyond the present range now comes to where it belongs
  for (auto [node, last] = node_chunks_.own(); node < last; ++node)
    if (excess(node, state_.temperature[node], state_.enthalpy[node]) != 0.0) waiting.push_back(node);
  grid_ = TemperatureGrid(wider);
  for (auto& table : tables_) table.extend(grid_);
  store_.set_grid(grid_);
  if (gaps_) gaps_->set_grid(grid_);
  state_.temperature_range = wider;
  for (int node : waiting)
    state_.temperature[node] = store_.temperature(node, state_.enthalpy[node], state_.temperature[node]);
  halo_.spread(state_.temperature);
}

template <int Dim>
void Conduction<Dim>::set_temperature(const std::vector<double>& temperature) {
  drop_trial();
  if (temperature.size() != volume_.size())
    throw Error(fmt::format("heat conduction: {} temperatures are given for {} nodes", temperature.size(),
                            volume_.size()));
  for (double t : temperature)
    require(grid_.range().contains(t), "heat conduction", "a node's temperature", t,
            "within the temperature range");
  state_.temperature = temperature;
  state_.enthalpy.resize(temperature.size());
  for (int node = 0; node < nodes_.count(); ++node)
    state_.enthalpy[node] = store_.enthalpy(node, temperature[node]);
  halo_.spoil(state_.enthalpy);
  state_.stored_at_start = total_enthalpy();
  state_.ledger = {};
  state_.bounds = nothing();
  for (const double t : temperature) include(state_.bounds, t);
  state_.bounds = {model_.ranks().least(state_.bounds.lower), model_.ranks().largest(state_.bounds.upper)};
  state_.limits = false;
}

template <int Dim>
void Conduction<Dim>::set_uniform_temperature(double temperature) {
  set_temperature(std::vector<double>(volume_.size(), temperature));
}

// ---- Running ---------------------------------------------------------------------------------------------

template <int Dim>
bool Conduction<Dim>::advance_step(double end, std::int64_t& stages, const std::vector<double>* begin) {
  if (trial_.under_way)
    require(end == trial_.end, "heat conduction", "the time to step towards [s]", end,
            "that of the step under way");
  else
    begin_run(end);
  return time() == end || continue_step(end, stages, begin);
}

template <int Dim>
void Conduction<Dim>::drop_trial() {
  if (!trial_.under_way) return;
  trial_.under_way = false;
  undo_begin(state_);
}

template <int Dim>
std::int64_t Conduction<Dim>::stages_per_batch() const {
  return std::max<std::int64_t>(1, kZonesPerBatch / model_.whole_zone_count());
}

template <int Dim>
void Conduction<Dim>::begin_run(double end) {
  require(end >= time(), "heat conduction", "the time to run to [s]", end, "no earlier than the present");
  boundary_.require_defined(time(), end);
  prescriptions_.require_within(grid_.range(), time(), end);
  prescriptions_.read(time(), grid_.range());
  before_run_ = {true, state_.next_step, state_.ledger.prescribed, state_.bounds, {}, {}};
  for (int node : prescriptions_.nodes()) {
    before_run_.temperature.push_back(state_.temperature[node]);
    before_run_.enthalpy.push_back(state_.enthalpy[node]);
  }
  const KeptSums heat_of_jump = hold_prescribed();
  Interval reach = boundary_.reach(time(), end);
  // Where nothing takes the exact solution out of the range, all excess is numerical.
  const double doubtful = kDoubtfulExcess * (grid_.range().upper - grid_.range().lower);
  const Interval wider{std::min(reach.lower, grid_.range().lower),
                       std::max(reach.upper, grid_.range().upper)};
  constexpr double any = std::numeric_limits<double>::max();
  allowed_below_ = grid_.range().holds(wider.lower, absolute_zero) ? any : doubtful;
  allowed_above_ = grid_.range().holds(wider.upper, absolute_zero) ? any : doubtful;
  include(state_.bounds, reach);
  include(state_.bounds, prescriptions_.reach(time(), end));
  begin_step(end, heat_of_jump);
}

/// Begins the first trial of a step. The limits of the step travel in one message, where the step is foreseen
/// without them.
template <int Dim>
void Conduction<Dim>::begin_step(double end, const KeptSums& heat_of_jump) {
  const bool is_over = time() == end;
  const Limits limits = state_.limits || parameters_.always_limits ? Limits::flows : Limits::none;
  const double weight = weight_of_boundary(limits != Limits::none);
  const double remaining = end - time();
  // Two equal steps to the end rather than a last one that is tiny.
  const auto step_above = [&](double safe_step) {
    return state_.next_step >= remaining ? remaining
                                         : std::min(state_.next_step, std::max(0.5 * remaining, safe_step));
  };
  const double foreseen = step_above(0.0);
  const double range_here = own_range_limit(end).step;
  const double limit_here = is_over ? 0.0 : own_limit(foreseen, weight, extremes()).step;
  Ranks& ranks = model_.ranks();
  const auto [heat, safe_step, limit] = ranks.together([&] {
    return std::array{heat_of_jump.totals(ranks).front(), ranks.least(range_here), ranks.least(limit_here)};
  });
  state_.ledger.prescribed += heat;
  safe_step_ = safe_step;
  if (state_.next_step == 0.0) state_.next_step = std::min(safe_step_, parameters_.largest_step);
  if (is_over) return;
  const double step = step_above(safe_step_);
  trial_.under_way = true;
  trial_.end = end;
  trial_.limit = step == foreseen ? limit : present_limit(step, weight).step;
  trial_.limits = limits;
  trial_.stages_done = trial_.retries = 0;
  begin_trial(step, limits);
}

/// Goes on with a step by at most `stages` stages, which it counts down; returns true when the step is
/// completed.
template <int Dim>
bool Conduction<Dim>::continue_step(double end, std::int64_t& stages, const std::vector<double>* begin) {
  const double remaining = end - time();
  Found found;
  for (;;) {
    for (; trial_.next_stage < trial_.stages.count(); ++trial_.next_stage, --stages) {
      if (stages <= 0) return false;
      run_stage(trial_.stages[trial_.next_stage]);
    }
    found = judge_trial(begin);
    const bool smallest = trial_.step <= safe_step_;
    const double half = std::max(0.5 * trial_.step, safe_step_);
    if (is_too_large()) {
      begin_trial(half, trial_.limits);
    } else if (found.oversteps) {
      begin_trial(trial_.step, trial_.limits == Limits::none ? Limits::flows : Limits::strict);
    } else if (trial_.below > allowed_below_ || trial_.above > allowed_above_) {
      if (smallest) refuse_excess();
      begin_trial(half, trial_.limits);
    } else {
      break;
    }
    ++trial_.retries;
  }
  accept_trial(found);
  if (trial_.step == remaining) state_.time = end;
  return true;
}

/// Tells whether a temperature changed by more than is allowed in a step that may be smaller.
template <int Dim>
bool Conduction<Dim>::is_too_large() const {
  return trial_.step > safe_step_ && trial_.change > parameters_.largest_change;
}

/// Finds what decides over the trial, and what follows once it is accepted, in one message.
template <int Dim>
typename Conduction<Dim>::Found Conduction<Dim>::judge_trial(const std::vector<double>* begin) {
  KeptSums sums;
  prescriptions_.keep_sum(sums, [&](int node) { return trial_.increment[node]; });
  sums.keep(node_chunks_, [&](int node) {
    const double speed = (trial_.temperature[node] - state_.temperature[node]) / trial_.step;
    return volume_[node] * speed * speed;
  });
  const bool oversteps_here = !is_too_large() && trial_.limits != Limits::strict && oversteps();
  const double change_here = trial_change();
  double since_here = 0.0;
  if (begin)
    for (auto [node, last] = node_chunks_.own(); node < last; ++node)
      since_here = std::max(since_here, std::abs((*begin)[node] - trial_.temperature[node]));
  Ranks& ranks = model_.ranks();
  Found found = ranks.together([&] {
    Found all;
    all.change = ranks.largest(trial_.change);
    all.below = ranks.largest(trial_.below);
    all.above = ranks.largest(trial_.above);
    all.left_out = ranks.largest(trial_.left_out);
    all.oversteps = ranks.any(oversteps_here);
    const std::vector<double> totals = sums.totals(ranks);
    all.prescribed = totals[0];
    all.squares = totals[1];
    all.largest_change = ranks.largest(change_here);
    all.since_begin = ranks.largest(since_here);
    all.inflows = trial_.inflows.totals(ranks);
    return all;
  });
  trial_.change = found.change;
  trial_.below = found.below;
  trial_.above = found.above;
  trial_.left_out = found.left_out;
  book_inflows(found.inflows);
  return found;
}

/// Adds the heat of the stages that are done to the ledger of the trial.
/// \param inflows  sums of trial_.inflows
template <int Dim>
void Conduction<Dim>::book_inflows(const std::vector<double>& inflows) {
  const std::size_t of_boundary = boundary_.count();
  for (std::span<const double> left(inflows); !left.empty(); left = left.subspan(of_boundary + 1)) {
    const double time = trial_.stages[trial_.booked++].weight * trial_.step;
    trial_.heat.boundary.add(time, boundary_.by_kind(left.first(of_boundary)));
    trial_.heat.prescribed -= time * left[of_boundary];
  }
  trial_.inflows.clear();
}

/// Returns the scheme of a trial. With limits that is forward Euler, which oversteps no bounds, where they
/// are strict or Euler takes no more stages than super time stepping.
template <int Dim>
HeatScheme Conduction<Dim>::trial_scheme(Limits limits, double ratio) const {
  if (limits == Limits::none) return parameters_.scheme;
  const bool is_cheap =
      fewest_stages(HeatScheme::euler, ratio) <= fewest_stages(HeatScheme::super_time_stepping, ratio);
  return limits == Limits::strict || is_cheap ? HeatScheme::euler : parameters_.scheme;
}

template <int Dim>
void Conduction<Dim>::begin_trial(double step, Limits limits) {
  // A node would pass the temperatures that draw it from outside where a step takes all of its heat by more
  // than one way; so boundaries count twice.
  if (limits != Limits::none && trial_.limits == Limits::none)
    trial_.limit = present_limit(step, weight_of_boundary(true)).step;
  trial_.step = step;
  trial_.left_out = 0.0;
  const HeatScheme scheme = trial_scheme(limits, step / trial_.limit);
  const bool is_strict = limits != Limits::none && scheme == HeatScheme::euler;
  trial_.limits = is_strict ? Limits::strict : limits;
  trial_.stages = TimeStages(scheme, fewest_stages(scheme, step / trial_.limit));
  trial_.next_stage = 0;
  trial_.change = trial_.below = trial_.above = 0.0;
  trial_.heat = {};
  trial_.inflows.clear();
  trial_.booked = 0;
  trial_.temperature = state_.temperature;
  std::fill(trial_.increment.begin(), trial_.increment.end(), 0.0);
  std::fill(trial_.before.begin(), trial_.before.end(), 0.0);
  halo_.spoil(trial_.increment);
}

template <int Dim>
void Conduction<Dim>::run_stage(const TimeStage& stage) {
  const double step = trial_.step;
  compute_inflow(time() + stage.begin * step);
  const bool travels = model_.ranks().count() > 1;  // at the end of the step, or when much is kept
  if (!travels || (trial_.next_stage - trial_.booked) >= kMostKept)
    book_inflows(trial_.inflows.totals(model_.ranks()));
  prescriptions_.read(time() + stage.end * step, grid_.range());
  update_nodes(stage);
  ++trial_.stages_done;
}

/// Computes the right side of Eq. (1), integrated over each node's part of the body. Keeps the sums of the
/// heat that flows in through the boundaries, and into nodes whose temperature is prescribed.
template <int Dim>
void Conduction<Dim>::compute_inflow(double time) {
  const bool limits = trial_.limits != Limits::none;
  limits ? zones_.update_apart(trial_.temperature) : zones_.update(trial_.temperature);
  if (gaps_) gaps_->update(trial_.temperature);
  boundary_.inflow(time, trial_.temperature, boundary_heat_, trial_.inflows);
  if (limits) limit_flows(time);
  prescriptions_.keep_sum(trial_.inflows, [&](int node) { return inflow(node); });
}

/// Lets heat from cold to hot flow only as far as it takes no node, in one stable step, beyond its neighbours
/// and beyond the temperatures that act on it from outside.
template <int Dim>
void Conduction<Dim>::limit_flows(double time) {
  const auto own = node_chunks_.own();
  std::fill(reach_.begin(), reach_.end(), nothing());
  boundary_.add_reach(time, reach_);
  const auto share = [](double room, double heat) { return heat <= room ? 1.0 : std::max(room, 0.0) / heat; };
  team_->share(nodes_.count(), fewest_for_threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (int node = static_cast<int>(begin); node < end; ++node) {
      shares_[node] = {1.0, 1.0};
      if (!own.contain(node)) continue;
      const auto uphill = zones_.uphill(node);
      if (prescriptions_.hold(node) || (uphill.in == 0.0 && uphill.out == 0.0)) continue;
      const double temperature = trial_.temperature[node];
      Interval range = reach_[node];
      include(range, temperature);
      include(range, zones_.around(node, trial_.temperature));
      if (gaps_) gaps_->add_around(node, trial_.temperature, range);
      const double step = trial_.limit;
      const double heat = state_.enthalpy[node] + trial_.increment[node] + step * inflow(node);
      const auto [coldest, hottest] = grid_.range();
      if (std::isfinite(range.upper))
        shares_[node].in =
            share(store_.enthalpy(node, std::min(range.upper, hottest)) - heat, step * uphill.in);
      if (std::isfinite(range.lower))
        shares_[node].out =
            share(heat - store_.enthalpy(node, std::max(range.lower, coldest)), step * uphill.out);
    }
  });
  const auto capacity = [&](int node) { return store_.least_capacity(node, trial_.temperature[node]); };
  halo_.spread(shares_);
  trial_.left_out = std::max(trial_.left_out, zones_.add_uphill(shares_, capacity));
}

/// Tells whether the trial took an own node beyond its neighbours, or beyond the bounds, farther than it may
/// come.
template <int Dim>
bool Conduction<Dim>::oversteps() {
  std::fill(reach_.begin(), reach_.end(), nothing());
  for (const double t : {time(), time() + trial_.step}) boundary_.add_reach(t, reach_);
  std::atomic<bool> found{false};
  const auto own = node_chunks_.own();
  team_->share(own.last - own.first, fewest_for_threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (int node = own.first + static_cast<int>(begin); node < own.first + end && !found; ++node) {
      if (prescriptions_.hold(node)) continue;
      const double heat = state_.enthalpy[node];
      const double before = state_.temperature[node] + excess(node, state_.temperature[node], heat);
      const double now =
          trial_.temperature[node] + excess(node, trial_.temperature[node], heat + trial_.increment[node]);
      if (now < state_.bounds.lower - kAllowedBeyond || now > state_.bounds.upper + kAllowedBeyond)
        found = true;
      if (std::abs(now - before) <= kAllowedBeyond) continue;
      Interval range = reach_[node];
      include(range, before);
      include(range, zones_.around(node, trial_.temperature));
      if (gaps_) gaps_->add_around(node, trial_.temperature, range);
      if (now < range.lower - kAllowedBeyond || now > range.upper + kAllowedBeyond) found = true;
    }
  });
  return found;
}

/// Returns how far beyond the range a node at one of its ends would be, K, see NodeEnthalpy; 0 for other
/// nodes.
template <int Dim>
double Conduction<Dim>::excess(int node, double temperature, double enthalpy) const {
  const bool held = temperature == grid_.range().lower || temperature == grid_.range().upper;
  return held ? store_.excess(node, enthalpy) : 0.0;
}

template <int Dim>
void Conduction<Dim>::update_nodes(const TimeStage& stage) {
  const bool first = stage.begin == 0.0;
  std::atomic<double> largest_change{trial_.change}, most_below{0.0}, most_above{0.0};
  const auto own = node_chunks_.own();
  team_->share(own.last - own.first, fewest_for_threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    double change = 0.0, below = 0.0, above = 0.0;
    for (int node = own.first + static_cast<int>(begin); node < own.first + end; ++node) {
      const double start = state_.temperature[node], enthalpy = state_.enthalpy[node];
      double& temperature = trial_.temperature[node];
      double increment;
      if (prescriptions_.hold(node)) {
        temperature = prescriptions_.temperature(node);
        increment = store_.enthalpy(node, temperature) - enthalpy;
      } else {
        const double rate = inflow(node);
        if (first) trial_.first_rate[node] = rate;
        increment = stage.previous * trial_.increment[node] + stage.before * trial_.before[node] +
                    trial_.step * (stage.rate * rate + stage.first_rate * trial_.first_rate[node]);
        temperature = store_.temperature(node, enthalpy + increment, temperature);
      }
      trial_.before[node] = trial_.increment[node];
      trial_.increment[node] = increment;
      const double beyond = excess(node, temperature, enthalpy + increment);
      const double start_beyond = excess(node, start, enthalpy);
      change = std::max(change, std::abs(temperature + beyond - start - start_beyond));
      below = std::max(below, -beyond);
      above = std::max(above, beyond);
    }
    raise(largest_change, change);
    raise(most_below, below);
    raise(most_above, above);
  });
  trial_.change = largest_change;
  trial_.below = most_below;
  trial_.above = most_above;
  halo_.spread(trial_.temperature);
}

template <int Dim>
void Conduction<Dim>::accept_trial(const Found& found) {
  trial_.heat.prescribed += found.prescribed;
  for (int node = 0; node < nodes_.count(); ++node) state_.enthalpy[node] += trial_.increment[node];
  state_.largest_change = found.largest_change;
  change_since_begin_ = found.since_begin;
  std::swap(state_.temperature, trial_.temperature);
  state_.rate = std::sqrt(found.squares / total_volume_);
  state_.largest_overshoot = std::max({state_.largest_overshoot, trial_.below, trial_.above});
  state_.ledger.boundary.add(1.0, trial_.heat.boundary);
  state_.ledger.prescribed += trial_.heat.prescribed;
  state_.time += trial_.step;
  ++state_.steps;
  state_.retries += trial_.retries;
  state_.stages += trial_.stages_done;
  if (trial_.limits != Limits::none) ++state_.limited_steps;
  state_.limits = trial_.left_out * trial_.step > kLimitsMatter * kAllowedBeyond;
  adapt_step();
  trial_.under_way = false;
  before_run_.holds = false;
}

/// Returns the largest change of an own temperature over the trial, with the jumps of prescribed ones at its
/// beginning.
template <int Dim>
double Conduction<Dim>::trial_change() const {
  double largest = 0.0;
  for (auto [node, last] = node_chunks_.own(); node < last; ++node)
    if (!prescriptions_.hold(node))
      largest = std::max(largest, std::abs(trial_.temperature[node] - state_.temperature[node]));
  const auto& held = prescriptions_.nodes();
  for (std::size_t i = 0; i < held.size(); ++i) {
    const int node = held[i];
    const double start = before_run_.holds ? before_run_.temperature[i] : state_.temperature[node];
    largest = std::max(largest, std::abs(trial_.temperature[node] - start));
  }
  return largest;
}

/// Chooses the next step so that the largest change stays a little below what is allowed.
template <int Dim>
void Conduction<Dim>::adapt_step() {
  const double step = trial_.step;
  constexpr double aim = 0.8, fastest_growth = 2.0;
  const double growth = aim * parameters_.largest_change / trial_.change;  // infinite when nothing changes
  const double wanted = std::clamp(step * std::min(growth, fastest_growth), safe_step_,
                                   std::max(safe_step_, parameters_.largest_step));
  // A step cut short by the end of a run says nothing against the longer one that was meant.
  const bool cut_short = step < state_.next_step && growth > 1.0;
  state_.next_step =
      std::min(cut_short ? std::max(state_.next_step, wanted) : wanted, parameters_.largest_step);
}

/// Gives prescribed nodes their temperatures. Returns the sum of the heat that the jump to them needs.
template <int Dim>
KeptSums Conduction<Dim>::hold_prescribed() {
  const auto needed = [&](int node) { return store_.enthalpy(node, prescriptions_.temperature(node)); };
  KeptSums heat;
  prescriptions_.keep_sum(heat, [&](int node) { return needed(node) - state_.enthalpy[node]; });
  for (int node : prescriptions_.nodes()) {
    state_.temperature[node] = prescriptions_.temperature(node);
    state_.enthalpy[node] = needed(node);
  }
  return heat;
}

template <int Dim>
void Conduction<Dim>::undo_begin(HeatState& state) const {
  if (!before_run_.holds) return;
  state.next_step = before_run_.next_step;
  state.ledger.prescribed = before_run_.prescribed;
  state.bounds = before_run_.bounds;
  const auto& held = prescriptions_.nodes();
  for (std::size_t i = 0; i < held.size(); ++i) {
    state.temperature[held[i]] = before_run_.temperature[i];
    state.enthalpy[held[i]] = before_run_.enthalpy[i];
  }
}

// ---- Limits ----------------------------------------------------------------------------------------------

/// Returns the least and the greatest temperature, on which the limit depends where heat crosses gaps.
template <int Dim>
Interval Conduction<Dim>::extremes() const {
  Interval here = nothing();
  if (!gaps_) return here;
  for (const double t : state_.temperature) include(here, t);
  return model_.ranks().together([&] {
    return Interval{model_.ranks().least(here.lower), model_.ranks().largest(here.upper)};
  });
}

/// Returns the limit of a step by own nodes, while no temperature changes by more than the largest change.
/// \param weight_of_boundary  factor of the boundaries: 1 for a step that is stable, 2 for one in which no
///                            node passes its neighbours; the rows of zones hold twice the flow from hot to
///                            cold anyhow
template <int Dim>
HeatStepLimit Conduction<Dim>::own_limit(double step, double weight_of_boundary,
                                         const Interval& extremes) const {
  auto rows = zones_.row_bound(state_.temperature);
  const auto changed = [&](double t) {
    return std::min(t + parameters_.largest_change, grid_.range().upper);
  };
  auto hottest = state_.temperature;
  for (double& t : hottest) t = changed(t);
  boundary_.add_slope(time(), time() + step, hottest, weight_of_boundary, rows);
  if (gaps_)
    gaps_->add_row_bound(
        {std::max(extremes.lower - parameters_.largest_change, grid_.range().lower), changed(extremes.upper)},
        hottest, rows);
  return strictest(rows, parameters_.safety, node_chunks_,
                   [&](int node) { return store_.least_capacity(node, state_.temperature[node]); });
}

/// Returns the limit of a step by own nodes that is valid whatever the temperatures.
template <int Dim>
HeatStepLimit Conduction<Dim>::own_range_limit(double end) const {
  auto rows = zones_.row_bound();
  const std::vector<double> hottest(rows.size(), grid_.range().upper);
  boundary_.add_slope(time(), end, hottest, 1.0, rows);
  if (gaps_) gaps_->add_row_bound(grid_.range(), hottest, rows);
  return strictest(rows, parameters_.safety, node_chunks_,
                   [&](int node) { return store_.least_capacity(node); });
}

/// Returns the limit of a step, see own_limit.
template <int Dim>
HeatStepLimit Conduction<Dim>::present_limit(double step, double weight_of_boundary) const {
  HeatStepLimit limit = own_limit(step, weight_of_boundary, extremes());
  const double own = limit.step;
  limit.step = model_.ranks().least(own);
  if (limit.step < own) limit.node = -1;
  return limit;
}

template <int Dim>
HeatStepLimit Conduction<Dim>::step_limit() const {
  return present_limit(0.0);
}

template <int Dim>
void Conduction<Dim>::refuse_excess() {
  const auto beyond = [&](int node) {
    return std::abs(store_.excess(node, state_.enthalpy[node] + trial_.increment[node]));
  };
  const auto [first, last] = node_chunks_.own();
  int node = first;
  for (int other = first; other < last; ++other)
    if (beyond(other) > beyond(node)) node = other;
  drop_trial();
  const Vec<Dim>& x = model_.position[nodes_.gridpoint[node]];
  throw Error(fmt::format("the temperature at ({:g}) m leaves the run's range of {} to {} degC at {:g} s",
                          fmt::join(x.c, ", "), grid_.range().lower, grid_.range().upper, time()));
}

// ---- Looking ---------------------------------------------------------------------------------------------

template <int Dim>
std::vector<double> Conduction<Dim>::gridpoint_temperatures(double elsewhere) const {
  std::vector<double> result;
  for (int node : nodes_.of_gridpoint) result.push_back(node < 0 ? elsewhere : state_.temperature[node]);
  return result;
}

template <int Dim>
HeatState Conduction<Dim>::state() const {
  HeatState state = state_;
  if (trial_.under_way) undo_begin(state);
  return state;
}

template <int Dim>
void Conduction<Dim>::visit_state(StateVisitor& visitor) {
  HeatState s = state();
  const StateVisitor::Scope scope(visitor, "heat");
  if (gaps_) gaps_->visit_state(visitor);
  visitor.visit_numbers("temperature_range", s.temperature_range, kTemperatures);
  visitor.require(s.temperature_range.lower <= s.temperature_range.upper, "temperature_range",
                  "ends before it begins");
  visitor.visit("time", s.time, state::at_least(0));
  visitor.visit("next_step", s.next_step, state::within(0, parameters_.largest_step));
  visitor.visit("rate", s.rate, state::number());
  visitor.visit("largest_change", s.largest_change, state::number());
  visitor.visit("largest_overshoot", s.largest_overshoot, state::number());
  visitor.visit_numbers("bounds", s.bounds, state::number());
  visitor.visit("limits", s.limits);
  visitor.visit("limited_steps", s.limited_steps, state::count());
  visitor.visit("steps", s.steps, state::count());
  visitor.visit("retries", s.retries, state::count());
  visitor.visit("stages", s.stages, state::count());
  visitor.visit_numbers("boundary", s.ledger.boundary);
  visitor.visit("prescribed", s.ledger.prescribed);
  if (parameters_.loses_blocks) visitor.visit("removed", s.ledger.removed);
  visitor.visit("stored_at_start", s.stored_at_start);
  if (visitor.replaces()) {
    widen_temperature_range(s.temperature_range);
    if (gaps_) set_nodes(join_through_contacts(model_, conducts_, gaps_->parts()));
    for (auto* of_nodes : {&s.temperature, &s.enthalpy})
      of_nodes->resize(static_cast<std::size_t>(nodes_.count()));
  }
  visit_nodes(visitor, "temperature", s.temperature, kTemperatures);
  visit_nodes(visitor, "enthalpy", s.enthalpy, state::finite());
  if (!visitor.replaces()) return;
  halo_.spread(s.temperature);
  halo_.spoil(s.enthalpy);
  state_ = std::move(s);
  trial_.under_way = false;
  before_run_.holds = false;
  for (auto* of_a_step : {&trial_.increment, &trial_.before, &trial_.first_rate})
    std::fill(of_a_step->begin(), of_a_step->end(), std::numeric_limits<double>::quiet_NaN());
}

template <int Dim>
void Conduction<Dim>::visit_nodes(StateVisitor& visitor, std::string_view name, std::vector<double>& of_nodes,
                                  const StateRule& rule) const {
  visitor.visit_by_chunk(name, of_nodes, node_chunks_, rule);
}

template <int Dim>
HeatLedger Conduction<Dim>::ledger() const {
  HeatLedger ledger = state_.ledger;
  ledger.stored = total_enthalpy() - state_.stored_at_start;
  ledger.loses_blocks = parameters_.loses_blocks;
  return ledger;
}

template <int Dim>
double Conduction<Dim>::total_enthalpy() const {
  return chunked_sum(node_chunks_, [&](int node) { return state_.enthalpy[node]; });
}

template class Conduction<2>;
template class Conduction<3>;

}  // namespace pyroclast
