#include "pyroclast/mechanics/cracks.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/mechanics/reader.hpp"

namespace pyroclast {

const char* name_of_mode(Remembers damage) {
  if (damage == Remembers::tension_damage) return "tension";
  return damage == Remembers::shear_damage ? "shear" : "mixed";
}

namespace {

/// Returns the law of each interface, by its first contact; null where no contact has the interface.
template <int Dim>
std::vector<const LawTable*> laws_of_interfaces(const Body<Dim>& body) {
  const auto& contacts = body.model.contacts;
  std::vector<const LawTable*> laws;
  for (int i = 0; i < static_cast<int>(body.model.interface_names.size()); ++i) {
    const auto first = std::ranges::find(contacts, i, &Contact<Dim>::interface);
    double place =
        -1.0;  // a part may lack the contacts of an interface; its list of laws is that of the whole
    if (first != contacts.end())
      place = static_cast<double>(
          std::ranges::find(body.laws, &body.law_of(static_cast<int>(first - contacts.begin()))) -
          body.laws.begin());
    place = body.model.ranks().largest(place);
    laws.push_back(place < 0.0 ? nullptr : body.laws[static_cast<std::size_t>(place)]);
  }
  return laws;
}

/// Returns the bit of a contact point that a mode has damaged; `broken_by` returns that of a broken one.
constexpr std::uint8_t damaged_by(std::size_t mode) {
  return static_cast<std::uint8_t>(1U << (2 * mode));
}
constexpr std::uint8_t broken_by(std::size_t mode) {
  return static_cast<std::uint8_t>(2U << (2 * mode));
}
static_assert(std::size(kCrackModes) <= 4, "a byte has the bits of four modes");

std::size_t mode_of(Remembers damage) {
  return static_cast<std::size_t>(std::ranges::find(kCrackModes, damage) - std::begin(kCrackModes));
}

/// Tells whether eight numbers are zero, by their bits, which a compiler takes together.
bool all_zero(const double* lanes) {
  std::uint64_t bits = 0;
  for (int lane = 0; lane < kLanes; ++lane) bits |= std::bit_cast<std::uint64_t>(lanes[lane]);
  return bits == 0;
}

/// Calls `f(pack_of_points, mode, damages)` where a mode has damaged one of the eight points. Goes over the
/// internal variables as they stand: most points have no damage, and to ask one by one costs more than all
/// else of a look.
template <int Dim, class F>
void for_each_damage(const Body<Dim>& body, F f) {
  const auto& layout = body.layout;
  const auto& state = body.state;
  struct Place {
    std::size_t line, mode;
  };
  std::vector<std::vector<Place>>
      places;  // for each law, the internal variables of a point that are damages, with their modes
  for (const LawTable* law : body.laws)
    for (auto& of_law = places.emplace_back(); const InternalInfo& info : law->internals(Dim))
      if (const std::size_t mode = mode_of(info.what); mode < std::size(kCrackModes))
        of_law.push_back({static_cast<std::size_t>(&info - law->internals(Dim).data()), mode});
  for (int pack = 0; pack < layout.face_packs(); ++pack) {
    const std::uint8_t law = state.law_of_faces[pack];
    const std::size_t lines_of_point = body.laws[law]->internals(Dim).size();
    const Line* const lines = state.internals.data() + state.first_internal[pack];
    const int first = layout.first_point_of(pack);
    for (int point = first; point < layout.first_point_of(pack + 1); ++point) {
      const Line* const line = lines + static_cast<std::size_t>(point - first) * lines_of_point;
      for (const auto [place, mode] : places[law])
        if (const double* const damage = line[place].number; !all_zero(damage)) f(point, mode, damage);
    }
  }
}

/// Returns the bits of the contact point of each slot.
template <int Dim>
std::vector<std::uint8_t> damages(const Body<Dim>& body) {
  std::vector<std::uint8_t> bits(
      static_cast<std::size_t>(body.layout.first_point_of(body.layout.face_packs())) * kLanes);
  for_each_damage(body, [&](int point, std::size_t mode, const double* damage) {
    std::uint8_t* const of_point = bits.data() + static_cast<std::size_t>(point) * kLanes;
    for (int lane = 0; lane < kLanes; ++lane)
      of_point[lane] |= static_cast<std::uint8_t>((damage[lane] > 0.0 ? damaged_by(mode) : 0) |
                                                  (damage[lane] >= 1.0 ? broken_by(mode) : 0));
  });
  return bits;
}

/// Sums over contacts: their count for one kind of crack, their openings for all kinds together.
struct CrackSums {
  CrackCount count;
  double opening = 0.0;  ///< sum of openings times extents over contacts damaged in tension or mixed mode
  double extent = 0.0;   ///< sum of the extents of these contacts

  void operator+=(const CrackSums& other) {
    count += other.count;
    opening += other.opening;
    extent += other.extent;
  }
};

}  // namespace

void CrackCount::add(bool is_broken, double extent_of_point) {
  ++damaged;
  extent += extent_of_point;
  if (!is_broken) return;
  ++broken;
  broken_extent += extent_of_point;
}

void CrackCount::operator+=(const CrackCount& other) {
  damaged += other.damaged;
  broken += other.broken;
  extent += other.extent;
  broken_extent += other.broken_extent;
}

template <int Dim>
std::vector<CrackKind> crack_kinds(const Body<Dim>& body) {
  const auto& names = body.model.interface_names;
  const auto laws = laws_of_interfaces(body);
  std::vector<CrackKind> kinds;
  for (const Remembers damage : kCrackModes)
    for (int i = 0; i < static_cast<int>(names.size()); ++i)
      if (laws[i] && std::ranges::count(laws[i]->internals(Dim), damage, &InternalInfo::what) > 0)
        kinds.push_back({damage, i, fmt::format("{}_{}", name_of_mode(damage), names[i])});
  return kinds;
}

template <int Dim>
Cracks count_cracks(const Body<Dim>& body, const std::vector<CrackKind>& kinds) {
  const auto& model = body.model;
  const auto& layout = body.layout;
  const Reader<Dim> read(body);
  struct Counted {
    std::size_t kind, mode;
  };
  std::vector<std::vector<Counted>> of_interface(model.interface_names.size());
  for (std::size_t k = 0; k < kinds.size(); ++k)
    of_interface[kinds[k].interface].push_back({k, mode_of(kinds[k].damage)});
  const std::vector<std::uint8_t> bits_of_slots = damages(body);
  // the last sums are those of all kinds
  const auto add = [&](int i, std::span<CrackSums> sums) {
    const int c = layout.contacts_by_chunk[i];
    const std::uint8_t bits = bits_of_slots[layout.contact_slot[c]];
    const auto& contact = model.contacts[c];
    if (bits == 0 || body.has_left(contact)) return;
    const double extent = model.extent(c);
    bool apart = false;
    for (const auto [kind, mode] : of_interface[contact.interface]) {
      if ((bits & damaged_by(mode)) == 0) continue;
      sums[kind].count.add((bits & broken_by(mode)) != 0, extent);
      apart = apart || kinds[kind].damage != Remembers::shear_damage;
    }
    if (!apart) return;
    sums.back().opening += std::max(0.0, read.opening(c) + read.remembered(c, Remembers::closure)) * extent;
    sums.back().extent += extent;
  };
  const auto sums = chunked_sums<CrackSums>(layout.chunks.contacts, kinds.size() + 1, add);
  Cracks cracks;
  for (std::size_t k = 0; k < kinds.size(); ++k) cracks.of_kind.push_back(sums[k].count);
  if (sums.back().extent > 0.0) cracks.mean_opening = sums.back().opening / sums.back().extent;
  return cracks;
}

template <int Dim>
void note_cracks(Body<Dim>& body) {
  const auto now = static_cast<double>(body.steps);
  for_each_damage(body, [&](int point, std::size_t /*mode*/, const double* damage) {
    double* const step = body.arrays.crack_step.data() + static_cast<std::size_t>(point) * kLanes;
    for (int lane = 0; lane < kLanes; ++lane)
      if (damage[lane] > kCracked && step[lane] == kNotCracked) step[lane] = now;
  });
}

template void note_cracks(Body<2>&);
template void note_cracks(Body<3>&);
template std::vector<CrackKind> crack_kinds(const Body<2>&);
template std::vector<CrackKind> crack_kinds(const Body<3>&);
template Cracks count_cracks(const Body<2>&, const std::vector<CrackKind>&);
template Cracks count_cracks(const Body<3>&, const std::vector<CrackKind>&);

}  // namespace pyroclast
