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
  static void update_faces(StepState<Dim>& s, int first, int last, bool measure) {
    with_kinematics(s, [&](auto kinematics) {
      if (measure)
        update_rows<kinematics(), true>(s, first, last);
      else
        update_rows<kinematics(), false>(s, first, last);
    });
  }

  static void move_bundles(StepState<Dim>& s, int first, int last, Pass pass, double* scratch) {
    with_kinematics(s, [&](auto kinematics) {
      for (int b = first; b < last; ++b) {
        if (pass == Pass::move) {
          move_bundle<kinematics(), Pass::move>(s, b, scratch);
        } else if (pass == Pass::move_and_measure) {
          move_bundle<kinematics(), Pass::move_and_measure>(s, b, scratch);
        } else {
          move_bundle<kinematics(), Pass::measure>(s, b, scratch);
        }
      }
    });
  }

  /// Sums of |stiffness| over the rows of the assembled matrix, zones and contacts, N/m.
  static void sum_stiffness(StepState<Dim>& s, double* memory) {
    with_kinematics(s, [&](auto kinematics) { sum_stiffness_of<kinematics()>(s, memory); });
  }

  // The parts of a step, open so that each can be timed alone.

  using Real = Lanes<Set>;
  using Vector = Vec<Dim, Real>;
  using Corners = std::array<Vector, Dim + 1>;

  /// Takes rows of faces through a step.
  // flatten: lanes that cross a call go through memory
  template <Kinematics kKinematics, bool kMeasure>
  [[gnu::flatten]] static void update_rows(StepState<Dim>& s, int first, int last) {
    for (int row = first; row < last; ++row) {
      fetch_faces_ahead(s, row);
      if (s.one_set[row]) {
        const auto& constants = s.contact_constants[s.set_of_faces[row]];
        update_faces_of_row<kKinematics, kMeasure>(s, row,
                                                   [&](int) -> const ContactConstants& { return constants; });
      } else {
        update_faces_of_row<kKinematics, kMeasure>(
            s, row, [&](int point) { return contact_constants(s, row, point); });
      }
    }
  }

  /// Displacements and sums of forces of a bundle while it is in hand, a row for each of its rows.
  struct Scratch {
    VectorRow<Dim>* displacement;
    VectorRow<Dim>* sum;
  };
  /// \param memory  as of move_bundles
  static Scratch scratch_of(const Bundle& bundle, double* memory) {
    auto* rows = reinterpret_cast<VectorRow<Dim>*>(memory);
    return {rows, rows + bundle.rows};
  }

  /// What a step books, still lane by lane.
  struct Sums {
    Real stored = 0.0, kinetic = 0.0, applied = 0.0, unbalanced = 0.0;
    Real damping = 0.0, viscous = 0.0, begun_damping = 0.0, begun_viscous = 0.0;
    Real loading = 0.0, begun_loading = 0.0;
  };

  /// Takes the displacements of a bundle in hand.
  static void take_displacements(const StepState<Dim>& s, const Bundle& bundle, const Scratch& scratch) {
    for (int i = 0; i < bundle.rows; ++i)
      store(load(&s.displacement[slot_of(bundle.first_row + i, 0)]), scratch.displacement[i].c);
  }

  /// Begins the sums of forces of a bundle with weights and contact forces.
  template <Kinematics kKinematics, bool kMeasure>
  static void sum_outer_forces(const StepState<Dim>& s, const Bundle& bundle, const Scratch& scratch,
                               Sums& sums) {
    const bool weighs = s.weighs();
    const Vec<Dim> gravity = s.gravity;
    for (int i = 0; i < bundle.rows; ++i) {
      const int row = bundle.first_row + i;
      fetch_ahead(s, s.force, row);
      Vector total{};
      if (weighs) {
        const Real mass = Real::load(&s.real_mass[slot_of(row, 0)]);
        for (int j = 0; j < Dim; ++j) total[j] = mass * gravity[j];
        if constexpr (kMeasure) sums.applied += norm(total);
      }
      store(add_contacts<kKinematics, true>(s, row, total), scratch.sum[i].c);
    }
  }

  /// Adds the forces of a bundle's zones.
  template <Kinematics kKinematics, bool kMeasure>
  static void add_zone_forces(const StepState<Dim>& s, int index, const Scratch& scratch, Sums& sums) {
    const double thickness = s.thickness;
    add_over_zones(s, index, scratch,
                   [&](const Corners& x, const Corners& u, const auto& properties, const auto& used) {
                     return zone_forces<kKinematics, kMeasure>(thickness, x, u, properties, used, sums);
                   });
  }

  /// Moves the gridpoints of a bundle under the sums of forces.
  template <Pass kPass>
  static void move_rows(StepState<Dim>& s, int index, const Scratch& scratch, Sums& sums) {
    const Bundle& bundle = s.layout->bundles[index];
    const Motion motion(s);
    if (const int c = s.constraints_of_bundle[index]; c >= 0) {
      for (int i = 0; i < bundle.rows; ++i)
        move_row<kPass, true>(s, motion, bundle, i, &s.constraints[c], scratch, sums);
    } else {
      for (int i = 0; i < bundle.rows; ++i)
        move_row<kPass, false>(s, motion, bundle, i, nullptr, scratch, sums);
    }
  }

  /// Books the sums of a bundle.
  template <Pass kPass>
  static void keep(StepState<Dim>& s, int index, const Sums& sums) {
    BundleSums& kept = s.bundle_sums[index];
    if constexpr (kPass != Pass::measure) {
      kept.damping_work += sum(sums.damping) * (0.5 * s.time_step);
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

 private:
  /// Calls `f` with the body's kinematics as a constant.
  template <class F>
  static void with_kinematics(const StepState<Dim>& s, F f) {
    if constexpr (Dim == 2)
      if (s.kinematics == Kinematics::finite)
        return f(std::integral_constant<Kinematics, Kinematics::finite>());
    f(std::integral_constant<Kinematics, Kinematics::small>());
  }

  template <Kinematics kKinematics>
  [[gnu::flatten]] static void sum_stiffness_of(StepState<Dim>& s, double* memory) {
    for (int row = 0; row < s.layout->face_rows(); ++row) {
      const auto& face = s.layout->faces[row];
      const Real area = Real::load(face.area);
      const Frame frame = frame_of<kKinematics>(s, face);
      for (int point = 0; point < Dim; ++point)
        store(s.one_set[row] ? contact_stiffness(s.contact_constants[s.set_of_faces[row]], frame.normal, area)
                             : contact_stiffness(contact_constants(s, row, point), frame.normal, area),
              &s.contact_force[slot_of(row * Dim + point, 0)]);
    }
    for (int index = 0; index < static_cast<int>(s.layout->bundles.size()); ++index) {
      const Bundle& bundle = s.layout->bundles[index];
      const Scratch scratch = scratch_of(bundle, memory);
      for (int i = 0; i < bundle.rows; ++i)
        store(add_contacts<kKinematics, false>(s, bundle.first_row + i, Vector{}), scratch.sum[i].c);
      add_over_zones(s, index, scratch, [&](const Corners& x, const Corners&, const auto& p, const auto&) {
        return zone_stiffness(s, x, p);
      });
      for (int i = 0; i < bundle.rows; ++i)
        store(load(scratch.sum[i].c), s.stiffness.row(bundle.first_row + i).c);
    }
  }

  // Asking the memory ahead. Processors foresee streams badly between so much arithmetic; lines come best a
  // few at a time, all through the step.

  static constexpr int kRowsAhead = 16;     ///< of gridpoints
  static constexpr int kFaceRowsAhead = 8;  ///< about as far

  template <std::size_t kBytes>
  static void fetch(const void* begin) {
    for (std::size_t i = 0; i < kBytes; i += 64) __builtin_prefetch(static_cast<const char*>(begin) + i);
  }
  static void fetch_ahead(const StepState<Dim>& s, const RowVectors<Dim>& vectors, int row) {
    const int ahead = row + kRowsAhead;
    if (ahead < s.layout->gridpoint_rows) fetch<sizeof(VectorRow<Dim>)>(&vectors.row(ahead));
  }
  static void fetch_ahead(const StepState<Dim>& s, const FlatArray<double>& numbers, int row) {
    const int ahead = row + kRowsAhead;
    if (ahead < s.layout->gridpoint_rows) fetch<kLanes * sizeof(double)>(&numbers[slot_of(ahead, 0)]);
  }
  /// What a row of faces needs, and the displacements that none before it reads.
  static void fetch_faces_ahead(const StepState<Dim>& s, int row) {
    const Layout<Dim>& layout = *s.layout;
    const int ahead = row + kFaceRowsAhead;
    if (ahead >= layout.face_rows()) return;
    fetch<sizeof(FaceRow<Dim>)>(&layout.faces[ahead]);
    fetch<Dim * sizeof(HistoryRow<Dim>)>(&s.history[ahead * Dim]);
    for (int point = ahead * Dim; point < (ahead + 1) * Dim; ++point)
      if (s.losing[point]) fetch<sizeof(LossRow)>(&s.loss[point]);
    for (int r = layout.rows_reached[ahead]; r < layout.rows_reached[ahead + 1]; ++r)
      fetch<kLanes * sizeof(Vec<Dim>)>(&s.displacement[slot_of(r, 0)]);
  }

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
  static Vector gather(const FlatArray<Vec<Dim>>& vectors, const std::array<int, kLanes>& offset) {
    const double* const numbers = vectors.data()->c.data();
    Vector v;
    if constexpr (Dim == 2) {
      for (int i = 0; i < Real::kParts; ++i)
        Set::gather_pairs(numbers, offset.data() + i * Set::kWidth, v[0].part[i], v[1].part[i]);
    } else {
      alignas(64) double c[Dim][kLanes];
      for (int lane = 0; lane < kLanes; ++lane)
        for (int i = 0; i < Dim; ++i) c[i][lane] = numbers[offset[lane] + i];
      v = load(c);
    }
    return v;
  }
  static Vector gather_differences(const FlatArray<Vec<Dim>>& vectors, const std::array<int, kLanes>& offset,
                                   const std::array<int, kLanes>& less) {
    if constexpr (Dim == 2) {
      const double* const numbers = vectors.data()->c.data();
      Vector v;
      for (int i = 0; i < Real::kParts; ++i)
        Set::gather_differences(numbers, offset.data() + i * Set::kWidth, less.data() + i * Set::kWidth,
                                v[0].part[i], v[1].part[i]);
      return v;
    } else {
      return gather(vectors, offset) - gather(vectors, less);
    }
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

  template <Kinematics kKinematics>
  static Frame frame_of(const StepState<Dim>& s, const FaceRow<Dim>& face) {
    Frame frame;
    for (int t = 0; t + 1 < Dim; ++t) frame.tangents[t] = load(face.tangent[t]);
    if constexpr (kKinematics == Kinematics::finite) {
      // mean edge of the two sides
      const auto at = [&](const std::array<int, kLanes>& offset) {
        return gather(s.gathered_position, offset) + gather(s.displacement, offset);
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
  template <Kinematics kKinematics, bool kMeasure, class ConstantsOf>
  static void update_faces_of_row(StepState<Dim>& s, int row, ConstantsOf constants) {
    const FaceRow<Dim>& face = s.layout->faces[row];
    const Frame frame = frame_of<kKinematics>(s, face);
    const Real area = Real::load(face.area);
    Real turning = 0.0;
    Real stored = 0.0, applied = 0.0, widest = 0.0;
    for (int point = 0; point < Dim; ++point) {
      const int at = row * Dim + point;
      const Vector jump = gather_differences(s.displacement, face.b[point], face.a[point]);
      const Real opening = dot(jump, frame.normal);
      Tangential<Dim, Real> tangential;
      for (int t = 0; t + 1 < Dim; ++t) tangential[t] = dot(jump, frame.tangents[t]);
      const auto response = update_history(s, at, constants(point), opening, tangential);
      Vector force = frame.normal * (response.normal_traction * area);
      for (int t = 0; t + 1 < Dim; ++t) force += frame.tangents[t] * (response.shear_traction[t] * area);
      store(force, &s.contact_force[slot_of(at, 0)]);
      if constexpr (kKinematics == Kinematics::finite)
        turning += response.shear_traction[0] * opening - response.normal_traction * tangential[0];
      if constexpr (kMeasure) {
        stored += response.stored * area;
        applied += 2.0 * norm(force);  // on both sides
        widest = larger(widest, norm(jump));
      }
    }
    if constexpr (kKinematics == Kinematics::finite) add_turning_forces(s, row, frame, turning * area);
    if constexpr (kMeasure) {
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
    LossRow& loss = s.loss[at];
    ContactLossesOf<RowSum> losses{
        {loss.slipped}, {loss.tension}, {loss.shear}, {loss.friction}, {loss.compression}};
    const auto response = update_contact<Dim>(constants, opening, tangential, h, losses);
    h.held_slip.store(row.held_slip);
    s.losing[at] = response.slid || response.damaged;
    if (response.slid)
      for (int t = 0; t + 1 < Dim; ++t) h.slip[t].store(row.slip[t]);
    if (response.damaged) {
      h.tension_damage.store(row.tension_damage);
      h.shear_damage.store(row.shear_damage);
      h.closure.store(row.closure);
    }
    return response;
  }

  /// Adds to eight numbers in an array.
  struct RowSum {
    double* row;
    void operator+=(const Real& more) const { (Real::load(row) + more).store(row); }
  };

  /// Where the frame turns with the edge, so do the components of a jump. The forces that do the work of the
  /// tractions on that part keep moments in balance: minus the derivative of the jump's components by the
  /// edge's gridpoints.
  static void add_turning_forces(StepState<Dim>& s, int row, const Frame& frame, const Real& turning) {
    const Vector force = frame.normal * (0.5 * turning / frame.edge);
    store(force, &s.turning_force[slot_of(row * Dim, 0)]);
    store(-force, &s.turning_force[slot_of(row * Dim + 1, 0)]);
  }

  /// Once for the gridpoint itself, once for the one across.
  template <class Constants>
  static Vector contact_stiffness(const Constants& c, const Vector& normal, const Real& area) {
    Vector row;
    for (int i = 0; i < Dim; ++i) {
      Real sum = 0.0;
      for (int j = 0; j < Dim; ++j) {
        const Real nn = normal[i] * normal[j];
        sum += abs(c.normal_stiffness * nn + c.shear_stiffness * ((i == j ? 1.0 : 0.0) - nn));
      }
      row[i] = 2.0 * sum * area;
    }
    return row;
  }

  // Bundles

  template <Kinematics kKinematics, Pass kPass>
  [[gnu::flatten]] static void move_bundle(StepState<Dim>& s, int index, double* memory) {
    const Bundle& bundle = s.layout->bundles[index];
    const Scratch scratch = scratch_of(bundle, memory);
    constexpr bool kMeasure = kPass != Pass::move;
    Sums sums;
    take_displacements(s, bundle, scratch);
    sum_outer_forces<kKinematics, kMeasure>(s, bundle, scratch, sums);
    add_zone_forces<kKinematics, kMeasure>(s, index, scratch, sums);
    if (const int c = s.constraints_of_bundle[index]; c >= 0)
      load_bundle<kMeasure>(s, bundle, s.constraints[c], scratch, sums);
    move_rows<kPass>(s, index, scratch, sums);
    keep<kPass>(s, index, sums);
  }

  /// Adds over the contacts of a row what their two sides feel: with opposite signs, or alike.
  template <Kinematics kKinematics, bool kOpposite>
  static Vector add_contacts(const StepState<Dim>& s, int row, Vector total) {
    const ContactsOfRow range = s.layout->contacts_of_row[row];
    for (int k = range.begin; k < range.end; ++k) {
      const ActingContacts& acting = s.layout->acting[k];
      const Vector force = gather(s.contact_force, acting.contact);
      if constexpr (kOpposite) {
        const auto side_b = Real::Truth::from_bits(acting.side_b);
        for (int i = 0; i < Dim; ++i) total[i] += select(side_b, -force[i], force[i]);
        if constexpr (kKinematics == Kinematics::finite) total += gather(s.turning_force, acting.contact);
      } else {
        total += force;
      }
    }
    return total;
  }

  static ZonePropertiesOf<Real> zone_properties(const StepState<Dim>& s, int index, int zone_row) {
    const ZonePropertyRow& row = s.zone_properties[s.by_bundle ? index : zone_row];
    return {Real::load(row.lambda), Real::load(row.mu), Real::load(row.thermal_strain)};
  }

  /// Forces of eight zones on their gridpoints, Eqs. (4) and (5).
  /// \param used  lanes that are not idle
  template <Kinematics kKinematics, bool kMeasure>
  static Corners zone_forces(double thickness, const Corners& x, const Corners& u,
                             const ZonePropertiesOf<Real>& properties, const typename Real::Truth& used,
                             Sums& sums) {
    // Shape gradients times the determinant; the volume is a constant share of the determinant, which leaves
    // the division by it out of the way of the forces.
    std::array<Vector, Dim> vectors;
    const Real determinant = shape_vectors(x, vectors);
    const double share = volume_over_determinant<Dim> * thickness;
    Rotation<Real> rotation;
    const auto strain = mechanical_strain<Dim>(vectors, 1.0 / determinant, u, properties.thermal_strain,
                                               kKinematics, rotation);
    const auto stress =  // times minus the share
        zone_stress<Dim>({properties.lambda * -share, properties.mu * -share, properties.thermal_strain},
                         strain);
    Corners force;
    for (int n = 0; n < Dim; ++n) {
      force[n] = apply<Dim>(stress, vectors[n]);
      if constexpr (kKinematics == Kinematics::finite) force[n] = rotated<Dim>(rotation, force[n]);
    }
    force[Dim] = -force[0];
    for (int n = 1; n < Dim; ++n) force[Dim] -= force[n];
    if constexpr (kMeasure) {
      Real applied = 0.0;
      for (const auto& f : force) applied += norm(f);
      sums.stored -= select(used, energy_density<Dim>(stress, strain) * determinant, Real(0.0));
      sums.applied += select(used, applied, Real(0.0));
    }
    return force;
  }

  /// Sums of |stiffness| over the rows of eight zones' matrices, N/m.
  static Corners zone_stiffness(const StepState<Dim>& s, const Corners& x, const ZonePropertiesOf<Real>& p) {
    std::array<Vector, Dim> vectors;
    const Real determinant = shape_vectors(x, vectors);
    Corners g, row;
    for (int n = 0; n < Dim; ++n) {
      g[n] = vectors[n];
      g[Dim] = n == 0 ? -vectors[n] : g[Dim] - vectors[n];
    }
    const Real over = volume_over_determinant<Dim> * s.thickness / determinant;
    for (int m = 0; m <= Dim; ++m)
      for (int i = 0; i < Dim; ++i) {
        Real sum = 0.0;
        for (int n = 0; n <= Dim; ++n)
          for (int j = 0; j < Dim; ++j) {
            Real k = p.lambda * g[m][i] * g[n][j] + p.mu * g[m][j] * g[n][i];
            if (i == j) k += p.mu * dot(g[m], g[n]);
            sum += abs(k);
          }
        row[m][i] = sum * over;
      }
    return row;
  }

  /// Adds what `zone(x, u, properties, used)` gives for the corners of zones, for all of a bundle.
  template <class Zone>
  static void add_over_zones(const StepState<Dim>& s, int index, const Scratch& scratch, Zone zone) {
    const Bundle& bundle = s.layout->bundles[index];
    if (bundle.kind == BundleKind::spread) return add_over_spread_zones(s, index, bundle, scratch, zone);
    if constexpr (Dim == 2)
      if (bundle.fan) return add_over_fan(s, index, bundle, scratch, zone);
    add_over_alike_zones(s, index, bundle, scratch, zone);
  }

  /// Each zone shares an edge with the one before, so that its corners and the sum at one are at hand.
  template <class Zone>
  static void add_over_fan(const StepState<Dim>& s, int index, const Bundle& bundle, const Scratch& scratch,
                           Zone zone) {
    Corners x, u;
    const auto take = [&](int n, int gridpoint) {
      x[n] = load(s.position.row(bundle.first_row + gridpoint).c);
      u[n] = load(scratch.displacement[gridpoint].c);
    };
    const int zones = bundle.zones;
    take(0, 0);
    take(2, zones);
    fetch_ahead(s, s.position, bundle.first_row + zones);
    Vector total = load(scratch.sum[0].c), middle = load(scratch.sum[zones].c);
    for (int z = 0; z < zones; ++z) {
      const int next = z + 1 < zones ? z + 1 : 0;
      fetch_ahead(s, s.position, bundle.first_row + z);
      take(1, next);
      const Corners more =
          zone(x, u, zone_properties(s, index, bundle.first_zone_row + z), Real::Truth::from_bits(0xFF));
      store(total + more[0], scratch.sum[z].c);
      total = load(scratch.sum[next].c) + more[1];
      middle += more[2];
      x[0] = x[1];
      u[0] = u[1];
    }
    store(total, scratch.sum[0].c);
    store(middle, scratch.sum[zones].c);
  }

  template <class Zone>
  static void add_over_alike_zones(const StepState<Dim>& s, int index, const Bundle& bundle,
                                   const Scratch& scratch, Zone zone) {
    const auto& zones = s.layout->shapes[bundle.shape];
    for (int z = 0; z < bundle.zones; ++z) {
      if (z < bundle.rows) fetch_ahead(s, s.position, bundle.first_row + z);
      const auto& corner = zones[z];
      Corners x, u;
      for (int n = 0; n <= Dim; ++n) {
        x[n] = load(s.position.row(bundle.first_row + corner[n]).c);
        u[n] = load(scratch.displacement[corner[n]].c);
      }
      const Corners more =
          zone(x, u, zone_properties(s, index, bundle.first_zone_row + z), Real::Truth::from_bits(0xFF));
      for (int n = 0; n <= Dim; ++n) {
        auto& total = scratch.sum[corner[n]].c;
        store(load(total) + more[n], total);
      }
    }
  }

  template <class Zone>
  static void add_over_spread_zones(const StepState<Dim>& s, int index, const Bundle& bundle,
                                    const Scratch& scratch, Zone zone) {
    for (int z = 0; z < bundle.zone_rows(); ++z) {
      const int used = bundle.zones - kLanes * z < kLanes ? bundle.zones - kLanes * z : kLanes;
      const auto& corner = s.layout->spread_zones[bundle.first_spread_row + z].offset;
      Corners x, u;
      for (int n = 0; n <= Dim; ++n) {
        x[n] = gather(s.gathered_position, corner[n]);
        u[n] = gather(s.displacement, corner[n]);
      }
      const Corners more = zone(x, u, zone_properties(s, index, bundle.first_zone_row + z),
                                Real::Truth::from_bits((1U << used) - 1U));
      // Zone by zone, as in every other bundle: so no force depends on how blocks are bundled.
      alignas(64) double c[Dim + 1][Dim][kLanes];
      for (int n = 0; n <= Dim; ++n) store(more[n], c[n]);
      for (int lane = 0; lane < used; ++lane)
        for (int n = 0; n <= Dim; ++n) {
          const int slot = corner[n][lane] / offset_of<Dim>(1) - slot_of(bundle.first_row, 0);
          for (int i = 0; i < Dim; ++i) scratch.sum[slot / kLanes].c[i][slot % kLanes] += c[n][i][lane];
        }
    }
  }

  /// Adds applied forces and shares out the sum (4) where gridpoints are tied.
  template <bool kMeasure>
  static void load_bundle(StepState<Dim>& s, const Bundle& bundle, const Constraints<Dim>& constraints,
                          const Scratch& scratch, Sums& sums) {
    for (int i = 0; i < bundle.rows; ++i) {
      const Vector applied = load(constraints.applied.row(i).c);
      store(load(scratch.sum[i].c) + applied, scratch.sum[i].c);
      if constexpr (kMeasure) sums.applied += norm(applied);
    }
    for (const Tie& tie : constraints.ties) {
      const auto force = [&](int slot) -> double& {
        const int own = slot - slot_of(bundle.first_row, 0);
        return scratch.sum[own / kLanes].c[tie.component][own % kLanes];
      };
      double total = 0.0, mass = 0.0;
      for (int slot : tie.slots) {
        total += force(slot);
        mass += s.time_step / s.step_over_mass[slot];
      }
      for (int slot : tie.slots) force(slot) = total * (s.time_step / s.step_over_mass[slot]) / mass;
    }
  }

  /// Parameters as the motion needs them. A copy: for all that the compiler knows, what is stored in an array
  /// may change those of the state.
  struct Motion {
    explicit Motion(const StepParameters<Dim>& p)
        : dt(p.time_step),
          half_dt(0.5 * p.time_step),
          combined(p.damping_form == DampingForm::combined),
          viscous(p.viscous_damping != 0.0),
          lambda(combined ? 0.5 * p.local_damping : p.local_damping),
          drag(p.viscous_damping * half_dt),
          kept(1.0 - drag),
          over(1.0 / (1.0 + drag)) {}
    double dt, half_dt;
    bool combined, viscous;
    double lambda, drag, kept, over;
  };

  /// Damps the sum of forces (8) and integrates velocity and displacement (6), (7).
  template <Pass kPass, bool kConstrained>
  static void move_row(StepState<Dim>& s, const Motion& m, const Bundle& bundle, int i,
                       const Constraints<Dim>* constraints, const Scratch& scratch, Sums& sums) {
    constexpr bool kMeasure = kPass != Pass::move;
    const int row = bundle.first_row + i;
    const Vector force = load(scratch.sum[i].c);
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
    fetch_ahead(s, s.velocity, row);
    fetch_ahead(s, s.step_over_mass, row);
    const Real step_over_mass = Real::load(&s.step_over_mass[slot_of(row, 0)]);
    const Vector before = load(s.velocity.row(row).c);
    Vector after;
    for (int j = 0; j < Dim; ++j) {
      const Real magnitude = abs(force[j]) * m.lambda;
      Real damping = signed_like(magnitude, before[j]);
      if (m.combined) damping -= signed_like(magnitude, force[j] - Real::load(s.force.row(row).c[j]));
      after[j] = before[j] + (force[j] - damping) * step_over_mass;
      if (m.viscous) after[j] = (m.kept * before[j] + (force[j] - damping) * step_over_mass) * m.over;
      if constexpr (kConstrained) {
        const auto prescribed = Real::Truth::from_bits(constraints->prescribed[i][j]);
        after[j] = select(prescribed, Real::load(constraints->prescribed_velocity.row(i).c[j]), after[j]);
        damping = select(prescribed, Real(0.0), damping);
        const Real reaction = (after[j] - before[j]) / step_over_mass - force[j];
        const Real loading =
            Real::load(constraints->applied.row(i).c[j]) + select(prescribed, reaction, Real(0.0));
        sums.loading += loading * (before[j] + after[j]) * m.half_dt;
        if constexpr (kMeasure) sums.begun_loading += loading * after[j] * m.half_dt;
      }
      sums.damping += damping * (before[j] + after[j]);
      if constexpr (kMeasure) sums.begun_damping += damping * after[j] * m.half_dt;
      if (m.viscous) {
        Real drag = m.drag * (before[j] + after[j]) / step_over_mass;
        if constexpr (kConstrained)
          drag = select(Real::Truth::from_bits(constraints->prescribed[i][j]), Real(0.0), drag);
        sums.viscous += drag * (before[j] + after[j]) * m.half_dt;
        if constexpr (kMeasure) sums.begun_viscous += drag * after[j] * m.half_dt;
      }
    }
    if constexpr (kMeasure) sums.kinetic += dot(before, after) * m.half_dt / step_over_mass;
    store(force, s.force.row(row).c);
    store(after, s.velocity.row(row).c);
    store(load(scratch.displacement[i].c) + after * m.dt, &s.displacement[slot_of(row, 0)]);
  }
};

}  // namespace pyroclast
