#include "pyroclast/mechanics/found/pair_rows.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "pyroclast/base/place_in.hpp"

namespace pyroclast {

namespace {

/// Calls `f` with each number of a pair that its row keeps for it, and with that number of the row.
template <class Pair, class Row, class Arrays, class F>
void each_number_in_row(Pair& pair, Row& row, Arrays& arrays, int lane, F f) {
  const auto visit = [&](auto& number, auto& line) { f(number, line.number[lane]); };
  visit(pair.not_counted, row.not_counted);
  visit(pair.stored, row.stored);
  visit(pair.applied, row.applied);
  visit(pair.lost_area, row.lost_area);
  visit(pair.lost_damping, row.lost_damping);
  for (int k = 0; k < std::ssize(pair.points); ++k) {
    auto& point = pair.points[k];
    visit(point.area, row.area[k]);
    for (int i = 0; i < std::ssize(row.held[k]); ++i) {
      visit(point.held[i], row.held[k][i]);
      visit(point.shift[i], row.shift[k][i]);
    }
    visit(point.offset, row.offset[k]);
    visit(point.rest, row.rest[k]);
    visit(point.damped, row.damped[k]);
  }
  for (int i = 0; i < std::ssize(pair.internals); ++i)
    visit(pair.internals[i], arrays.internals[row.first_internal + i]);
  for (int i = 0; i < std::ssize(pair.lost); ++i) visit(pair.lost[i], arrays.lost[row.first_loss + i]);
}

}  // namespace

template <int Dim>
void PairRows<Dim>::make() {
  struct Group {
    int law, choices;
    int rest;      // 0 for pairs that bear; higher for those for which a step does less
    double wakes;  // those that sleep long stand together
    auto operator<=>(const Group&) const = default;
    bool goes_with(const Group& o) const { return law == o.law && choices == o.choices; }
  };
  std::vector<std::vector<int>> all_choices;
  std::vector<int> choices_of_set(static_cast<std::size_t>(body_.properties.contacts.size()), -1);
  const auto choices_of = [&](int set) {
    int& number = choices_of_set[set];
    if (number >= 0) return number;
    const auto& choices = body_.properties.contacts.choices(set);
    number = place_in(all_choices, choices);
    if (number == std::ssize(all_choices)) all_choices.push_back(choices);
    return number;
  };
  std::vector<std::pair<Group, int>> order;
  for (int i = 0; i < std::ssize(found_.pairs); ++i) {
    FoundPair<Dim>& pair = found_.pairs[i];
    pair.slot = -1;
    if (!pair.is_near) continue;
    if (pair.sets[0] < 0) pair.sets = facts_.sets_of(pair);
    const int rest = pair.bears() ? 0 : pair.presses() ? 1 : pair.was_asked ? 2 : 3;
    order.push_back({{pair.law, choices_of(pair.sets[0]), rest, pair.wakes}, i});
  }
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> firsts{0};  // entries of `order` at which rows begin
  for (std::size_t end = 0; end < order.size(); firsts.push_back(end)) {
    const Group& first = order[end++].first;
    while (end < order.size() && end < firsts.back() + kLanes && order[end].first.goes_with(first)) ++end;
  }
  auto& arrays = found_.arrays;
  arrays.rows = FlatArray<FoundRow<Dim>>(firsts.size() - 1);
  std::size_t internals = 0, losses = 0, constants = 0, choices = 0;
  for (std::size_t r = 0; r < arrays.rows.size(); ++r) {
    FoundRow<Dim>& row = arrays.rows[r];
    row.law = order[firsts[r]].first.law;
    row.first_internal = static_cast<int>(internals);
    row.first_loss = static_cast<int>(losses);
    row.first_constant = static_cast<int>(constants);
    row.first_choice = static_cast<int>(choices);
    const LawOfRows& law = arrays.laws[row.law];
    internals += kPointsOfPair<Dim> * law.internals;
    losses += law.losses;
    constants += kSetsOfPair<Dim> * law.constants;
    choices += (body_.laws[row.law]->constants_size + 63) / 64 * 64;
  }
  arrays.internals = FlatArray<Line>(internals);
  arrays.lost = FlatArray<Line>(losses);
  arrays.constants = FlatArray<Line>(constants);
  arrays.choices = FlatArray<std::byte>(choices);
  arrays.forces = FlatArray<Vec<Dim>>(2 * Dim * kLanes * arrays.rows.size());
  found_.constants.resize(static_cast<std::size_t>(body_.properties.contacts.size()));
  for (int r = 0; r < std::ssize(arrays.rows); ++r)
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::size_t at = firsts[r] + static_cast<std::size_t>(lane);
      const bool idles = at >= firsts[r + 1];
      FoundPair<Dim>& pair = found_.pairs[order[idles ? firsts[r] : at].second];
      if (!idles) pair.slot = slot_of(r, lane);
      // an idle lane is a new pair of the same facets, without thickness
      put(idles ? facts_.new_pair(pair.facets) : pair, r, lane);
      if (idles) arrays.rows[r].thickness.number[lane] = 0.0;
    }
  list_loads();
  let_sleep();
  see(found_.seen, arrays);
  found_.seen.is_damped = found_.parameters.damping > 0.0;
  found_.has_rows = found_.has_new_rows = true;
}

/// Returns the constants of a set of parameters, derived when they are first asked for.
template <int Dim>
const ConstantsOfSet& PairRows<Dim>::constants_of(int set) {
  ConstantsOfSet& constants = found_.constants[set];
  if (!constants.bytes.empty()) return constants;
  const LawTable& law = body_.properties.contacts.law(set);
  constants.bytes.resize(law.constants_size);
  body_.properties.contacts.derive(set, constants.bytes.data());
  constants.numbers.resize(static_cast<std::size_t>(law.constant_count));
  law.numbers_of(constants.bytes.data(), constants.numbers.data(), 1);
  constants.stiffness = law.stiffness(constants.bytes.data());
  return constants;
}

template <int Dim>
void PairRows<Dim>::put(const FoundPair<Dim>& pair, int index, int lane) {
  auto& arrays = found_.arrays;
  FoundRow<Dim>& row = arrays.rows[index];
  each_number_in_row(pair, row, arrays, lane, [](double number, double& in_row) { in_row = number; });
  const auto at = found_.corners(pair.facets);
  for (int i = 0; i < 2 * Dim; ++i) row.corners[i][lane] = offset_of<Dim>(body_.layout.gridpoint_slot[at[i]]);
  row.thickness.number[lane] = body_.model.thickness * pair.ratio;
  row.most_depth.number[lane] = found_.most_depth_of(pair.facets);
  row.damping.number[lane] = facts_.damping_of(pair.facets, constants_of(pair.sets[0]).stiffness.normal);
  const auto bit = 1U << static_cast<unsigned>(lane);
  if (pair.is_handed_over) row.handed_over |= bit;
  for (int set = 0; set < kSetsOfPair<Dim>; ++set) {
    const ConstantsOfSet& constants = constants_of(pair.sets[set]);
    if (lane == 0 && set == 0) std::ranges::copy(constants.bytes, arrays.choices.begin() + row.first_choice);
    const int of_law = arrays.laws[row.law].constants;
    for (int i = 0; i < of_law; ++i)
      arrays.constants[row.first_constant + set * of_law + i].number[lane] = constants.numbers[i];
    row.shear_stiffness[set].number[lane] = constants.stiffness.shear;
  }
  const std::uint32_t joined = facts_.joined_corners(pair.facets);
  if constexpr (Dim == 2) {
    row.unloaded_a.number[lane] = found_.facets[pair.facets[0]].length;
    row.unloaded_b.number[lane] = found_.facets[pair.facets[1]].length;
    for (int k = 0; k < 2; ++k)
      if ((joined >> static_cast<unsigned>(k) & 1U) == 0) row.counts[k] |= bit;
  } else {
    for (int i = 0; i < 2 * Dim; ++i) row.pressed_at[i][lane] = pair.pressed_at[i];
    row.overlap[lane] = pair.bears() || pair.is_handed_over ? overlap_of(pair.pressed_at) : Overlap{};
    if (row.overlap[lane].count > 0) row.had |= bit;
    row.joined[lane] = joined;
    row.sides.number[lane] = -1.0;
  }
}

/// Lists the forces of each gridpoint in the order of the pairs' keys.
template <int Dim>
void PairRows<Dim>::list_loads() {
  auto& arrays = found_.arrays;
  std::vector<std::array<int, 2>> forces;  // slot, and entry of the force
  for (const FoundPair<Dim>& pair : found_.pairs) {
    if (pair.slot < 0) continue;
    const auto at = found_.corners(pair.facets);
    for (int i = 0; i < 2 * Dim; ++i)
      forces.push_back({body_.layout.gridpoint_slot[at[i]],
                        (2 * Dim * (pair.slot / kLanes) + i) * kLanes + pair.slot % kLanes});
  }
  std::ranges::stable_sort(forces, {}, [](const auto& force) { return force[0]; });
  std::vector<LoadedGridpoint> loaded;
  std::vector<int> acting;
  for (const auto& [slot, entry] : forces) {
    if (loaded.empty() || loaded.back().slot != slot)
      loaded.push_back({slot, static_cast<int>(acting.size()), 0});
    acting.push_back(entry);
    loaded.back().last_force = static_cast<int>(acting.size());
  }
  arrays.loaded = FlatArray<LoadedGridpoint>(loaded);
  arrays.acting = FlatArray<int>(acting);
  std::vector<int> of_bundle;
  for (const Bundle& bundle : body_.layout.bundles) {
    const auto first =
        std::ranges::lower_bound(loaded, slot_of(bundle.first_pack, 0), {}, &LoadedGridpoint::slot);
    of_bundle.push_back(static_cast<int>(first - loaded.begin()));
  }
  of_bundle.push_back(static_cast<int>(loaded.size()));
  arrays.loaded_of_bundle = FlatArray<int>(of_bundle);
}

template <int Dim>
void PairRows<Dim>::let_sleep() {
  auto& arrays = found_.arrays;
  for (FoundRow<Dim>& row : arrays.rows) row.wakes = std::numeric_limits<double>::max();
  for (const FoundPair<Dim>& pair : found_.pairs)
    if (pair.slot >= 0) {
      double& wakes = arrays.rows[pair.slot / kLanes].wakes;
      wakes = std::min(wakes, pair.wakes);
    }
  for (LoadedGridpoint& gridpoint : arrays.loaded) {
    gridpoint.wakes = std::numeric_limits<double>::max();
    for (int k = gridpoint.first_force; k < gridpoint.last_force; ++k)
      gridpoint.wakes = std::min(gridpoint.wakes, arrays.rows[arrays.acting[k] / (2 * Dim * kLanes)].wakes);
  }
}

template <int Dim>
void PairRows<Dim>::take_back() {
  for (FoundPair<Dim>& pair : found_.pairs) take_from_row(found_, pair);
}

template <int Dim>
void take_from_row(const FoundData<Dim>& found, FoundPair<Dim>& pair) {
  if (pair.slot < 0) return;
  const FoundRow<Dim>& row = found.arrays.rows[pair.slot / kLanes];
  const int lane = pair.slot % kLanes;
  each_number_in_row(pair, row, found.arrays, lane, [](double& number, double in_row) { number = in_row; });
  if constexpr (Dim == 3) {
    pair.pressed_at = corners_in(row.pressed_at, lane);
    pair.was_asked = (row.asked >> static_cast<unsigned>(lane) & 1U) != 0;
  }
  const bool was_handed_over = pair.is_handed_over;
  pair.is_handed_over = (row.handed_over >> static_cast<unsigned>(lane) & 1U) != 0;
  // the sides have left each other: what follows is a new pair
  if (was_handed_over && !pair.is_handed_over) pair.ratio = 1.0;
}

template class PairRows<2>;
template class PairRows<3>;
template void take_from_row(const FoundData<2>&, FoundPair<2>&);
template void take_from_row(const FoundData<3>&, FoundPair<3>&);

}  // namespace pyroclast
