#include "pyroclast/mechanics/found/pair_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pyroclast/base/sort_unique.hpp"

namespace pyroclast {

namespace {

/// Distance from the origin, over the mean edge, beyond which nothing meets any more.
constexpr double kFarthest = 1e5;
/// Steps to the end of lists of far pairs over those to the end of lists of near ones.
constexpr double kFarOverNear = 20.0;
/// Share of the steps and of the way to the end of lists of near pairs: in space a step looks longer at each
/// pair than in the plane, so that searches pay sooner.
template <int Dim>
constexpr double kOfNear = Dim == 2 ? 1.0 : 0.3;
/// Longest such ways: for far pairs over the mean edge, for near ones over those for far pairs.
constexpr double kLongestFar = 0.25, kLongestNear = 0.2;

}  // namespace

template <int Dim>
bool PairSearch<Dim>::find() {
  // the lists hold as long as no gridpoint of theirs has gone too far
  for (std::size_t f = 0; found_.has_far && f < found_.facets.size(); ++f)
    for (const int g : found_.facets[f].gridpoints) {
      if (!found_.is_listed[f]) break;
      const int slot = body_.layout.gridpoint_slot[g];
      const Vec<Dim> way = body_.arrays.displacement[slot] - found_.searched_far[slot];
      const double most = 0.5 * found_.skin[found_.facets[f].block];
      found_.has_far = found_.has_far && dot(way, way) <= most * most;
    }
  if (!found_.has_far) find_far();
  const bool finds_others = find_near();
  watch();
  return finds_others;
}

/// Returns twice the way that each block's fastest gridpoint goes in some steps, m.
/// \param least, most  bounds, m
template <int Dim>
std::vector<double> PairSearch<Dim>::ways(double steps, double least, double most) const {
  std::vector<double> ways(found_.broadest.size(), least);
  for (int g = 0; g < body_.model.gridpoint_count(); ++g) {
    const int slot = body_.layout.gridpoint_slot[g];
    const double way = 2.0 * steps * body_.state.time_step * norm(vector_at<Dim>(body_.state.velocity, slot));
    double& of_block = ways[found_.block_of_slot[slot]];
    if (!(way <= of_block)) of_block = way < most ? way : most;
  }
  return ways;
}

/// Returns the box of a facet at the search for far pairs, grown by half of the largest distance of a pair
/// that counts before the next such search; none for a facet that has flown off, or has no number.
template <int Dim>
auto PairSearch<Dim>::box_of(int index) const -> std::optional<Box> {
  const BlockFacet<Dim>& facet = found_.facets[index];
  const double grow =
      0.5 * ((1.0 + kMargin * kLongestNear) * found_.skin[facet.block] + found_.most_depth[facet.block]);
  Box box;
  for (int k = 0; k < Dim; ++k) {
    const int g = facet.gridpoints[k];
    const Vec<Dim> at = body_.model.position[g] + found_.searched_far[body_.layout.gridpoint_slot[g]];
    for (int i = 0; i < Dim; ++i) {
      if (!(std::abs(at[i]) < kFarthest * found_.mean_edge)) return {};
      box.low[i] = k == 0 ? at[i] - grow : std::min(box.low[i], at[i] - grow);
      box.high[i] = k == 0 ? at[i] + grow : std::max(box.high[i], at[i] + grow);
    }
  }
  return box;
}

/// Lists a pair of free facets as far where their boxes meet and it may press before the next such search.
template <int Dim>
void PairSearch<Dim>::list_if_far(int a, const Box& box_a, int b, const Box& box_b) {
  const PairKey key{std::min(a, b), std::max(a, b)};
  if (found_.facets[a].block == found_.facets[b].block || !found_.may_meet(key) ||
      !found_.is_of_rank(body_.model.ranks().me(), key))
    return;
  for (int k = 0; k < Dim; ++k)
    if (box_a.low[k] > box_b.high[k] || box_b.low[k] > box_a.high[k]) return;
  const double within = kMargin * (1.0 + kLongestNear) * found_.larger_of(found_.skin, key);
  const double way = facts_.way_to_press(key, facts_.places(key, found_.searched_far), within);
  if (way < within) found_.far.push_back({key, way / kMargin});
}

/// Lists the far pairs of free facets.
template <int Dim>
void PairSearch<Dim>::find_far() {
  found_.skin = ways(kFarOverNear * found_.parameters.steps, found_.parameters.skin * found_.mean_edge,
                     std::max(kLongestFar, found_.parameters.skin) * found_.mean_edge);
  found_.searched_far = body_.arrays.displacement;
  std::vector<int> free;
  std::vector<Box> boxes;
  double sum = 0.0;
  found_.is_listed.assign(found_.facets.size(), false);
  for (int f = 0; f < std::ssize(found_.facets); ++f) {
    if (!found_.facets[f].is_free) continue;
    const auto box = box_of(f);
    if (!box) continue;
    found_.is_listed[f] = true;
    free.push_back(f);
    boxes.push_back(*box);
    sum += found_.facets[f].length;
  }
  // cells of a grid, with the facets whose boxes reach into them
  const double cell = free.empty() ? 1.0 : 2.0 * sum / static_cast<double>(free.size());
  struct Entry {
    std::array<int, Dim> cell;
    int facet;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries;
  const auto cell_of = [&](double x) { return static_cast<int>(std::floor(x / cell)); };
  for (int i = 0; i < std::ssize(free); ++i) {
    std::array<int, Dim> first, last;
    for (int k = 0; k < Dim; ++k) {
      first[k] = cell_of(boxes[i].low[k]);
      last[k] = cell_of(boxes[i].high[k]);
    }
    for (std::array<int, Dim> at = first;;) {
      entries.push_back({at, i});
      int k = Dim - 1;
      while (k >= 0 && at[k] == last[k]) {
        at[k] = first[k];
        --k;
      }
      if (k < 0) break;
      ++at[k];
    }
  }
  std::sort(entries.begin(), entries.end());
  found_.far.clear();
  for (std::size_t i = 0; i < entries.size(); ++i)
    for (std::size_t j = i + 1; j < entries.size() && entries[i].cell == entries[j].cell; ++j) {
      const int a = entries[i].facet, b = entries[j].facet;
      list_if_far(free[a], boxes[a], free[b], boxes[b]);
    }
  sort_unique(found_.far);
  found_.has_far = true;
}

template <int Dim>
void PairSearch<Dim>::add_to_far(const std::vector<int>& faces) {
  if (!found_.has_far) return;
  for (const int face : faces)
    for (int a = found_.first_of_face[face]; a < found_.first_of_face[face + 1]; ++a) {
      const auto box = box_of(a);
      if (!box) continue;
      found_.is_listed[a] = true;
      for (int b = 0; b < std::ssize(found_.facets); ++b)
        if (found_.is_listed[b]) list_if_far(a, *box, b, *box_of(b));
    }
  sort_unique(found_.far);
}

/// Returns FoundPair::wakes of a pair that does not press; 1 or more where it cannot before the next search.
/// \param handed_over  the pair where it is handed over, else null
template <int Dim>
double PairSearch<Dim>::wakes(const PairKey& key, const FoundPair<Dim>* handed_over) const {
  const auto at = facts_.places(key, body_.arrays.displacement);
  const double within = kMargin * found_.larger_of(found_.reach, key);
  const double way =
      handed_over ? facts_.way_to_change(*handed_over, at, within) : facts_.way_to_press(key, at, within);
  const double share = way / within;
  return share > 0.0 ? share * share : 0.0;
}

/// Lists the pairs that are near, in rows or not, and those that remember something. Returns whether there
/// are near ones that stand in no row.
template <int Dim>
bool PairSearch<Dim>::find_near() {
  const FoundParameters& p = found_.parameters;
  found_.reach = ways(kOfNear<Dim> * p.steps, kOfNear<Dim> * p.reach * found_.mean_edge, found_.mean_edge);
  for (std::size_t b = 0; b < found_.reach.size(); ++b)
    found_.reach[b] = std::min(found_.reach[b], kLongestNear * found_.skin[b]);
  std::vector<double> gone(found_.broadest.size());  // way of each block since the search for far pairs, m
  for (int g = 0; g < body_.model.gridpoint_count(); ++g) {
    const int slot = body_.layout.gridpoint_slot[g];
    double& of_block = gone[found_.block_of_slot[slot]];
    of_block = larger(of_block, norm(body_.arrays.displacement[slot] - found_.searched_far[slot]));
  }
  // Tells whether a pair that was far may be near.
  const auto may_be_near = [&](const FarPair& far) {
    return !(far.way >=
             2.0 * found_.larger_of(gone, far.facets) + found_.larger_of(found_.reach, far.facets));
  };
  std::vector<FoundPair<Dim>> next;
  next.reserve(found_.pairs.size());
  bool others = false;
  auto old = found_.pairs.begin();
  const auto keep_old = [&](bool is_far) {
    if (old->presses())
      old->wakes = 0.0;
    else if (old->is_handed_over || is_far)
      old->wakes = wakes(old->facets, old->is_handed_over ? &*old : nullptr);
    else
      old->wakes = 1.0;
    old->is_near = old->wakes < 1.0;
    others = others || (old->is_near && old->slot < 0);
    if (old->is_near || old->slot >= 0 || old->remembers() || old->has_lost())
      next.push_back(std::move(*old));
    ++old;
  };
  for (const FarPair& far : found_.far) {
    while (old != found_.pairs.end() && old->facets < far.facets) keep_old(false);
    if (old != found_.pairs.end() && old->facets == far.facets) {
      keep_old(may_be_near(far));
    } else if (!may_be_near(far)) {
      continue;
    } else if (const double share = wakes(far.facets, nullptr); share < 1.0) {
      next.push_back(facts_.new_pair(far.facets));
      next.back().wakes = share;
      others = true;
    }
  }
  while (old != found_.pairs.end()) keep_old(false);
  // All ranks make rows anew at the same time, so that two of them have the same pairs in rows.
  if (found_.has_rows) others = body_.model.ranks().any(others);
  // while no pair is to come into a row, those that are near no more sleep in theirs
  if (others)
    std::erase_if(next, [](const FoundPair<Dim>& pair) {
      return !pair.is_near && !pair.remembers() && !pair.has_lost();
    });
  found_.pairs = std::move(next);
  found_.arrays.searched = body_.arrays.displacement;
  found_.has_near = true;
  ++found_.searches;
  return others;
}

/// Lists the packs of gridpoints of free facets, and the ways that these may go.
template <int Dim>
void PairSearch<Dim>::watch() {
  std::vector<WatchedPack> watched;
  std::vector<bool> is_watched(found_.block_of_slot.size());
  for (std::size_t f = 0; f < found_.facets.size(); ++f)
    if (found_.is_listed[f])
      for (const int g : found_.facets[f].gridpoints) is_watched[body_.layout.gridpoint_slot[g]] = true;
  const auto [first, last] = body_.layout.chunks.bundles.own();
  const int end = body_.layout.first_pack_of(last);
  for (int pack = body_.layout.first_pack_of(first); pack < end; ++pack) {
    WatchedPack of_pack{{}, pack};
    bool any = false;
    for (int lane = 0; lane < kLanes; ++lane) {
      const int slot = slot_of(pack, lane);
      if (!is_watched[slot]) continue;
      const double most = 0.5 * found_.reach[found_.block_of_slot[slot]];
      of_pack.over_way.number[lane] = 1.0 / (most * most);
      any = true;
    }
    if (any) watched.push_back(of_pack);
  }
  found_.arrays.watched = FlatArray<WatchedPack>(watched);
  see(found_.seen, found_.arrays);
}

template <int Dim>
void PairSearch<Dim>::leave_out_overlaps(const std::vector<bool>& fresh, double tolerance) {
  for (FoundPair<Dim>& pair : found_.pairs) {
    const auto [a, b] = pair.facets;
    if (!pair.is_near || pair.remembers() || !(fresh[a] || fresh[b])) continue;
    const PairShape<Dim> shape = facts_.shape(pair.facets, facts_.places_of_forces(pair.facets));
    const double least = -tolerance * std::min(found_.facets[a].length, found_.facets[b].length),
                 most = -found_.most_depth_of(pair.facets);
    bool lies_in = false;
    for (int k = 0; k < shape.points; ++k)
      lies_in = lies_in || (shape.p.gap[k] < least && shape.p.gap[k] > most);
    if (!lies_in) continue;
    pair.not_counted = shape.p.overlap;
    pair.wakes = 0.0;
  }
}

template class PairSearch<2>;
template class PairSearch<3>;

}  // namespace pyroclast
