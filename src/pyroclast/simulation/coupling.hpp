#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/mechanics/body.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/thermal/temperature_field.hpp"

namespace pyroclast {

/// Highest temperatures of each zone and contact so far, °C. Three effects depend on them: a zone creeps when
/// it is heated for the first time, properties lost by heat do not come back on cooling, and free strain may
/// have another slope on cooling.
class HottestTemperatures {
 public:
  HottestTemperatures() = default;
  /// Begins as if the body had come without stress to the field's present temperatures, from the temperature
  /// without stress where the materials state one.
  /// \param model        kept by reference; must outlive this object
  /// \param stress_free  temperature without stress of each gridpoint where it is a field, °C
  HottestTemperatures(const Model& model, const ConcreteMaterials& materials, const TemperatureField& field,
                      const std::vector<double>& stress_free = {});

  /// Notes that the field came to its temperatures, which an exchange will hand over later.
  void note_field(const TemperatureField& field);
  /// Notes that an exchange handed over the field's temperatures.
  void note_exchange(const TemperatureField& field);
  // The next two return the highest temperature at an exchange to the temperature `now`, °C; `now` itself
  // where nothing asks.
  double of_zone(int zone, double now) const {
    return zones_.empty() ? now : std::max(now, seen_zones_[zone]);
  }
  double of_contact(int contact, double now) const {
    return contacts_.empty() ? now : std::max(now, seen_contacts_[contact]);
  }
  /// Returns the highest temperature at the exchanges so far alone, from which a zone goes on creeping.
  double of_zone_at_exchanges(int zone, double now) const {
    return zones_.empty() ? now : std::max(now, zones_[zone]);
  }
  /// Returns the temperature without stress of each zone, °C, where it is a field; else none.
  const std::vector<double>& stress_free_zones() const { return stress_free_zones_; }
  /// Returns the highest temperature of the whole specimen, for a uniform field.
  double of_body(double now) const { return zones_.empty() ? now : std::max(now, body_); }

  void visit_state(StateVisitor& visitor);

 private:
  /// Raises the temperatures to those of the gridpoints, without bearings, and returns the mean of each zone.
  std::vector<double> begin_at(const Model& model, const std::vector<double>& gridpoints);

  const Model* model_ = nullptr;
  bool keeps_zones_ = false, keeps_contacts_ = false;
  std::vector<double> zones_, contacts_;            ///< highest at exchanges
  std::vector<double> seen_zones_, seen_contacts_;  ///< highest at exchanges and since the last one
  double body_ = 0.0;
  std::vector<double> stress_free_zones_;
};

/// Pressures of pore water as the body bears them.
struct PorePressures {
  std::vector<double> of_blocks;    ///< times Biot's coefficient, Pa, of each block
  std::vector<double> of_contacts;  ///< times that of the contact, Pa, of each; empty: on none
  std::vector<double> at_openings;  ///< of contacts, m; see BodyProperties::pore_opening
  double reserve = 0.0;             ///< m
};

/// Returns the parameters of every zone and contact at the field's temperatures, and the creep of zones on
/// their way there. Throws Error when a property is not defined at one of the temperatures.
/// \param before  highest temperatures at the exchanges so far
/// \param water   pressures of pore water, which widen zones as free strain does and part contacts
/// \param memory  properties whose memory is used again
BodyProperties properties_at(const Model& model, const ConcreteMaterials& materials,
                             const TemperatureField& field, const HottestTemperatures& before,
                             const std::optional<PorePressures>& water = std::nullopt,
                             BodyProperties memory = {});

}  // namespace pyroclast
