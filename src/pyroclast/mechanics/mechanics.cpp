#include "pyroclast/mechanics/mechanics.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/mechanics/found/found_contacts.hpp"
#include "pyroclast/mechanics/gone.hpp"
#include "pyroclast/mechanics/torn.hpp"

namespace pyroclast {

namespace {

/// Steps from one look at faces that are to be torn or handed over to the next: whatever the batches, the
/// same steps of a run.
constexpr int kStepsToHandOver = 64;
/// Steps after which masses follow a stiffness that has grown. A face slides little in so many steps.
constexpr int kStepsToFollow = 1024;
static_assert(kStepsToFollow % kStepsToHandOver == 0);
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
  FoundContacts<Dim>::make(body);
  Masses<Dim>(body).measure_stiffness();
  Masses<Dim>(body).set(densities);
  if (body.found) FoundContacts<Dim>(body).begin();
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
  TornFaces<Dim>(body).drain(properties);
  if (body.found) mover_.take_from_owners();  // within `together` a search for pairs has no message
  Ranks& ranks = body.model.ranks();
  const auto seen = ranks.together([&] {
    return std::pair(before_change(),
                     body.creeps() && ranks.any(Properties<Dim>(body).creep_here(properties.creep)));
  });
  UnderChange under_change;
  ranks.together([&] {
    change_properties(seen.first, under_change, [&] {
      if (seen.second) Properties<Dim>(body).begin_creep(properties.creep);
      std::swap(body.properties, properties);
    });
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
  if (body.found) FoundContacts<Dim>(body).forget_gone();
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
  if (body.found) FoundContacts<Dim>(body).follow_properties();
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
void Mechanics<Dim>::commit_creep(const std::function<void()>& look) {
  Body<Dim>& body = *body_;
  Ranks& ranks = body.model.ranks();
  if (body.creep_under_way.empty()) return ranks.together(look);
  if (body.found) mover_.take_from_owners();  // within `together` a search for pairs has no message
  Properties<Dim> of_body(body);
  const auto end = of_body.end_of_creep();
  UnderChange under_change;
  ranks.together([&] {
    const Before before = before_change();
    const double work = end.work.totals(ranks).front();
    if (ranks.has_all()) body.books.creep_work += work;
    change_properties(before, under_change, [&] { of_body.end_creep(end); });
    look();
  });
}

template <int Dim>
typename Mechanics<Dim>::Before Mechanics<Dim>::before_change() const {
  return {held(), totals().work_of_pore_pressure()};
}

/// Changes properties or creep, within Ranks::together: all sums after the change travel in one message.
/// \param before  sums before it; the change may need none of them
/// \param change  makes the change, at one of the calls
template <int Dim>
template <class Change>
void Mechanics<Dim>::change_properties(const Before& before, UnderChange& under_change, Change change) {
  // The ledger counts the work of forces by the trapezoidal rule. So the change is made at the displacements
  // of the last step's forces, and the half step already begun with the old ones is made good.
  Body<Dim>& body = *body_;
  const Ranks& ranks = body.model.ranks();
  Masses<Dim> masses(body);
  auto& [old_force, begun, mass_before] = under_change;
  if (ranks.gives()) change();
  const double pushed = totals().work_of_pore_pressure();
  if (ranks.gives()) {
    old_force = read().forces();
    begun = measure_at_last_forces();
    masses.measure_stiffness();
    mass_before = masses.scale();
  }
  const double held_now = held();
  const double begun_change = chunked_sum(body.layout.chunks.gridpoints, [&](int g) {
    return 0.5 * under_change.begun * dot(read().force(g) - under_change.old_force[g], read().velocity(g));
  });
  const bool are_real = body.parameters.mass == MassChoice::real;
  const double limit = are_real ? masses.real_mass_limit().step / body.parameters.safety : 0.0;
  const MassSums sums = masses.sums(mass_before);
  if (!ranks.has_all()) return;
  body.books.pore_pressure += before.pushed - pushed;
  body.books.property_change += held_now - before.held;
  body.books.begun_property_change -= begun_change;
  masses.take(sums);
  if (are_real && limit < time_step() * (1.0 - 1e-9))
    throw Error(fmt::format(
        "the body got stiffer, at its new temperature or as its faces slid: the time step {:.3g} s of its "
        "real mass is not stable any more (now {:.3g} s); start from a smaller safety, or scale the mass",
        time_step(), limit));
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

/// Returns how many steps may follow before faces whose sides no longer face each other are torn, and broken
/// faces are handed over to found contacts; does with those that are due now.
template <int Dim>
int Mechanics<Dim>::steps_to_hand_over() {
  const bool is_finite = body_->parameters.kinematics == Kinematics::finite;
  if (!is_finite && !body_->found) return std::numeric_limits<int>::max();
  const auto since = static_cast<int>(body_->steps % kStepsToHandOver);
  if (since == 0) {
    if (is_finite) tear_faces();
    if (body_->found) FoundContacts<Dim>(*body_).hand_over();
    if (is_finite && body_->steps > 0 && body_->steps % kStepsToFollow == 0) {
      mover_.take_from_owners();
      Masses<Dim>(*body_).follow_stiffness();
      body_->books.mass_scaling += std::exchange(body_->books.begun_mass_scaling, 0.0);
    }
  }
  return kStepsToHandOver - since;
}

template <int Dim>
void Mechanics<Dim>::tear_faces() {
  Body<Dim>& body = *body_;
  TornFaces<Dim> torn(body);
  const std::vector<int> faces = torn.faces_to_tear();
  if (!body.model.ranks().any(!faces.empty())) return;
  mover_.take_from_owners();  // velocities, which travel when steps are measured
  const double pushed = totals().work_of_pore_pressure();
  torn.tear(faces);
  body.books.pore_pressure += pushed - totals().work_of_pore_pressure();
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
  if (body.parameters.kinematics == Kinematics::finite) TornFaces<Dim>(body).visit_state(visitor);
  if (body.found) FoundContacts<Dim>(body).visit_state(visitor);
  if (!visitor.replaces()) return;
  Masses<Dim>(body).follow_state();
  mover_.take_from_owners();
}

template class Mechanics<2>;
template class Mechanics<3>;

}  // namespace pyroclast
