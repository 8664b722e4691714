#include "pyroclast/thermal/temperature_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/model/concrete_model.hpp"

namespace pyroclast {

namespace {

/// Fraction of a change that counts as the whole: rates that fall would else divide the rest for ever.
constexpr double kReached = 0.95;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

}  // namespace

TemperatureField::TemperatureField(const Model<2>& model)
    : model_(model),
      gridpoints_(model_.position.size(), kReferenceTemperature),
      zones_(model_.zones.size()),
      contacts_(model_.contacts.size()) {
  specimen_volume_ = zone_geometry(model_).volume;
  std::vector<bool> in_specimen(model_.position.size());
  for (int b = 0; b < model_.block_count(); ++b) {
    if (model_.block_material[b] == platen_material) {
      std::fill(specimen_volume_.begin() + model_.block_zones[b],
                specimen_volume_.begin() + model_.block_zones[b + 1], 0.0);
      continue;
    }
    for (int g = model_.block_gridpoints[b]; g < model_.block_gridpoints[b + 1]; ++g) {
      in_specimen[g] = true;
      specimen_gridpoints_.push_back(g);
    }
  }
  for (const auto& c : model_.contacts) contact_gridpoint_.push_back(in_specimen[c.a] ? c.a : c.b);
}

TemperatureField::TemperatureField(const Model<2>& model, double temperature) : TemperatureField(model) {
  set_uniform(temperature);
}

TemperatureField::TemperatureField(const Model<2>& model, std::unique_ptr<Conduction<2>> conduction)
    : TemperatureField(model) {
  conduction_ = std::move(conduction);
  gridpoints_ = conduction_->gridpoint_temperatures(kReferenceTemperature);
  update();
}

void TemperatureField::set_uniform(double temperature) {
  if (!is_uniform()) throw Error("the temperature of a field that conduction computes cannot be set");
  for (int g : specimen_gridpoints_) gridpoints_[g] = temperature;
  update();
}

double TemperatureField::advance(double largest_change, double until, double steady_rate) {
  if (is_uniform()) throw Error("a uniform temperature does not conduct heat; it is set");
  if (!(largest_change > 0.0))
    throw Error(fmt::format("the change of temperature to advance by is {} K, but it must be greater than 0",
                            largest_change));
  if (!(until >= time()))
    throw Error(fmt::format("the time to advance to is {} s, but it is {} s already", until, time()));
  const std::vector<double> begin = conduction_->temperature();
  double change = 0.0;
  while (time() < until && change < kReached * largest_change) {
    const double foreseen = fastest_ > 0.0 ? time() + (largest_change - change) / fastest_ : until;
    step_towards(std::min(foreseen, until));
    change = largest_difference(begin, conduction_->temperature());
    if (conduction_->rate() < steady_rate) break;
  }
  gridpoints_ = conduction_->gridpoint_temperatures(kReferenceTemperature);
  update();
  return time();
}

/// One step of the solver.
void TemperatureField::step_towards(double end) {
  const std::vector<double> before = conduction_->temperature();
  const double start = time();
  conduction_->advance_to_steady(kInfinity, end);  // any rate is below infinity: over after one step
  fastest_ = largest_difference(before, conduction_->temperature()) / (time() - start);
}

/// What follows from the gridpoints.
void TemperatureField::update() {
  double volume = 0.0, content = 0.0;
  for (std::size_t z = 0; z < zones_.size(); ++z) {
    const auto& [a, b, c] = model_.zones[z];
    zones_[z] = (gridpoints_[a] + gridpoints_[b] + gridpoints_[c]) / 3.0;
    volume += specimen_volume_[z];
    content += specimen_volume_[z] * zones_[z];
  }
  mean_ = content / volume;
  for (std::size_t c = 0; c < contacts_.size(); ++c) contacts_[c] = gridpoints_[contact_gridpoint_[c]];
  minimum_ = kInfinity;
  maximum_ = -kInfinity;
  for (int g : specimen_gridpoints_) {
    minimum_ = std::min(minimum_, gridpoints_[g]);
    maximum_ = std::max(maximum_, gridpoints_[g]);
  }
  if (is_uniform()) mean_ = minimum_;  // without the rounding of a mean
}

}  // namespace pyroclast
