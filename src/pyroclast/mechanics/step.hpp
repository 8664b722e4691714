#pragma once

#include "pyroclast/mechanics/step_state.hpp"
#include "pyroclast/model/zone_shape.hpp"

/// The step on lanes: gather, law, force, motion. It is compiled once for each instruction set; what a lane
/// is stands in base/lanes.hpp, the physics in material.
namespace pyroclast {

/// \tparam Set  an instruction set of base/lanes.hpp
template <int Dim, class Set>
class Step {
 public:
  // flatten: lanes that cross a call go through memory
  [[gnu::flatten]] static void update_faces(StepState<Dim>& s, int first, int last, bool measure) {
    for (int row = first; row < last; ++row)
      if (s.one_set[row]) {
        const auto& constants = s.contact_constants[s.set_of_faces[row]];
        update_faces_of_row(s, row, measure, [&](int) -> const ContactConstants& { return constants; });
      } else {
        update_faces_of_row(s, row, measure, [&](int point) { return contact_constants(s, row, point); });
      }
  }

  static void move_bundles(StepState<Dim>& s, int first, int last, Pass pass, double* scratch) {
    for (int b = first; b < last; ++b) {
      if (pass == Pass::move)
        move_bundle<Pass::move>(s, b, scratch);
      else if (pass == Pass::move_and_measure)
        move_bundle<Pass::move_and_measure>(s, b, scratch);
      else
        move_bundle<Pass::measure>(s, b, scratch);
    }
  }

 private:
  using Real = Lanes<Set>;
  using Vector = Vec<Dim, Real>;
  using Corners = std::array<Vector, Dim + 1>;

  // Rows of vectors

  static Vector load(const double (&c)[Dim][kLanes]) {
    Vector v;
    for (int i = 0; i < Dim; ++i) v[i] = Real::load(c[i]);
    return v;
  }
  static void store(const Vector& v, double (&c)[Dim][kLanes]) {
    for (int i = 0; i < Dim; ++i) v[i].store(c[i]);
  }
  /// Eight vectors that follow one another.
  static Vector load(const Vec<Dim>* p) {
    Vector v;
    if constexpr (Dim == 2) {
      for (int i = 0; i < Real::kParts; ++i)
        Set::load_pairs(p[i * Set::kWidth].c.data(), v[0].part[i], v[1].part[i]);
    } else {
      alignas(64) double c[Dim][kLanes];
      for (int lane = 0; lane < kLanes; ++lane)
        for (int i = 0; i < Dim; ++i) c[i][lane] = p[lane][i];
      v = load(c);
    }
    return v;
  }
  static void store(const Vector& v, Vec<Dim>* p) {
    if constexpr (Dim == 2) {
      for (int i = 0; i < Real::kParts; ++i)
        Set::store_pairs(p[i * Set::kWidth].c.data(), v[0].part[i], v[1].part[i]);
    } else {
      alignas(64) double c[Dim][kLanes];
      store(v, c);
      for (int lane = 0; lane < kLanes; ++lane)
        for (int i = 0; i < Dim; ++i) p[lane][i] = c[i][lane];
    }
  }
  static Vector gather(const FlatArray<Vec<Dim>>& vectors, const std::array<int, kLanes>& slot) {
    Vector v;
    if constexpr (Dim == 2) {
      for (int i = 0; i < Real::kParts; ++i)
        Set::gather_pairs(vectors.data()->c.data(), slot.data() + i * Set::kWidth, v[0].part[i],
                          v[1].part[i]);
    } else {
      alignas(64) double c[Dim][kLanes];
      for (int lane = 0; lane < kLanes; ++lane)
        for (int i = 0; i < Dim; ++i) c[i][lane] = vectors[slot[lane]][i];
      v = load(c);
    }
    return v;
  }
  static Vector gather(const RowVectors<Dim>& vectors, const std::array<int, kLanes>& slot) {
    alignas(64) double c[Dim][kLanes];
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto& row = vectors.row(slot[lane] / kLanes);
      for (int i = 0; i < Dim; ++i) c[i][lane] = row.c[i][slot[lane] % kLanes];
    }
    return load(c);
  }

  // Contact points

  struct Frame {
    Vector normal;
    std::array<Vector, Dim - 1> tangents;
    Real edge;  ///< length of the edge that turns the frame, m; finite kinematics only
  };

  static ContactConstantsOf<Real> contact_constants(const StepState<Dim>& s, int row, int point) {
    ContactConstantsOf<Real> c;
    const ContactConstants& choices = s.contact_constants[s.set_of_faces[row]];
    c.behaviour = choices.behaviour;
    c.compression = choices.compression;
    c.coupled = choices.coupled;
    const auto& number = s.contact_constants_rows[row * Dim + point].number;
    int i = 0;
    for_each_number(c, [&](Real& value) { value = Real::load(number[i++]); });
    return c;
  }

  static Frame frame_of(const StepState<Dim>& s, const FaceRow<Dim>& face) {
    Frame frame;
    for (int t = 0; t + 1 < Dim; ++t) frame.tangents[t] = load(face.tangent[t]);
    if constexpr (Dim == 2)
      if (s.kinematics == Kinematics::finite) {
        // mean edge of the two sides
        const auto at = [&](const std::array<int, kLanes>& slot) {
          return gather(s.position, slot) + gather(s.displacement, slot);
        };
        const Vector edge = ((at(face.a[1]) - at(face.a[0])) + (at(face.b[1]) - at(face.b[0]))) * Real(0.5);
        frame.edge = norm(edge);
        const Vector t = edge * (1.0 / frame.edge);
        frame.tangents[0] = t;
      }
    if constexpr (Dim == 2)
      frame.normal = {{frame.tangents[0][1], -frame.tangents[0][0]}};
    else
      frame.normal = cross(frame.tangents[0], frame.tangents[1]);
    return frame;
  }

  /// Contact points of eight shared faces: jumps to tractions to forces, Eqs. (10)-(15).
  template <class ConstantsOf>
  static void update_faces_of_row(StepState<Dim>& s, int row, bool measure, ConstantsOf constants) {
    const FaceRow<Dim>& face = s.layout->faces[row];
    const Frame frame = frame_of(s, face);
    const Real area = Real::load(face.area);
    Real turning = 0.0;
    Real stored = 0.0, applied = 0.0, widest = 0.0;
    for (int point = 0; point < Dim; ++point) {
      const int at = row * Dim + point;
      const Vector jump = gather(s.displacement, face.b[point]) - gather(s.displacement, face.a[point]);
      const Real opening = dot(jump, frame.normal);
      Tangential<Dim, Real> tangential;
      for (int t = 0; t + 1 < Dim; ++t) tangential[t] = dot(jump, frame.tangents[t]);
      const auto response = update_history(s, at, constants(point), opening, tangential);
      Vector force = frame.normal * (response.normal_traction * area);
      for (int t = 0; t + 1 < Dim; ++t) force += frame.tangents[t] * (response.shear_traction[t] * area);
      store(force, &s.contact_force[slot_of(at, 0)]);
      if (s.kinematics == Kinematics::finite)
        turning += response.shear_traction[0] * opening - response.normal_traction * tangential[0];
      if (measure) {
        stored += response.stored * area;
        applied += 2.0 * norm(force);  // on both sides
        widest = larger(widest, norm(jump));
      }
    }
    if constexpr (Dim == 2)
      if (s.kinematics == Kinematics::finite) add_turning_forces(s, row, frame, turning * area);
    if (measure) {
      FaceSums& sums = s.face_sums[row];
      sums.stored = sum(stored);
      sums.applied = sum(applied);
      const Real length = Dim == 2 ? area * (Dim / s.thickness) : sqrt(area * (2.0 * Dim));
      sums.jump = largest(select(area > 0.0, widest / length, 0.0));
    }
  }

  template <class Constants>
  static ContactResponse<Dim, Real> update_history(StepState<Dim>& s, int at, const Constants& constants,
                                                   const Real& opening,
                                                   const Tangential<Dim, Real>& tangential) {
    HistoryRow<Dim>& row = s.history[at];
    ContactHistory<Dim, Real> h;
    h.tension_damage = Real::load(row.tension_damage);
    h.shear_damage = Real::load(row.shear_damage);
    h.closure = Real::load(row.closure);
    for (int t = 0; t + 1 < Dim; ++t) h.slip[t] = Real::load(row.slip[t]);
    h.held_slip = Real::load(row.held_slip);
    const auto response = update_contact<Dim>(constants, opening, tangential, h);
    for (int t = 0; t + 1 < Dim; ++t) h.slip[t].store(row.slip[t]);
    h.held_slip.store(row.held_slip);
    if (response.damaged) {
      h.tension_damage.store(row.tension_damage);
      h.shear_damage.store(row.shear_damage);
      h.closure.store(row.closure);
      add_losses(s.loss[at], response);
    }
    return response;
  }

  static void add_losses(LossRow& loss, const ContactResponse<Dim, Real>& response) {
    const auto add = [](double* row, const Real& more) { (Real::load(row) + more).store(row); };
    add(loss.slipped, response.slipped);
    add(loss.tension, response.dissipated.tension);
    add(loss.shear, response.dissipated.shear);
    add(loss.friction, response.dissipated.friction);
    add(loss.compression, response.dissipated.compression);
  }

  /// Where the frame turns with the edge, so do the components of a jump. The forces that do the work of the
  /// tractions on that part keep moments in balance: minus the derivative of the jump's components by the
  /// edge's gridpoints.
  static void add_turning_forces(StepState<Dim>& s, int row, const Frame& frame, const Real& turning) {
    const Vector force = frame.normal * (0.5 * turning / frame.edge);
    store(force, &s.turning_force[slot_of(row * Dim, 0)]);
    store(-force, &s.turning_force[slot_of(row * Dim + 1, 0)]);
  }

  // Bundles

  /// Displacements and sums of forces of a bundle while it is in hand.
  struct Scratch {
    VectorRow<Dim>* displacement;
    VectorRow<Dim>* force;
  };

  struct Sums {
    Real stored = 0.0, kinetic = 0.0, applied = 0.0, unbalanced = 0.0;
    Real damping = 0.0, viscous = 0.0, begun_damping = 0.0, begun_viscous = 0.0;
    Real loading = 0.0, begun_loading = 0.0;
  };

  template <Pass kPass>
  [[gnu::flatten]] static void move_bundle(StepState<Dim>& s, int index, double* memory) {
    const Bundle& bundle = s.layout->bundles[index];
    auto* rows = reinterpret_cast<VectorRow<Dim>*>(memory);
    const Scratch scratch{rows, rows + bundle.rows};
    constexpr bool kMeasure = kPass != Pass::move;
    Sums sums;
    for (int i = 0; i < bundle.rows; ++i) {
      const int row = bundle.first_row + i;
      store(load(&s.displacement[slot_of(row, 0)]), scratch.displacement[i].c);
      store(contact_forces(s, row), scratch.force[i].c);
    }
    if (bundle.kind == BundleKind::alike)
      add_forces_of_alike_zones<kMeasure>(s, index, bundle, scratch, sums);
    else
      add_forces_of_spread_zones<kMeasure>(s, index, bundle, scratch, sums);
    if (s.constraints_of_bundle[index] >= 0) {
      auto& constraints = s.constraints[s.constraints_of_bundle[index]];
      load_bundle<kMeasure>(s, bundle, constraints, scratch, sums);
      for (int i = 0; i < bundle.rows; ++i) move_row<kPass, true>(s, bundle, i, &constraints, scratch, sums);
    } else {
      for (int i = 0; i < bundle.rows; ++i) move_row<kPass, false>(s, bundle, i, nullptr, scratch, sums);
    }
    keep<kPass>(s, index, sums);
  }

  template <Pass kPass>
  static void keep(StepState<Dim>& s, int index, const Sums& sums) {
    BundleSums& kept = s.bundle_sums[index];
    if constexpr (kPass != Pass::measure) {
      kept.damping_work += sum(sums.damping);
      if (s.viscous_damping != 0.0) kept.viscous_work += sum(sums.viscous);
      if (const int c = s.constraints_of_bundle[index]; c >= 0)
        s.constraints[c].loading_work += sum(sums.loading);
    }
    if constexpr (kPass == Pass::move_and_measure) {
      kept.begun_damping = sum(sums.begun_damping);
      kept.begun_viscous = sum(sums.begun_viscous);
      kept.begun_loading = sum(sums.begun_loading);
      kept.kinetic = sum(sums.kinetic);
    }
    if constexpr (kPass != Pass::move) {
      kept.stored = sum(sums.stored);
      kept.applied = sum(sums.applied);
      kept.unbalanced = sum(sums.unbalanced);
    }
  }

  static Vector contact_forces(const StepState<Dim>& s, int row) {
    const ContactsOfRow range = s.layout->contacts_of_row[row];
    Vector total{};
    for (int k = range.begin; k < range.end; ++k) {
      const ActingContacts& acting = s.layout->acting[k];
      const Vector force = gather(s.contact_force, acting.contact);
      const auto side_b = Real::Truth::from_bits(acting.side_b);
      for (int i = 0; i < Dim; ++i) total[i] += select(side_b, -force[i], force[i]);
      if (s.kinematics == Kinematics::finite) total += gather(s.turning_force, acting.contact);
    }
    return total;
  }

  static ZonePropertiesOf<Real> zone_properties(const StepState<Dim>& s, int index, int zone_row) {
    const ZonePropertyRow& row = s.zone_properties[s.by_bundle ? index : zone_row];
    return {Real::load(row.lambda), Real::load(row.mu), Real::load(row.thermal_strain)};
  }

  /// Forces of eight zones on their gridpoints: internal, Eqs. (4) and (5), and weight.
  /// \return their volumes, m³
  static Real zone_forces(const StepState<Dim>& s, const Corners& x, const Corners& u,
                          const ZonePropertiesOf<Real>& properties, const Real& density, Corners& force,
                          Real& stored) {
    std::array<Vector, Dim> gradient;
    const Real volume = shape_gradients(x, gradient) * s.thickness;
    Rotation<Real> rotation;
    const auto strain =
        mechanical_strain<Dim>(gradient, u, properties.thermal_strain, s.kinematics, rotation);
    const auto stress = zone_stress<Dim>(properties, strain);
    stored = energy_density<Dim>(stress, strain) * volume;
    SymmetricTensor<Dim, Real> whole;  // stress times volume
    for (std::size_t i = 0; i < stress.size(); ++i) whole[i] = stress[i] * volume;
    for (int n = 0; n < Dim; ++n) {
      Vector f = apply<Dim>(whole, gradient[n]);
      if constexpr (Dim == 2)
        if (s.kinematics == Kinematics::finite) f = rotated<Dim>(rotation, f);
      force[n] = -f;
      force[Dim] = n == 0 ? f : force[Dim] + f;
    }
    (void)density;
    return volume;
  }

  template <bool kMeasure>
  static void measure_zones(const StepState<Dim>& s, const Corners& force, const Real& stored,
                            const Real& mass, Sums& sums, const typename Real::Truth& used) {
    if constexpr (kMeasure) {
      Real applied = mass * norm(s.gravity);
      for (const auto& f : force) applied += norm(f);
      sums.stored += select(used, stored, 0.0);
      sums.applied += select(used, applied, 0.0);
    }
  }

  static void add_weight(const StepState<Dim>& s, const Real& mass, Corners& force) {
    const Real share = mass * (1.0 / (Dim + 1));
    for (int i = 0; i < Dim; ++i)
      if (s.gravity[i] != 0.0)
        for (auto& f : force) f[i] += share * s.gravity[i];
  }

  template <bool kMeasure>
  static void add_forces_of_alike_zones(StepState<Dim>& s, int index, const Bundle& bundle,
                                        const Scratch& scratch, Sums& sums) {
    const auto& zones = s.layout->shapes[bundle.shape];
    const Real density = Real::load(&s.density[slot_of(index, 0)]);
    const auto everyone = Real::Truth::from_bits(0xFF);
    for (int z = 0; z < bundle.zones; ++z) {
      const auto& corner = zones[z];
      Corners x, u, force;
      for (int n = 0; n <= Dim; ++n) {
        x[n] = load(s.position.row(bundle.first_row + corner[n]).c);
        u[n] = load(scratch.displacement[corner[n]].c);
      }
      Real stored;
      const Real volume =
          zone_forces(s, x, u, zone_properties(s, index, bundle.first_zone_row + z), density, force, stored);
      const Real mass = density * volume;
      measure_zones<kMeasure>(s, force, stored, mass, sums, everyone);
      add_weight(s, mass, force);
      for (int n = 0; n <= Dim; ++n) {
        auto& sum_of_forces = scratch.force[corner[n]].c;
        store(load(sum_of_forces) + force[n], sum_of_forces);
      }
    }
  }

  template <bool kMeasure>
  static void add_forces_of_spread_zones(StepState<Dim>& s, int index, const Bundle& bundle,
                                         const Scratch& scratch, Sums& sums) {
    const Real density = Real::load(&s.density[slot_of(index, 0)]);
    for (int z = 0; z < bundle.zone_rows(); ++z) {
      const int used = bundle.zones - kLanes * z < kLanes ? bundle.zones - kLanes * z : kLanes;
      const auto& corner = s.layout->spread_zones[bundle.first_spread_row + z].slot;
      Corners x, u, force;
      for (int n = 0; n <= Dim; ++n) {
        x[n] = gather(s.position, corner[n]);
        u[n] = gather(s.displacement, corner[n]);
      }
      Real stored;
      const Real volume =
          zone_forces(s, x, u, zone_properties(s, index, bundle.first_zone_row + z), density, force, stored);
      const Real mass = density * volume;
      measure_zones<kMeasure>(s, force, stored, mass, sums, Real::Truth::from_bits((1U << used) - 1U));
      add_weight(s, mass, force);
      // one lane after the other: zones of a row may share gridpoints
      for (int n = 0; n <= Dim; ++n) {
        alignas(64) double f[Dim][kLanes];
        store(force[n], f);
        for (int lane = 0; lane < used; ++lane) {
          const int slot = corner[n][lane] - slot_of(bundle.first_row, 0);
          for (int i = 0; i < Dim; ++i) scratch.force[slot / kLanes].c[i][slot % kLanes] += f[i][lane];
        }
      }
    }
  }

  /// Adds applied forces and shares out the sum (4) where gridpoints are tied.
  template <bool kMeasure>
  static void load_bundle(StepState<Dim>& s, const Bundle& bundle, const Constraints<Dim>& constraints,
                          const Scratch& scratch, Sums& sums) {
    for (int i = 0; i < bundle.rows; ++i) {
      const Vector applied = load(constraints.applied.row(i).c);
      store(load(scratch.force[i].c) + applied, scratch.force[i].c);
      if constexpr (kMeasure) sums.applied += norm(applied);
    }
    for (const Tie& tie : constraints.ties) {
      const auto force = [&](int slot) -> double& {
        const int own = slot - slot_of(bundle.first_row, 0);
        return scratch.force[own / kLanes].c[tie.component][own % kLanes];
      };
      double total = 0.0, mass = 0.0;
      for (int slot : tie.slots) {
        total += force(slot);
        mass += s.time_step / s.step_over_mass[slot];
      }
      for (int slot : tie.slots) force(slot) = total * (s.time_step / s.step_over_mass[slot]) / mass;
    }
  }

  /// -1, 0 or 1.
  static Real sign(const Real& x) {
    return select(x > 0.0, Real(1.0), select(x < 0.0, Real(-1.0), Real(0.0)));
  }

  /// Damps the sum of forces (8) and integrates velocity and displacement (6), (7).
  template <Pass kPass, bool kConstrained>
  static void move_row(StepState<Dim>& s, const Bundle& bundle, int i, const Constraints<Dim>* constraints,
                       const Scratch& scratch, Sums& sums) {
    constexpr bool kMeasure = kPass != Pass::move;
    const int row = bundle.first_row + i;
    const Vector force = load(scratch.force[i].c);
    if constexpr (kMeasure) {
      Vector free = force;
      if constexpr (kConstrained)
        for (int j = 0; j < Dim; ++j)
          free[j] = select(Real::Truth::from_bits(constraints->prescribed[i][j]), Real(0.0), free[j]);
      sums.unbalanced += norm(free);
    }
    if constexpr (kPass == Pass::measure) {
      store(force, s.force.row(row).c);
      return;
    }
    const double dt = s.time_step;
    const double kept = 1.0 - 0.5 * s.viscous_damping * dt;
    const double over = 1.0 / (1.0 + 0.5 * s.viscous_damping * dt);
    const bool combined = s.damping_form == DampingForm::combined;
    const Real step_over_mass = Real::load(&s.step_over_mass[slot_of(row, 0)]);
    const Vector before = load(s.velocity.row(row).c);
    Vector after;
    for (int j = 0; j < Dim; ++j) {
      Real opposing = sign(before[j]);
      if (combined) opposing = 0.5 * (opposing - sign(force[j] - Real::load(s.force.row(row).c[j])));
      Real damping = s.local_damping * abs(force[j]) * opposing;
      after[j] = before[j] + (force[j] - damping) * step_over_mass;
      if (s.viscous_damping != 0.0)
        after[j] = (kept * before[j] + (force[j] - damping) * step_over_mass) * over;
      if constexpr (kConstrained) {
        const auto prescribed = Real::Truth::from_bits(constraints->prescribed[i][j]);
        after[j] = select(prescribed, Real::load(constraints->prescribed_velocity.row(i).c[j]), after[j]);
        damping = select(prescribed, Real(0.0), damping);
        const Real reaction = (after[j] - before[j]) / step_over_mass - force[j];
        const Real loading =
            Real::load(constraints->applied.row(i).c[j]) + select(prescribed, reaction, Real(0.0));
        sums.loading += loading * (before[j] + after[j]) * (0.5 * dt);
        if constexpr (kMeasure) sums.begun_loading += loading * after[j] * (0.5 * dt);
      }
      sums.damping += damping * (before[j] + after[j]) * (0.5 * dt);
      if constexpr (kMeasure) sums.begun_damping += damping * after[j] * (0.5 * dt);
      if (s.viscous_damping != 0.0) {
        Real drag = s.viscous_damping * dt * 0.5 * (before[j] + after[j]) / step_over_mass;
        if constexpr (kConstrained)
          drag = select(Real::Truth::from_bits(constraints->prescribed[i][j]), Real(0.0), drag);
        sums.viscous += drag * (before[j] + after[j]) * (0.5 * dt);
        if constexpr (kMeasure) sums.begun_viscous += drag * after[j] * (0.5 * dt);
      }
    }
    if constexpr (kMeasure) sums.kinetic += dot(before, after) * (0.5 * dt) / step_over_mass;
    store(force, s.force.row(row).c);
    store(after, s.velocity.row(row).c);
    store(load(scratch.displacement[i].c) + after * dt, &s.displacement[slot_of(row, 0)]);
  }
};

}  // namespace pyroclast
