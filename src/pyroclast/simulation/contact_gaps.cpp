#include "pyroclast/simulation/contact_gaps.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/model/sets.hpp"

namespace pyroclast {

namespace {

const std::vector<int>& contacts_of(const Model& model, const StatedGap& gap) {
  if (const auto set = model.contact_sets.find(gap.contacts); set != model.contact_sets.end())
    return set->second;
  throw Error(fmt::format("{}: contacts = \"{}\" is no set of contacts; sets of contacts of this body: {}",
                          gap.place, gap.contacts, names_of(model.contact_sets)));
}

}  // namespace

double damage_in_tension(const Motion& motion, int contact) {
  return std::max(motion.read().remembered(contact, Remembers::tension_damage),
                  motion.read().remembered(contact, Remembers::mixed_damage));
}

double largest_damage(const Motion& motion, int contact) {
  const LawTable& law = motion.law_of(contact);
  double most = -1.0;
  for (const Remembers mode : kCrackModes)
    if (place_of(law, mode, motion.model().dimension()) >= 0)
      most = std::max(most, motion.read().remembered(contact, mode));
  return most;
}

std::vector<ContactGap> contact_gaps(const Model& model, const std::vector<StatedGap>& stated,
                                     const Motion* motion) {
  std::vector<ContactGap> gaps(model.contact_count());
  std::vector<const StatedGap*> gap_of(model.contact_count());
  for (const StatedGap& gap : stated)
    for (const int contact : contacts_of(model, gap)) {
      if (gap_of[contact] != nullptr)
        throw Error(fmt::format("{}: contacts of \"{}\" have a gap already ({})", gap.place, gap.contacts,
                                gap_of[contact]->place));
      gap_of[contact] = &gap;
      gaps[contact] = {1.0, gap.width};
    }
  if (motion == nullptr) return gaps;
  for (int i = 0; i < model.contact_count(); ++i) {
    gaps[i].opening += std::max(motion->read().opening(i), 0.0);
    gaps[i].damage = std::max(gaps[i].damage, damage_in_tension(*motion, i));
  }
  return gaps;
}

}  // namespace pyroclast
