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
  return 0 <= slot && slot < kLanes * body.layout.gridpoint_packs &&
         body.first_bundle_of(body.layout.bundle_of_pack[slot / kLanes]) == first_bundle;
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

/// Throws Error where constraints or ties of a state from outside name something that is not there, or have
/// numbers that are not finite.
template <int Dim>
void Constraints<Dim>::require_valid(const StateVisitor& visitor) const {
  if (!visitor.checks()) return;
  const auto& s = body_.arrays;
  const auto packs = static_cast<std::int64_t>(s.constraint_packs.size());
  const auto within = [](std::int64_t first, std::int64_t last, std::size_t size) {
    return 0 <= first && first <= last && last <= static_cast<std::int64_t>(size);
  };
  std::size_t made = 0, functions_of_made = 0, tied = 0;
  for (std::size_t b = 0; b < body_.made_constraints.size(); ++b)
    if (body_.made_constraints[b] >= 0) {
      ++made;
      functions_of_made += static_cast<std::size_t>(body_.layout.bundles[b].packs);
    }
  for (const TieOfBundle& tie : body_.made_ties) tied += tie.slots.size();
  visitor.require(s.constraints.size() == made, "constraints", "name others than the bundles that have some");
  visitor.require(s.constraint_packs.size() == functions_of_made, "constraint_packs",
                  "name others than the bundles that have some");
  visitor.require(s.ties.size() == body_.made_ties.size(), "ties", "differ in number from the bundles'");
  visitor.require(s.tied_slots.size() == tied, "tied_slots", "differ in number from the bundles'");
  for (std::size_t b = 0; b < body_.made_constraints.size(); ++b) {
    const int index = body_.made_constraints[b];
    visitor.require(s.constraints_of_bundle[b] < 0 || s.constraints_of_bundle[b] == index,
                    "constraints_of_bundle", "names others than those that were made for it");
    if (index < 0) continue;
    const Bundle& bundle = body_.layout.bundles[b];
    visitor.require(index < static_cast<int>(s.constraints.size()), "made_constraints",
                    "names one that is not there");
    const BundleConstraints& own = s.constraints[index];
    visitor.require(own.first_pack >= 0 && own.first_pack + static_cast<std::int64_t>(bundle.packs) <= packs,
                    "constraints", "names packs that are not there");
    visitor.require(within(own.first_tie, own.last_tie, s.ties.size()), "constraints",
                    "names ties that are not there");
    visitor.require(std::isfinite(own.loading_work), "constraints", "has a work that is not finite");
    for (int i = own.first_tie; i < own.last_tie; ++i) {
      const Tie& tie = s.ties[i];
      visitor.require(within(tie.begin, tie.end, s.tied_slots.size()), "ties",
                      "names slots that are not there");
      visitor.require(0 <= tie.component && tie.component < Dim, "ties", "has no direction of this body");
      for (int j = tie.begin; j < tie.end; ++j)
        visitor.require(is_slot_of(body_, s.tied_slots[j], body_.first_bundle_of(static_cast<int>(b))),
                        "tied_slots", "names a slot of another bundle");
    }
  }
  for (const auto& pack : s.constraint_packs)
    for (int i = 0; i < Dim; ++i)
      for (int lane = 0; lane < kLanes; ++lane)
        visitor.require(
            std::isfinite(pack.prescribed_velocity[i][lane]) && std::isfinite(pack.applied[i][lane]),
            "constraint_packs", "has a velocity or a force that is not finite");
  for (const TieOfBundle& tie : body_.made_ties)
    for (const int slot : tie.slots) {
      visitor.require(is_slot_of(body_, slot, tie.bundle), "ties_of_bundles",
                      "names a slot of another bundle");
      visitor.require(body_.arrays.constraints_of_bundle[body_.layout.bundle_of_pack[slot / kLanes]] >= 0,
                      "ties_of_bundles", "ties a bundle without constraints");
    }
}

template <int Dim>
void Constraints<Dim>::visit_state(StateVisitor& visitor) {
  visitor.visit("made_constraints", body_.made_constraints,
                state::within(-1, kMostOfAKind).of(body_.made_constraints.size()));
  visit_ties(visitor);
  require_valid(visitor);
  if (visitor.replaces()) place_ties();  // so that the step meets the ties that were made, and no others
}

template <int Dim>
void Constraints<Dim>::visit_ties(StateVisitor& visitor) {
  std::vector<int> numbers;
  for (const TieOfBundle& tie : body_.made_ties) {
    numbers.insert(numbers.end(), {tie.bundle, tie.component, static_cast<int>(tie.slots.size())});
    numbers.insert(numbers.end(), tie.slots.begin(), tie.slots.end());
  }
  visitor.visit("ties_of_bundles", numbers, state::within(0, kMostOfAKind));
  if (!visitor.replaces()) return;
  body_.made_ties.clear();
  for (auto i = numbers.begin(); i != numbers.end();) {
    visitor.require(numbers.end() - i >= 3 && i[2] <= numbers.end() - i - 3 && i[1] < Dim &&
                        i[0] < static_cast<int>(body_.layout.bundles.size()),
                    "ties_of_bundles", "is no list of ties");
    const auto slots = i + 3;
    const auto end = slots + i[2];
    body_.made_ties.push_back({i[0], i[1], {slots, end}});
    i = end;
  }
}

template class Constraints<2>;
template class Constraints<3>;

}  // namespace pyroclast
