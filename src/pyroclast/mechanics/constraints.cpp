#include "pyroclast/mechanics/constraints.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "pyroclast/base/error.hpp"
#include "pyroclast/mechanics/reader.hpp"

namespace pyroclast {

namespace {

/// Tells whether a slot is one of a bundle, or of the block whose first bundle this is.
template <int Dim>
bool is_slot_of(const Body<Dim>& body, int slot, int first_bundle) {
  return body.first_bundle_of(body.layout.bundle_of_pack[slot / kLanes]) == first_bundle;
}

}  // namespace

/// Lets the constraints of a gridpoint's bundle act from now on. Makes them where there are none yet.
template <int Dim>
void Constraints<Dim>::constrain(int gridpoint) {
  const int b = body_.layout.bundle_of(gridpoint);
  int& index = body_.made_constraints[b];
  if (index < 0) {
    index = static_cast<int>(body_.arrays.constraints.size());
    const auto first_pack = body_.arrays.constraint_packs.size();
    body_.arrays.constraints.resize(body_.arrays.constraints.size() + 1);
    body_.arrays.constraints[index].first_pack = static_cast<int>(first_pack);
    body_.arrays.constraint_packs.resize(first_pack +
                                         static_cast<std::size_t>(body_.layout.bundles[b].packs));
    body_.constraints_are_in_order = false;
    body_.refresh_views();
  }
  body_.arrays.constraints_of_bundle[b] = index;
}

template <int Dim>
void Constraints<Dim>::order() {
  if (std::exchange(body_.constraints_are_in_order, true)) return;
  auto& s = body_.arrays;
  FlatArray<BundleConstraints> constraints(s.constraints.size());
  FlatArray<ConstraintPack<Dim>> packs(s.constraint_packs.size());
  int next = 0, next_pack = 0;
  for (std::size_t b = 0; b < body_.made_constraints.size(); ++b) {
    int& index = body_.made_constraints[b];
    if (index < 0) continue;
    constraints[next] = s.constraints[index];
    const int first_pack = std::exchange(constraints[next].first_pack, next_pack);
    std::copy_n(s.constraint_packs.begin() + first_pack, body_.layout.bundles[b].packs,
                packs.begin() + next_pack);
    next_pack += body_.layout.bundles[b].packs;
    if (s.constraints_of_bundle[b] >= 0) s.constraints_of_bundle[b] = next;
    index = next++;
  }
  s.constraints = std::move(constraints);
  s.constraint_packs = std::move(packs);
  body_.refresh_views();
}

template <int Dim>
ConstraintPack<Dim>& Constraints<Dim>::constraint_pack(int gridpoint) {
  constrain(gridpoint);
  return body_.arrays.constraint_packs[body_.constraint_pack_of(gridpoint)];
}

/// Lets a bundle that nothing holds, drives or loads any more take the shorter way through a step.
template <int Dim>
void Constraints<Dim>::drop_if_free(int b) {
  const int index = body_.made_constraints[b];
  if (index < 0) return;
  const BundleConstraints& constraints = body_.arrays.constraints[index];
  if (constraints.ties()) return;
  for (int pack = 0; pack < body_.layout.bundles[b].packs; ++pack)
    for (int i = 0; i < Dim; ++i) {
      const ConstraintPack<Dim>& held = body_.arrays.constraint_packs[constraints.first_pack + pack];
      if (held.prescribed[i] != 0) return;
      for (double force : held.applied[i])
        if (force != 0.0) return;
    }
  body_.arrays.constraints_of_bundle[b] = -1;
}

template <int Dim>
void Constraints<Dim>::prescribe_velocity(int gridpoint, int component, double velocity) {
  auto& pack = constraint_pack(gridpoint);
  const int lane = body_.layout.gridpoint_slot[gridpoint] % kLanes;
  pack.prescribed[component] = static_cast<std::uint8_t>(pack.prescribed[component] | (1U << lane));
  pack.prescribed_velocity[component][lane] = velocity;
}

template <int Dim>
void Constraints<Dim>::release(int gridpoint, int component) {
  const int bundle = body_.layout.bundle_of(gridpoint);
  if (body_.made_constraints[bundle] < 0) return;
  auto& pack = constraint_pack(gridpoint);
  const int lane = body_.layout.gridpoint_slot[gridpoint] % kLanes;
  pack.prescribed[component] = static_cast<std::uint8_t>(pack.prescribed[component] & ~(1U << lane));
  drop_if_free(bundle);
}

template <int Dim>
void Constraints<Dim>::tie(std::vector<int> gridpoints, int component) {
  std::erase_if(gridpoints, [&](int g) { return !body_.layout.chunks.gridpoints.is_own(g); });
  if (gridpoints.empty()) return;  // another rank moves the block
  std::sort(gridpoints.begin(), gridpoints.end());
  TieOfBundle tie{body_.first_bundle_of(body_.layout.bundle_of(gridpoints.front())), component, {}};
  double mass = 0.0, momentum = 0.0;
  for (int g : gridpoints) {
    if (body_.first_bundle_of(body_.layout.bundle_of(g)) != tie.bundle)
      throw Error("gridpoints of several blocks cannot be tied: a plate is one block");
    constrain(g);
    tie.slots.push_back(body_.layout.gridpoint_slot[g]);
    mass += body_.mass[g];
    momentum += body_.mass[g] * Reader<Dim>(body_).velocity(g)[component];
  }
  for (int slot : tie.slots)
    body_.arrays.velocity[slot / kLanes].c[component][slot % kLanes] = momentum / mass;
  body_.made_ties.push_back(std::move(tie));
  place_ties();
}

template <int Dim>
void Constraints<Dim>::untie() {
  body_.made_ties.clear();
  place_ties();
  for (std::size_t b = 0; b < body_.made_constraints.size(); ++b) drop_if_free(static_cast<int>(b));
}

template <int Dim>
void Constraints<Dim>::place_ties() {
  std::sort(body_.made_ties.begin(), body_.made_ties.end(), [](const TieOfBundle& a, const TieOfBundle& b) {
    return std::tie(a.bundle, a.component, a.slots) < std::tie(b.bundle, b.component, b.slots);
  });
  body_.arrays.ties.resize(0);
  body_.arrays.tied_slots.resize(0);
  for (auto& constraints : body_.arrays.constraints) constraints.first_tie = constraints.last_tie = 0;
  for (const TieOfBundle& tie : body_.made_ties) {
    const auto begin = body_.arrays.tied_slots.size();
    body_.arrays.tied_slots.resize(begin + tie.slots.size());
    std::copy(tie.slots.begin(), tie.slots.end(), body_.arrays.tied_slots.begin() + begin);
    const auto index = static_cast<int>(body_.arrays.ties.size());
    body_.arrays.ties.resize(body_.arrays.ties.size() + 1);
    body_.arrays.ties[index] = {tie.component, static_cast<int>(begin),
                                static_cast<int>(begin + tie.slots.size())};
    for (const int slot : tie.slots) {
      const int bundle = body_.layout.bundle_of_pack[slot / kLanes];
      auto& constraints = body_.arrays.constraints[body_.made_constraints[bundle]];
      if (!constraints.ties()) constraints.first_tie = index;
      constraints.last_tie = index + 1;
    }
  }
  body_.refresh_views();
}

template <int Dim>
void Constraints<Dim>::apply_force(int gridpoint, const Vec<Dim>& force) {
  auto& pack = constraint_pack(gridpoint);
  const int lane = body_.layout.gridpoint_slot[gridpoint] % kLanes;
  for (int i = 0; i < Dim; ++i) pack.applied[i][lane] = force[i];
  drop_if_free(body_.layout.bundle_of(gridpoint));
}

/// Makes the constraints of a bundle anew, as a state has them.
template <int Dim>
void Constraints<Dim>::make(int bundle, bool act, double loading_work,
                            std::span<const ConstraintPack<Dim>> packs) {
  auto& s = body_.arrays;
  const auto index = s.constraints.size(), first_pack = s.constraint_packs.size();
  s.constraints.resize(index + 1);
  s.constraints[index].first_pack = static_cast<int>(first_pack);
  s.constraints[index].loading_work = loading_work;
  s.constraint_packs.resize(first_pack + packs.size());
  std::copy(packs.begin(), packs.end(), s.constraint_packs.begin() + first_pack);
  body_.made_constraints[bundle] = static_cast<int>(index);
  s.constraints_of_bundle[bundle] = act ? static_cast<int>(index) : -1;
}

template <int Dim>
void Constraints<Dim>::visit_state(StateVisitor& visitor) {
  const ChunkList& bundles = body_.layout.chunks.bundles;
  auto& s = body_.arrays;
  if (visitor.replaces()) {  // the body has forgotten what they were
    s.constraints.resize(0);
    s.constraint_packs.resize(0);
    std::fill(s.constraints_of_bundle.begin(), s.constraints_of_bundle.end(), -1);
    std::ranges::fill(body_.made_constraints, -1);
    body_.made_ties.clear();
  }
  using Packs = std::span<const ConstraintPack<Dim>>;
  const auto for_each_made = [&](int chunk, auto f) {
    for (int b = bundles[chunk]; b < bundles[chunk + 1]; ++b)
      if (const int index = body_.made_constraints[b]; index >= 0)
        f(b, s.constraints[index],
          Packs(s.constraint_packs.data() + s.constraints[index].first_pack,
                static_cast<std::size_t>(body_.layout.bundles[b].packs)));
  };
  // a bundle is known by its number in its chunk, twice that, plus one where its constraints act
  auto made = ListByChunk<int>::of(bundles, [&](int chunk, std::vector<int>& list) {
    for_each_made(chunk, [&](int b, const auto& /*made*/, Packs /*packs*/) {
      list.push_back(2 * (b - bundles[chunk]) + (s.constraints_of_bundle[b] >= 0 ? 1 : 0));
    });
  });
  auto works = ListByChunk<double>::of(bundles, [&](int chunk, std::vector<double>& list) {
    for_each_made(chunk, [&](int /*b*/, const BundleConstraints& of, Packs /*packs*/) {
      list.push_back(of.loading_work);
    });
  });
  auto packs = ListByChunk<ConstraintPack<Dim>>::of(bundles, [&](int chunk, auto& list) {
    for_each_made(chunk, [&](int /*b*/, const auto& /*made*/, Packs of) {
      list.insert(list.end(), of.begin(), of.end());
    });
  });
  auto ties = ties_by_chunk();
  visitor.visit_by_chunk("constrained_bundles", made, bundles);
  visitor.visit_by_chunk("loading_works", works, bundles);
  visitor.visit_by_chunk("constraint_packs", packs, bundles);
  visitor.visit_by_chunk("ties", ties, bundles);
  if (!visitor.replaces()) return;

  visitor.require(works.counts == made.counts, "loading_works", "are not those of the constrained bundles");
  std::vector<Packs> packs_of_chunk;
  packs.for_each(bundles, [&](int /*chunk*/, Packs of) { packs_of_chunk.push_back(of); });
  auto work = works.entries.begin();
  auto next = packs_of_chunk.begin();
  made.for_each(bundles, [&](int chunk, std::span<const int> of_chunk) {
    Packs rest = *next++;
    int last = -1;
    for (const int entry : of_chunk) {
      const int b = bundles[chunk] + entry / 2;
      visitor.require(entry >= 0 && b > last && b < bundles[chunk + 1], "constrained_bundles",
                      "names one that is not there, or not in order");
      last = b;
      const auto count = static_cast<std::size_t>(body_.layout.bundles[b].packs);
      visitor.require(count <= rest.size(), "constraint_packs", "are fewer than the bundles have");
      make(b, entry % 2 == 1, *work, rest.first(count));
      visitor.require(std::isfinite(*work++), "loading_works", "has a work that is not finite");
      rest = rest.subspan(count);
    }
    visitor.require(rest.empty(), "constraint_packs", "are more than the bundles have");
  });
  for (const auto& pack : s.constraint_packs)
    for (int i = 0; i < Dim; ++i)
      for (int lane = 0; lane < kLanes; ++lane)
        visitor.require(
            std::isfinite(pack.prescribed_velocity[i][lane]) && std::isfinite(pack.applied[i][lane]),
            "constraint_packs", "has a velocity or a force that is not finite");
  take_ties(visitor, ties);
  body_.constraints_are_in_order = true;
  place_ties();
}

/// Returns the ties of own bundles: bundle and slots by their numbers in the chunk.
template <int Dim>
ListByChunk<int> Constraints<Dim>::ties_by_chunk() const {
  const ChunkList& bundles = body_.layout.chunks.bundles;
  return ListByChunk<int>::of(bundles, [&](int chunk, std::vector<int>& list) {
    for (const TieOfBundle& tie : body_.made_ties) {
      if (tie.bundle < bundles[chunk] || tie.bundle >= bundles[chunk + 1]) continue;
      list.insert(list.end(),
                  {tie.bundle - bundles[chunk], tie.component, static_cast<int>(tie.slots.size())});
      for (const int slot : tie.slots) list.push_back(slot - first_slot_of(bundles[chunk]));
    }
  });
}

template <int Dim>
void Constraints<Dim>::take_ties(const StateVisitor& visitor, const ListByChunk<int>& ties) {
  const ChunkList& bundles = body_.layout.chunks.bundles;
  body_.made_ties.clear();
  ties.for_each(bundles, [&](int chunk, std::span<const int> numbers) {
    while (!numbers.empty()) {
      visitor.require(numbers.size() >= 3 && numbers[0] >= 0 &&
                          numbers[0] < bundles[chunk + 1] - bundles[chunk] && 0 <= numbers[1] &&
                          numbers[1] < Dim && numbers[2] >= 0 && numbers[2] <= std::ssize(numbers) - 3,
                      "ties", "is no list of ties");
      TieOfBundle& tie =
          body_.made_ties.emplace_back(TieOfBundle{bundles[chunk] + numbers[0], numbers[1], {}});
      for (const int slot : numbers.subspan(3, static_cast<std::size_t>(numbers[2]))) {
        const int first = first_slot_of(bundles[chunk]);
        visitor.require(0 <= slot && slot < slot_of(body_.layout.gridpoint_packs, 0) - first &&
                            is_slot_of(body_, first + slot, tie.bundle),
                        "ties", "names a slot of another bundle");
        tie.slots.push_back(first + slot);
        const int bundle = body_.layout.bundle_of_pack[tie.slots.back() / kLanes];
        visitor.require(body_.arrays.constraints_of_bundle[bundle] >= 0, "ties",
                        "ties a bundle without constraints");
      }
      numbers = numbers.subspan(3 + static_cast<std::size_t>(numbers[2]));
    }
  });
}

template <int Dim>
int Constraints<Dim>::first_slot_of(int bundle) const {
  return slot_of(body_.layout.bundles[bundle].first_pack, 0);
}

template class Constraints<2>;
template class Constraints<3>;

}  // namespace pyroclast
