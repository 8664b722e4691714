#include "pyroclast/simulation/records.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/simulation/cracks.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

namespace {

bool is_of_cracks(RecordKind kind) {
  return kind == RecordKind::crack_length || kind == RecordKind::crack_opening;
}

bool is_damaged(const Mechanics<2>& mechanics, int contact) {
  return std::ranges::any_of(kCrackModes,
                             [&](Remembers mode) { return mechanics.remembered(contact, mode) > 0.0; });
}

/// Zones that lie wholly in a set.
std::vector<int> zones_in(const Model<2>& model, const std::vector<int>& gridpoints) {
  std::vector<bool> is_in(model.position.size());
  for (int g : gridpoints) is_in[g] = true;
  std::vector<int> zones;
  for (int z = 0; z < model.zone_count(); ++z)
    if (std::ranges::all_of(model.zones[z], [&](int g) { return is_in[g]; })) zones.push_back(z);
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
    default:
      return unit::velocity;
  }
}

Column column_of(const RecordParameters& record) {
  const std::string unit = record.kind == RecordKind::stress ? "MPa" : unit_of(record.kind).si;
  return {fmt::format("{}_{}", record.name, unit), unit};
}

double column_over_si(RecordKind kind) {
  return kind == RecordKind::stress ? 1e-6 : 1.0;
}

Record::Record(const Mechanics<2>& mechanics, RecordParameters parameters)
    : parameters_(std::move(parameters)) {
  const Model<2>& model = mechanics.model();
  const auto fail = [&](const std::string& why) {
    throw Error(fmt::format("{}: record \"{}\" {}", parameters_.place, parameters_.name, why));
  };
  const auto find = [&](const auto& sets, const std::string& name) -> const std::vector<int>& {
    const auto found = sets.find(name);
    if (found == sets.end() || found->second.empty())
      fail(fmt::format("is of the set \"{}\", but there is no such set of {}; there are {}", name,
                       is_of_cracks(parameters_.kind) ? "contacts" : "gridpoints", names_of(sets)));
    return found->second;
  };
  if (is_of_cracks(parameters_.kind)) {
    items_ = find(model.contact_sets, parameters_.set);
    std::ranges::sort(items_);
    for (int c : items_) size_.push_back(model.contacts[c].area / model.thickness);
  } else {
    set_ = mechanics.set_of(find(model.sets, parameters_.set));
    if (parameters_.kind == RecordKind::opening)
      other_ = mechanics.set_of(find(model.sets, parameters_.other));
    if (parameters_.kind == RecordKind::stress) {
      items_ = zones_in(model, set_.gridpoints);
      if (items_.empty()) fail(fmt::format("is of the set \"{}\", which holds no zone", parameters_.set));
      const auto volume = zone_geometry(model).volume;
      for (int z : items_) size_.push_back(volume[z]);
    }
  }
  chunks_ = chunk_begins(static_cast<int>(items_.size()), [&](int i) { return items_[i]; });
  whole_ = chunked_sum(chunks_, [&](int i) { return size_[i]; });
}

double Record::read(const Simulation& simulation) const {
  return measure(simulation) - (counts_from_zero() ? zero_ : 0.0);
}

double Record::measure(const Simulation& simulation) const {
  const Mechanics<2>& mechanics = simulation.mechanics();
  const Vec<2>& d = parameters_.direction;
  switch (parameters_.kind) {
    case RecordKind::displacement:
      return dot(mechanics.mean_displacement(set_), d);
    case RecordKind::opening:
      return dot(mechanics.mean_displacement(other_) - mechanics.mean_displacement(set_), d);
    case RecordKind::force:
      return dot(mechanics.total_applied_force(set_) - mechanics.total_force(set_), d);
    case RecordKind::stress:
      return chunked_sum(chunks_,
                         [&](int i) {
                           const SymmetricTensor<2> s = mechanics.stress(items_[i]);
                           const double normal =
                               d[0] * d[0] * s[0] + d[1] * d[1] * s[1] + 2.0 * d[0] * d[1] * s[2];
                           return size_[i] * normal;
                         }) /
             whole_;
    case RecordKind::temperature:
      return chunked_sum(set_.chunks,
                         [&](int i) { return simulation.field().gridpoints()[set_.gridpoints[i]]; }) /
             static_cast<double>(set_.gridpoints.size());
    case RecordKind::crack_length:
      return chunked_sum(chunks_, [&](int i) { return is_damaged(mechanics, items_[i]) ? size_[i] : 0.0; });
    case RecordKind::crack_opening:
      return chunked_sum(chunks_, [&](int i) { return size_[i] * mechanics.opening(items_[i]); }) / whole_;
  }
  return 0.0;
}

}  // namespace pyroclast
