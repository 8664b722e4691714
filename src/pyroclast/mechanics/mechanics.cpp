#include "pyroclast/mechanics/mechanics.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/mechanics/found/found_contacts.hpp"
#include "pyroclast/mechanics/gone.hpp"

namespace pyroclast {

namespace {

/// Steps from one hand-over of broken faces to the next: whatever the batches, the same steps of a run.
constexpr int kStepsToHandOver = 64;
/// Largest ratio between the time steps of a body and of a state that it takes over.
constexpr double kSameStep = 2.0;

}  // namespace

template <int Dim>
Mechanics<Dim>::Mechanics(const ModelOf<Dim>& model, const std::vector<double>& densities,
                          BodyProperties properties, const MechanicsParameters& parameters,
                          std::shared_ptr<Team> team)
    : body_(std::make_unique<Body<Dim>>(model, std::move(properties), parameters, std::move(team))),
      mover_(*body_) {
  Body<Dim>& body = *body_;
  Properties<Dim>(body).place();
  if constexpr (Dim == 2) FoundContacts::make(body);
  Masses<Dim>(body).measure_stiffness();
  Masses<Dim>(body).set(densities);
  if constexpr (Dim == 2)
    if (body.found) FoundContacts(body).begin();
  mover_.sweep(1, Pass::measure);
  // no force has acted yet
  std::fill(body.arrays.force.begin(), body.arrays.force.end(), VectorPack<Dim>{});
  body.books.property_change = totals().energy().zones;  // the body may begin with thermal strains
}

template <int Dim>
BodyProperties Mechanics<Dim>::set_properties(BodyProperties properties) {
  commit_creep();
  Body<Dim>& body = *body_;
  if (!properties.creep.empty() && !body.creeps())
    throw Error("a body made of materials that do not creep cannot begin to creep");
  GoneBlocks<Dim>(body).leave_out_of(properties);
  Ranks& ranks = body.model.ranks();
  change_properties(
      [&] { return body.creeps() && ranks.any(Properties<Dim>(body).creep_here(properties.creep)); },
      [&](bool creep) {
        if (creep) Properties<Dim>(body).begin_creep(properties.creep);
        std::swap(body.properties, properties);
      });
  return properties;
}

template <int Dim>
void Mechanics<Dim>::remove(const std::vector<int>& blocks) {
  if (blocks.empty()) return;
  Body<Dim>& body = *body_;
  if (!body.parameters.loses_blocks) throw Error("this body was made to keep its blocks");
  commit_creep();
  GoneBlocks<Dim> gone(body);
  gone.book(blocks);
  const double held_before = held(), pushed_before = totals().work_of_pore_pressure();
  const auto old_force = read().forces(), velocity = read().velocities();
  gone.remove(blocks);
  if constexpr (Dim == 2)
    if (body.found) FoundContacts(body).forget_gone();
  body.books.pore_pressure += pushed_before - totals().work_of_pore_pressure();
  const double begun = measure_at_last_forces();
  body.books.removed += held_before - held();
  body.books.begun_removed += chunked_sum(body.layout.chunks.gridpoints, [&](int g) {
    return 0.5 * begun * dot(read().force(g) - old_force[g], velocity[g]);
  });
  Masses<Dim>(body).forget_gone();
}

/// Returns the energy that zones and contacts hold or have lost, J.
template <int Dim>
double Mechanics<Dim>::held() const {
  const EnergyLedger energy = totals().energy();
  return energy.zones + energy.contacts + energy.dissipated.total();
}

/// Puts changed properties in their places, and takes the forces anew at the displacements at which the last
/// step took them. Returns the time by which positions have run ahead of these, s.
template <int Dim>
double Mechanics<Dim>::measure_at_last_forces() {
  Body<Dim>& body = *body_;
  Properties<Dim>(body).place();
  if constexpr (Dim == 2)
    if (body.found) FoundContacts(body).follow_properties();
  auto& displacement = body.arrays.displacement;
  const auto next = displacement;
  const double begun = body.steps > 0 ? time_step() : 0.0;
  for (std::size_t slot = 0; slot < next.size(); ++slot)
    displacement[slot] -= vector_at<Dim>(body.state.velocity, static_cast<int>(slot)) * begun;
  mover_.sweep(1, Pass::measure);
  std::copy(next.begin(), next.end(), displacement.begin());
  return begun;
}

template <int Dim>
void Mechanics<Dim>::commit_creep() {
  if (body_->creep_under_way.empty()) return;
  Properties<Dim> of_body(*body_);
  const auto end = of_body.end_of_creep();
  change_properties([&] { return end.work.totals(body_->model.ranks()).front(); },
                    [&](double work) { of_body.end_creep(end, work); });
}

/// All sums before the change travel in one message, and all sums after it.
/// \param before  function that reads what the change needs of all ranks
/// \param change  function that takes it and changes properties or creep
template <int Dim>
template <class Before, class Change>
void Mechanics<Dim>::change_properties(Before before, Change change) {
  // The ledger counts the work of forces by the trapezoidal rule. So the change is made at the displacements
  // of the last step's forces, and the half step already begun with the old ones is made good.
  Body<Dim>& body = *body_;
  Ranks& ranks = body.model.ranks();
  struct Seen {
    double held, pushed;
    decltype(before()) for_change;
  };
  const Seen seen = ranks.together([&] { return Seen{held(), totals().work_of_pore_pressure(), before()}; });
  change(seen.for_change);
  body.books.pore_pressure += seen.pushed - totals().work_of_pore_pressure();
  const auto old_force = read().forces();
  const double begun = measure_at_last_forces();

  Masses<Dim> masses(body);
  masses.measure_stiffness();
  const std::vector<double> mass_before = masses.scale();
  struct After {
    double held, begun_change, limit;
    MassSums of_masses;
  };
  const bool are_real = body.parameters.mass == MassChoice::real;
  const After after = ranks.together([&] {
    return After{
        held(),
        chunked_sum(
            body.layout.chunks.gridpoints,
            [&](int g) { return 0.5 * begun * dot(read().force(g) - old_force[g], read().velocity(g)); }),
        are_real ? masses.real_mass_limit().step / body.parameters.safety : 0.0, masses.sums(mass_before)};
  });
  body.books.property_change += after.held - seen.held;
  body.books.begun_property_change -= after.begun_change;
  masses.take(after.of_masses);
  if (are_real && after.limit < time_step() * (1.0 - 1e-9))
    throw Error(fmt::format(
        "the body got stiffer at its new temperature: the time step {:.3g} s of its real mass is not stable "
        "any more (now {:.3g} s); start from a smaller safety, or scale the mass",
        time_step(), after.limit));
}

template <int Dim>
void Mechanics<Dim>::begin_moving(const std::vector<Vec<Dim>>& velocities) {
  Body<Dim>& body = *body_;
  const auto energy = [&](int g) { return 0.5 * body.mass[g] * dot(velocities[g], velocities[g]); };
  for (int g = 0; g < std::ssize(velocities); ++g) {
    const int slot = body.layout.gridpoint_slot[g];
    set_vector<Dim>(body.state.velocity, slot, velocities[g]);
    body.arrays.bundle_sums[body.layout.bundle_of_pack[slot / kLanes]].kinetic += energy(g);
  }
  body.books.start = chunked_sum(body.layout.chunks.gridpoints, energy);
}

template <int Dim>
void Mechanics<Dim>::advance(int steps) {
  if (steps <= 0) return;
  Body<Dim>& body = *body_;
  constraints().order();
  body.books.property_change += std::exchange(body.books.begun_property_change, 0.0);
  body.books.mass_scaling += std::exchange(body.books.begun_mass_scaling, 0.0);
  body.books.removed += std::exchange(body.books.begun_removed, 0.0);
  for (int left = steps; left > 0;) {
    const int now = std::min(left, steps_to_hand_over());
    left -= now;
    const int moved = left > 0 ? now : now - 1;
    if (moved > 0) mover_.sweep(moved, Pass::move);
    if (left == 0) mover_.sweep(1, Pass::move_and_measure);
    body.steps += now;
  }
}

/// Returns how many steps may follow before broken faces are handed over to found contacts, and hands over
/// those that are due now.
template <int Dim>
int Mechanics<Dim>::steps_to_hand_over() {
  if constexpr (Dim == 2)
    if (body_->found) {
      const auto since = static_cast<int>(body_->steps % kStepsToHandOver);
      if (since == 0) FoundContacts(*body_).hand_over();
      return kStepsToHandOver - since;
    }
  return std::numeric_limits<int>::max();
}

template <int Dim>
void Mechanics<Dim>::visit_state(StateVisitor& visitor) {
  Body<Dim>& body = *body_;
  constraints().order();
  if (visitor.replaces()) body.forget();
  visitor.visit("steps", body.steps, state::count());
  // with real mass the step was fixed when the run began; this body is made like that beginning
  visitor.visit("time_step", body.state.time_step,
                state::within(body.state.time_step / kSameStep, body.state.time_step * kSameStep));
  visitor.visit("property_change", body.books.property_change);
  visitor.visit("mass_scaling", body.books.mass_scaling);
  visitor.visit("begun_property_change", body.books.begun_property_change);
  visitor.visit("begun_mass_scaling", body.books.begun_mass_scaling);
  visitor.visit("creep_work", body.books.creep_work);
  if (body.has_pore_pressure()) visitor.visit("pore_pressure_work", body.books.pore_pressure);
  visitor.visit("start", body.books.start);
  if (visitor.replaces()) body.leave_none_out();
  if (body.parameters.loses_blocks) GoneBlocks<Dim>(body).visit_state(visitor);
  // the stiffness is that of the contact frames at the last change of properties; they have turned since
  visitor.visit_by_chunk("stiffness", body.stiffness, body.layout.chunks.gridpoints, state::at_least(0));
  body.visit_arrays(visitor);
  constraints().visit_state(visitor);
  Properties<Dim>(body).visit_state(visitor);
  if constexpr (Dim == 2)
    if (body.found) FoundContacts(body).visit_state(visitor);
  if (!visitor.replaces()) return;
  Masses<Dim>(body).follow_state();
  mover_.take_from_owners();
}

template class Mechanics<2>;
template class Mechanics<3>;

}  // namespace pyroclast
