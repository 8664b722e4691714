#include "pyroclast/simulation/cracks.hpp"

#include <algorithm>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/model/concrete_model.hpp"

namespace pyroclast {

namespace {

struct CrackSums {
  CrackCount tension_am, tension_mm, shear_am, shear_mm;
  double opening = 0.0, length = 0.0;  ///< of contacts with tension damage, m², m

  void operator+=(const CrackSums& other) {
    tension_am += other.tension_am;
    tension_mm += other.tension_mm;
    shear_am += other.shear_am;
    shear_mm += other.shear_mm;
    opening += other.opening;
    length += other.length;
  }
};

}  // namespace

void CrackCount::add(double damage, double of_length) {
  if (damage <= 0.0) return;
  ++damaged;
  if (damage >= 1.0) ++broken;
  length += of_length;
}

void CrackCount::operator+=(const CrackCount& other) {
  damaged += other.damaged;
  broken += other.broken;
  length += other.length;
}

Cracks count_cracks(const Mechanics<2>& mechanics) {
  const auto& model = mechanics.model();
  const auto& layout = mechanics.layout();
  const auto sums = chunked_sum<CrackSums>(layout.chunks.contacts, [&](int i, CrackSums& sum) {
    const int c = layout.contacts_by_chunk[i];
    const auto& contact = model.contacts[c];
    if (contact.interface != aggregate_mortar && contact.interface != mortar_mortar) return;
    const bool itz = contact.interface == aggregate_mortar;
    // one damage of both modes counts once, as tension
    const double tension = std::max(mechanics.remembered(c, Remembers::tension_damage),
                                    mechanics.remembered(c, Remembers::mixed_damage));
    const double shear = mechanics.remembered(c, Remembers::shear_damage);
    const double length = contact.area / model.thickness;
    (itz ? sum.tension_am : sum.tension_mm).add(tension, length);
    (itz ? sum.shear_am : sum.shear_mm).add(shear, length);
    if (tension > 0.0) {
      sum.opening +=
          std::max(0.0, mechanics.opening(c) + mechanics.remembered(c, Remembers::closure)) * length;
      sum.length += length;
    }
  });
  return {sums.tension_am, sums.tension_mm, sums.shear_am, sums.shear_mm,
          sums.length > 0.0 ? sums.opening / sums.length : 0.0};
}

}  // namespace pyroclast
