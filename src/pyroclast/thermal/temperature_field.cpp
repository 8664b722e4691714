#include "pyroclast/thermal/temperature_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/model/item_halo.hpp"

namespace pyroclast {

namespace {

/// Fraction of a change that counts as the whole: rates that fall would else divide the rest for ever.
constexpr double kReached = 0.95;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<std::array<int, 2>> contact_gridpoints(const Model& model) {
  std::vector<bool> in_specimen(model.gridpoint_count());
  for (int b = 0; b < model.block_count(); ++b)
    if (!model.is_of_bearing(b))
      std::fill(in_specimen.begin() + model.block_gridpoints[b],
                in_specimen.begin() + model.block_gridpoints[b + 1], true);
  std::vector<std::array<int, 2>> pairs;
  for (int i = 0; i < model.contact_count(); ++i) {
    const Joint& c = model.joint(i);
    pairs.push_back({in_specimen[c.a] ? c.a : c.b, in_specimen[c.b] ? c.b : c.a});
  }
  return pairs;
}

double mean_of_zone(const Model& model, int zone, const std::vector<double>& gridpoints) {
  const auto corners = model.gridpoints_of_zone(zone);
  double sum = 0.0;
  for (const int g : corners) sum += gridpoints[g];
  return sum / static_cast<double>(corners.size());
}

TemperatureField::TemperatureField(const Model& model)
    : model_(model),
      gridpoints_(model_.gridpoint_count(), kReferenceTemperature),
      zones_(model_.zone_count()),
      contacts_(model_.contact_count()) {
  specimen_volume_ = model_.zone_volumes();
  for (int b = 0; b < model_.block_count(); ++b) {
    if (model_.is_of_bearing(b)) {
      std::fill(specimen_volume_.begin() + model_.block_zones[b],
                specimen_volume_.begin() + model_.block_zones[b + 1], 0.0);
      continue;
    }
    for (int g = model_.block_gridpoints[b]; g < model_.block_gridpoints[b + 1]; ++g)
      specimen_gridpoints_.push_back(g);
  }
  zone_chunks_ = model_.zone_chunks();
  volume_ = chunked_sum(zone_chunks_, [&](int z) { return specimen_volume_[z]; });
  contact_gridpoints_ = contact_gridpoints(model_);
}

TemperatureField::TemperatureField(const Model& model, double temperature) : TemperatureField(model) {
  set_uniform(temperature);
}

TemperatureField::TemperatureField(const Model& model, std::unique_ptr<HeatSolver> conduction)
    : TemperatureField(model) {
  conduction_ = std::move(conduction);
  read_conduction();
}

void TemperatureField::set_uniform(double temperature) {
  if (!is_uniform()) throw Error("the temperature of a field that conduction computes cannot be set");
  for (int g : specimen_gridpoints_) gridpoints_[g] = temperature;
  follow_gridpoints();
  mean_ = minimum_ = maximum_ = temperature;
}

void TemperatureField::begin_exposure(const Interval& temperatures) {
  if (is_uniform()) throw Error("a uniform temperature does not conduct heat; it is set");
  conduction_->widen_temperature_range(temperatures);
}

void TemperatureField::set_gaps(std::vector<ContactGap> gaps) {
  if (is_uniform()) throw Error("a uniform temperature does not conduct heat; it meets no gaps");
  if (advance_.under_way) throw Error("gaps cannot change while the temperatures advance");
  conduction_->set_gaps(std::move(gaps));
  read_conduction();
}

void TemperatureField::remove(const std::vector<int>& blocks) {
  if (advance_.under_way) throw Error("blocks cannot leave while the temperatures advance");
  gone_.resize(static_cast<std::size_t>(model_.block_count()));
  for (const int block : blocks) {
    gone_[block] = true;
    std::fill(specimen_volume_.begin() + model_.block_zones[block],
              specimen_volume_.begin() + model_.block_zones[block + 1], 0.0);
    std::erase_if(specimen_gridpoints_, [&](int g) {
      return model_.block_gridpoints[block] <= g && g < model_.block_gridpoints[block + 1];
    });
  }
  volume_ = chunked_sum(zone_chunks_, [&](int z) { return specimen_volume_[z]; });
  if (is_uniform()) return update();
  conduction_->remove(blocks);
  read_conduction();
}

double TemperatureField::advance(double largest_change, double until, double steady_rate) {
  begin_advance(largest_change, until, steady_rate);
  while (!advance(std::numeric_limits<std::int64_t>::max())) {
  }
  return time();
}

void TemperatureField::begin_advance(double largest_change, double until, double steady_rate) {
  if (is_uniform()) throw Error("a uniform temperature does not conduct heat; it is set");
  if (!(largest_change > 0.0))
    throw Error(fmt::format("the change of temperature to advance by is {} K, but it must be greater than 0",
                            largest_change));
  end_advance();
  if (!(until >= time()))
    throw Error(fmt::format("the time to advance to is {} s, but it is {} s already", until, time()));
  advance_ = {true, largest_change, until, steady_rate, 0.0, conduction_->temperature()};
}

bool TemperatureField::advance(std::int64_t stages) {
  if (!advance_.under_way) throw Error("no advance of the temperatures was begun");
  if (stages < 1)
    throw Error(fmt::format("the solver may take {} stages, but it must be allowed 1 or more", stages));
  const auto& [under_way, largest_change, until, steady_rate, change, begin] = advance_;
  while (conduction_->time() < until && change < kReached * largest_change) {
    const double now = conduction_->time();
    const double foreseen = fastest_ > 0.0 ? now + (largest_change - change) / fastest_ : until;
    if (!conduction_->advance_step(foreseen > now ? std::min(foreseen, until) : until, stages, &begin))
      return false;
    fastest_ = conduction_->largest_change() / (conduction_->time() - now);
    advance_.change = conduction_->change_since_begin();
    if (conduction_->rate() < steady_rate) break;
    if (stages == 0) return false;
  }
  end_advance();
  return true;
}

void TemperatureField::end_advance() {
  if (!advance_.under_way) return;
  advance_.under_way = false;
  conduction_->drop_trial();
  read_conduction();
}

void TemperatureField::read_conduction() {
  gridpoints_ = conduction_->gridpoint_temperatures(kReferenceTemperature);
  time_ = conduction_->time();
  update();
}

void TemperatureField::visit_state(StateVisitor& visitor) {
  if (is_uniform()) {
    double temperature = mean_;
    visitor.visit("temperature", temperature, kTemperatures);
    if (visitor.replaces()) set_uniform(temperature);
    return;
  }
  conduction_->visit_state(visitor);
  // an advance under way leaves the gridpoints where it began
  for_gone_gridpoints([&](int g) { gridpoints_[g] = kReferenceTemperature; });
  visitor.visit_by_chunk("gridpoints", gridpoints_, model_.gridpoint_chunks(), kTemperatures);
  for_gone_gridpoints([&](int g) { gridpoints_[g] = std::numeric_limits<double>::quiet_NaN(); });
  if (visitor.replaces()) gridpoint_halo(model_).spread(gridpoints_);
  visitor.visit("time", time_, state::at_least(0));
  visitor.visit("fastest", fastest_, state::number());
  const StateVisitor::Scope scope(visitor, "advance");
  visitor.visit("under_way", advance_.under_way);
  visitor.visit("largest_change", advance_.largest_change, state::number());
  visitor.visit("until", advance_.until);
  visitor.visit("steady_rate", advance_.steady_rate);
  visitor.visit("change", advance_.change);
  if (advance_.under_way) {
    if (visitor.replaces()) advance_.begin = conduction_->temperature();
    conduction_->visit_nodes(visitor, "begin", advance_.begin, kTemperatures);
  }
  if (visitor.replaces()) update();
}

/// Calls `f(gridpoint)` for those of blocks that have left.
template <class F>
void TemperatureField::for_gone_gridpoints(F f) const {
  for (int b = 0; b < std::ssize(gone_); ++b)
    if (gone_[b])
      for (int g = model_.block_gridpoints[b]; g < model_.block_gridpoints[b + 1]; ++g) f(g);
}

/// Takes zones and contacts to the temperatures of their gridpoints.
void TemperatureField::follow_gridpoints() {
  for_gone_gridpoints([&](int g) { gridpoints_[g] = kReferenceTemperature; });
  for (std::size_t z = 0; z < zones_.size(); ++z) {
    zones_[z] = mean_of_zone(model_, static_cast<int>(z), gridpoints_);
  }
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const auto [a, b] = contact_gridpoints_[c];
    contacts_[c] = 0.5 * (gridpoints_[a] + gridpoints_[b]);
  }
  for_gone_gridpoints([&](int g) { gridpoints_[g] = std::numeric_limits<double>::quiet_NaN(); });
}

/// Computes all that follows from the temperatures of the gridpoints: a collective.
void TemperatureField::update() {
  follow_gridpoints();
  Interval here{kInfinity, -kInfinity};
  for (int g : specimen_gridpoints_) include(here, gridpoints_[g]);
  const auto read = [&] {
    const double sum = chunked_sum(zone_chunks_, [&](int z) { return specimen_volume_[z] * zones_[z]; });
    return std::array{sum / volume_, model_.ranks().least(here.lower), model_.ranks().largest(here.upper)};
  };
  const auto [mean, least, greatest] = model_.ranks().together(read);
  mean_ = mean;
  minimum_ = least;
  maximum_ = greatest;
  if (is_uniform()) mean_ = minimum_;  // without the rounding of a mean
}

}  // namespace pyroclast
