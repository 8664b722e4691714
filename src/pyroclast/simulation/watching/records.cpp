#include "pyroclast/simulation/watching/records.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/model/sets.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

namespace {

/// Tells whether a record is a mean over the blocks of its set that have not left the body; any other one is
/// lost with the first block.
bool is_of_what_is_left(RecordKind kind) {
  return kind == RecordKind::stress || kind == RecordKind::temperature;
}

bool is_of_cracks(RecordKind kind) {
  return kind == RecordKind::crack_length || kind == RecordKind::crack_area ||
         kind == RecordKind::crack_opening;
}

/// Returns the zones that lie wholly in a set.
std::vector<int> zones_in(const Model& model, const std::vector<int>& gridpoints) {
  std::vector<bool> is_in(model.gridpoint_count());
  for (int g : gridpoints) is_in[g] = true;
  std::vector<int> zones;
  for (int z = 0; z < model.zone_count(); ++z)
    if (std::ranges::all_of(model.gridpoints_of_zone(z), [&](int g) { return is_in[g]; })) zones.push_back(z);
  return zones;
}

}  // namespace

const Unit& unit_of(RecordKind kind) {
  switch (kind) {
    case RecordKind::force:
      return unit::force;
    case RecordKind::stress:
      return unit::stress;
    case RecordKind::temperature:
      return unit::temperature;
    case RecordKind::crack_area:
      return unit::area;
    default:
      return unit::length;
  }
}

const Unit& rate_unit_of(RecordKind kind) {
  switch (kind) {
    case RecordKind::force:
      return unit::force_rate;
    case RecordKind::stress:
      return unit::stress_rate;
    case RecordKind::temperature:
      return unit::heating_rate;
    case RecordKind::crack_area:
      return unit::area_rate;
    default:
      return unit::velocity;
  }
}

Column column_of(const RecordParameters& record) {
  const std::string unit = record.kind == RecordKind::stress ? "MPa" : unit_of(record.kind).si;
  return {fmt::format("{}_{}", record.name, unit), unit, kMeaningOfRecord, ColumnRole::record, record.name};
}

double column_over_si(RecordKind kind) {
  return kind == RecordKind::stress ? 1e-6 : 1.0;
}

Record::Record(const Model& model, bool moves, RecordParameters parameters)
    : parameters_(std::move(parameters)) {
  const auto fail = [&](const std::string& why) {
    throw Error(fmt::format("{}: record \"{}\" {}", parameters_.place, parameters_.name, why));
  };
  const auto find = [&](const auto& sets, const std::string& name) -> const std::vector<int>& {
    const auto found = sets.find(name);
    if (found == sets.end() || !model.ranks().any(!found->second.empty()))
      fail(fmt::format("is of the set \"{}\", but there is no such set of {}; there are {}", name,
                       is_of_cracks(parameters_.kind) ? "contacts" : "gridpoints", names_of(sets)));
    return found->second;
  };
  if (!moves && parameters_.kind != RecordKind::temperature)
    fail(
        "is of motion, but no stage moves the body: without one only records of kind temperature have an "
        "effect");
  if (parameters_.kind == RecordKind::crack_length && model.dimension() != 2)
    fail("is of a length, but cracks of a solid have an area");
  if (parameters_.kind == RecordKind::crack_area && model.dimension() != 3)
    fail("is of an area, but cracks in the plane have a length");
  if (is_of_cracks(parameters_.kind)) {
    auto contacts = contacts_by_chunk(contacts_by_chunk(model), find(model.contact_sets, parameters_.set));
    items_ = std::move(contacts.contacts);
    chunks_ = std::move(contacts.chunks);
    for (int c : items_) size_.push_back(model.extent(c));
  } else {
    const auto chunked = [&](const std::string& name) {
      return gridpoint_set(model, find(model.sets, name));
    };
    mean_ = mean_over(model, chunked(parameters_.set));
    if (parameters_.kind == RecordKind::opening)
      mean_of_other_ = mean_over(model, chunked(parameters_.other));
    if (parameters_.kind == RecordKind::stress) {
      items_ = zones_in(model, mean_.set.gridpoints);
      if (!model.ranks().any(!items_.empty()))
        fail(fmt::format("is of the set \"{}\", which holds no zone", parameters_.set));
      const auto volume = model.zone_volumes();
      for (int z : items_) size_.push_back(volume[z]);
      chunks_ = model.zone_chunks().of_some(items_);
    }
  }
  whole_ = chunked_sum(chunks_, [&](int i) { return size_[i]; });
}

Record::Mean Record::mean_over(const Model& model, GridpointSet set) const {
  Mean mean{std::move(set), {}};
  const auto& gridpoints = mean.set.gridpoints;
  mean.weights.assign(gridpoints.size(), 0.0);
  if (parameters_.over == MeanOver::size) {
    const auto zones = zones_in(model, gridpoints);
    const auto volume = zones.empty() ? std::vector<double>() : model.zone_volumes();
    for (int z : zones)
      for (int g : model.gridpoints_of_zone(z))
        mean.weights[std::ranges::lower_bound(gridpoints, g) - gridpoints.begin()] +=
            volume[z] / (model.dimension() + 1);
    if (!model.ranks().any(!zones.empty()))
      mean.weights = tributary_areas(gridpoints, faces_in(model, gridpoints));
  }
  const double whole = chunked_sum(mean.set.chunks, [&](int i) { return mean.weights[i]; });
  for (double& weight : mean.weights) weight = whole > 0.0 ? weight / whole : 1.0 / mean.set.whole_count;
  return mean;
}

template <class T, class Value>
T Record::Mean::of(Value value) const {
  return chunked_sum<T>(set.chunks, [&](int i, T& sum) { sum += weights[i] * value(set.gridpoints[i]); });
}

double Record::mobility(const Simulation& simulation) const {
  const MotionTotals& totals = simulation.motion().totals();
  return totals.mobility(mean_.set, mean_.weights) +
         totals.mobility(mean_of_other_.set, mean_of_other_.weights);
}

/// Returns the force of the record's set. A set that loads, holds or drives the body has its own load, and of
/// each reaction an even share among the sets that hold the component. Any other set has all forces from
/// outside on its gridpoints.
double Record::force(const Simulation& simulation) const {
  const Motion& motion = simulation.motion();
  const Supports& supports = simulation.supports();
  const Vec<3>& d = parameters_.direction;
  std::array<bool, 3> holds{};
  for (int c = 0; c < motion.model().dimension(); ++c) holds[c] = supports.holds(parameters_.set, c);
  if (std::ranges::count(holds, true) == 0 && !simulation.loads().acts_on(parameters_.set))
    return dot(motion.totals().total_applied_force(mean_.set) - motion.totals().total_force(mean_.set), d);
  const auto reaction = chunked_sum<Vec<3>>(mean_.set.chunks, [&](int i, Vec<3>& sum) {
    const int g = mean_.set.gridpoints[i];
    const Vec<3> force = motion.read().force(g);
    for (int c = 0; c < 3; ++c)
      if (holds[c]) sum[c] -= force[c] / supports.holders(g, c);
  });
  return dot(simulation.loads().total(parameters_.set) + reaction, d);
}

double Record::read(const Simulation& simulation) const {
  if (has_lost(simulation)) return std::numeric_limits<double>::quiet_NaN();
  return measure(simulation) - (counts_from_zero() ? zero_ : 0.0);
}

void Record::require_there(const Simulation& simulation, const std::string& place) const {
  if (has_lost(simulation))
    throw Error(fmt::format("{}: blocks of the record \"{}\" have left the body", place, parameters_.name));
}

bool Record::has_lost(const Simulation& simulation) const {
  if (!simulation.has_lost_blocks()) return false;
  const Model& model = simulation.model();
  const auto is_gone = [&](int g) { return simulation.is_gone(model.block_of(g)); };
  if (is_of_cracks(parameters_.kind))
    return std::ranges::any_of(items_,
                               [&](int c) { return is_gone(model.joint(c).a) || is_gone(model.joint(c).b); });
  if (is_of_what_is_left(parameters_.kind)) return std::ranges::all_of(mean_.set.gridpoints, is_gone);
  return std::ranges::any_of(mean_.set.gridpoints, is_gone) ||
         std::ranges::any_of(mean_of_other_.set.gridpoints, is_gone);
}

double Record::measure(const Simulation& simulation) const {
  if (parameters_.kind == RecordKind::temperature) {
    const std::vector<double>& at = simulation.field().gridpoints();  // NaN where blocks have left
    const double sum = mean_.of<double>([&](int g) { return std::isnan(at[g]) ? 0.0 : at[g]; });
    if (!simulation.has_lost_blocks()) return sum;
    return sum / mean_.of<double>([&](int g) { return std::isnan(at[g]) ? 0.0 : 1.0; });
  }
  const Motion& motion = simulation.motion();
  const auto displacement = [&](int g) { return motion.read().displacement(g); };
  const Vec<3>& d = parameters_.direction;
  switch (parameters_.kind) {
    case RecordKind::displacement:
      return dot(mean_.of<Vec<3>>(displacement), d);
    case RecordKind::opening:
      return dot(mean_of_other_.of<Vec<3>>(displacement) - mean_.of<Vec<3>>(displacement), d);
    case RecordKind::force:
      return force(simulation);
    case RecordKind::stress: {
      const Model& model = motion.model();
      const auto size = [&](int i) {
        const bool is_left = !simulation.has_lost_blocks() ||
                             !simulation.is_gone(model.block_of(model.gridpoints_of_zone(items_[i])[0]));
        return is_left ? size_[i] : 0.0;
      };
      const double sum = chunked_sum(chunks_, [&](int i) {
        const SymmetricTensor<3> s = motion.read().stress(items_[i]);
        const double normal = d[0] * d[0] * s[0] + d[1] * d[1] * s[1] + d[2] * d[2] * s[2] +
                              2.0 * (d[0] * d[1] * s[3] + d[1] * d[2] * s[4] + d[0] * d[2] * s[5]);
        return size(i) * normal;
      });
      return sum / (simulation.has_lost_blocks() ? chunked_sum(chunks_, size) : whole_);
    }
    case RecordKind::crack_length:
    case RecordKind::crack_area:
      return chunked_sum(chunks_,
                         [&](int i) { return motion.read().damage(items_[i]) > 0.0 ? size_[i] : 0.0; });
    case RecordKind::crack_opening:
      return chunked_sum(chunks_, [&](int i) { return size_[i] * motion.read().opening(items_[i]); }) /
             whole_;
    case RecordKind::temperature:
      break;
  }
  return 0.0;
}

}  // namespace pyroclast
