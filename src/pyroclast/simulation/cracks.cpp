#include "pyroclast/simulation/cracks.hpp"

#include <algorithm>

#include "pyroclast/model/concrete_model.hpp"

namespace pyroclast {

Cracks count_cracks(const Mechanics<2>& mechanics) {
  Cracks cracks;
  const auto& model = mechanics.model();
  double cracked_length = 0.0;
  const auto add = [](CrackCount& count, double damage, double length) {
    if (damage <= 0.0) return;
    ++count.damaged;
    if (damage >= 1.0) ++count.broken;
    count.length += length;
  };
  for (int i = 0; i < model.contact_count(); ++i) {
    const auto& contact = model.contacts[i];
    if (contact.interface != aggregate_mortar && contact.interface != mortar_mortar) continue;
    const bool itz = contact.interface == aggregate_mortar;
    const auto h = mechanics.contact_history(i);
    const double length = contact.area / model.thickness;
    add(itz ? cracks.tension_am : cracks.tension_mm, h.tension_damage, length);
    add(itz ? cracks.shear_am : cracks.shear_mm, h.shear_damage, length);
    if (h.tension_damage > 0.0) {
      cracks.mean_opening += std::max(0.0, mechanics.opening(i) + h.closure) * length;
      cracked_length += length;
    }
  }
  if (cracked_length > 0.0) cracks.mean_opening /= cracked_length;
  return cracks;
}

}  // namespace pyroclast
