#pragma once

#include <algorithm>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/mechanics/mechanics.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/thermal/temperature_field.hpp"

namespace pyroclast {

/// The hottest that each zone and contact was so far, °C: what creeps does so
/// when it is heated for the first time, what heat took does not come back on cooling, and free strain may
/// have a slope of its own on cooling.
class HottestTemperatures {
 public:
  HottestTemperatures() = default;
  /// As if the body had come without stress to the temperatures that the field has now, from the one without
  /// stress where the materials say one.
  /// \param stress_free  temperature without stress of each gridpoint where they differ, °C
  HottestTemperatures(const Model<2>& model, const ConcreteMaterials& materials,
                      const TemperatureField& field, const std::vector<double>& stress_free = {});

  /// The field came to its temperatures, but hands them over later, with an exchange.
  void see(const TemperatureField& field);
  /// An exchange of the field's temperatures was made.
  void take(const TemperatureField& field);
  // at an exchange to the temperature now, °C; this itself where nothing asks
  double of_zone(int zone, double now) const {
    return zones_.empty() ? now : std::max(now, seen_zones_[zone]);
  }
  double of_contact(int contact, double now) const {
    return contacts_.empty() ? now : std::max(now, seen_contacts_[contact]);
  }
  /// At the exchanges so far alone: from where a zone goes on creeping.
  double of_zone_at_exchanges(int zone, double now) const {
    return zones_.empty() ? now : std::max(now, zones_[zone]);
  }
  /// Of each zone, °C, where the temperature without stress is a field; else none.
  const std::vector<double>& stress_free_zones() const { return stress_free_zones_; }
  /// Of all of the specimen, in a uniform field.
  double of_all(double now) const { return zones_.empty() ? now : std::max(now, of_all_); }

  void visit_state(StateVisitor& visitor);

 private:
  /// Raises all to temperatures of the gridpoints, of which those of bearings do not count. Returns the mean
  /// of each zone.
  std::vector<double> begin_at(const Model<2>& model, const std::vector<double>& gridpoints);

  std::vector<double> zones_, contacts_;            ///< at exchanges
  std::vector<double> seen_zones_, seen_contacts_;  ///< since the last one, too; never less
  double of_all_ = 0.0;
  std::vector<double> stress_free_zones_;
};

/// Parameters of every zone and contact at the field's temperatures, and what zones creep on their way there.
/// Throws Error when a property is not defined at one of them.
/// \param before  of the exchanges so far
BodyProperties properties_at(const Model<2>& model, const ConcreteMaterials& materials,
                             const TemperatureField& field, const HottestTemperatures& before);

}  // namespace pyroclast
