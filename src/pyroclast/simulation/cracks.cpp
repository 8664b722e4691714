#include "pyroclast/simulation/cracks.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/chunked_sum.hpp"

namespace pyroclast {

namespace {

const char* name_of(Remembers damage) {
  if (damage == Remembers::tension_damage) return "tension";
  return damage == Remembers::shear_damage ? "shear" : "mixed";
}

/// Of an interface, by its first contact; none where no contact has it.
const LawTable* law_of_interface(const Mechanics<2>& mechanics, int interface) {
  const auto& contacts = mechanics.model().contacts;
  const auto first = std::ranges::find(contacts, interface, &Contact<2>::interface);
  return first == contacts.end() ? nullptr : &mechanics.law_of(static_cast<int>(first - contacts.begin()));
}

/// Whether the contact point of each slot has any damage. It goes over the histories as they stand: most
/// points have none, and to ask one by one costs more than all else of a look.
std::vector<std::uint8_t> damaged_slots(const Mechanics<2>& mechanics) {
  const auto& layout = mechanics.layout();
  const auto& state = mechanics.state();
  std::vector<std::vector<std::size_t>> places;  // of each law, where a point's history has its damages
  for (const LawTable* law : mechanics.laws())
    for (auto& of_law = places.emplace_back(); const HistoryInfo& info : law->history(2))
      if (std::ranges::find(kCrackModes, info.what) != std::end(kCrackModes))
        of_law.push_back(static_cast<std::size_t>(&info - law->history(2).data()));
  std::vector<std::uint8_t> damaged(static_cast<std::size_t>(layout.first_point_of(layout.face_rows())) *
                                    kLanes);
  for (int row = 0; row < layout.face_rows(); ++row) {
    const std::uint8_t law = state.law_of_faces[row];
    const std::size_t lines_of_point = mechanics.laws()[law]->history(2).size();
    const Line* const lines = state.history.data() + state.first_history[row];
    const int first = layout.first_point_of(row);
    for (int point = first; point < layout.first_point_of(row + 1); ++point) {
      const Line* const line = lines + static_cast<std::size_t>(point - first) * lines_of_point;
      std::uint8_t* const of_point = damaged.data() + static_cast<std::size_t>(point) * kLanes;
      for (const std::size_t place : places[law])
        for (int lane = 0; lane < kLanes; ++lane) of_point[lane] |= line[place].number[lane] > 0.0;
    }
  }
  return damaged;
}

struct CrackSums {
  std::vector<CrackCount> of_kind;
  double opening = 0.0, length = 0.0;  ///< of contacts that have come apart, m², m

  void operator+=(const CrackSums& other) {
    of_kind.resize(std::max(of_kind.size(), other.of_kind.size()));
    for (std::size_t k = 0; k < other.of_kind.size(); ++k) of_kind[k] += other.of_kind[k];
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

std::vector<CrackKind> crack_kinds(const Mechanics<2>& mechanics) {
  const auto& names = mechanics.model().interface_names;
  std::vector<const LawTable*> laws;
  for (int i = 0; i < static_cast<int>(names.size()); ++i) laws.push_back(law_of_interface(mechanics, i));
  std::vector<CrackKind> kinds;
  for (const Remembers damage : kCrackModes)
    for (int i = 0; i < static_cast<int>(names.size()); ++i)
      if (laws[i] && std::ranges::count(laws[i]->history(2), damage, &HistoryInfo::what) > 0)
        kinds.push_back({damage, i, fmt::format("{}_{}", name_of(damage), names[i])});
  return kinds;
}

Cracks count_cracks(const Mechanics<2>& mechanics, const std::vector<CrackKind>& kinds) {
  const auto& model = mechanics.model();
  const auto& layout = mechanics.layout();
  std::vector<std::vector<std::size_t>> of_interface(model.interface_names.size());
  for (std::size_t k = 0; k < kinds.size(); ++k) of_interface[kinds[k].interface].push_back(k);
  const std::vector<std::uint8_t> damaged = damaged_slots(mechanics);
  auto sums = chunked_sum<CrackSums>(layout.chunks.contacts, [&](int i, CrackSums& sum) {
    const int c = layout.contacts_by_chunk[i];
    if (!damaged[layout.contact_slot[c]]) return;
    const auto& contact = model.contacts[c];
    const double length = contact.area / model.thickness;
    bool apart = false;
    for (const std::size_t k : of_interface[contact.interface]) {
      const double damage = mechanics.remembered(c, kinds[k].damage);
      if (damage <= 0.0) continue;
      sum.of_kind.resize(kinds.size());
      sum.of_kind[k].add(damage, length);
      apart = apart || kinds[k].damage != Remembers::shear_damage;
    }
    if (!apart) return;
    sum.opening += std::max(0.0, mechanics.opening(c) + mechanics.remembered(c, Remembers::closure)) * length;
    sum.length += length;
  });
  sums.of_kind.resize(kinds.size());
  return {std::move(sums.of_kind), sums.length > 0.0 ? sums.opening / sums.length : 0.0};
}

}  // namespace pyroclast
