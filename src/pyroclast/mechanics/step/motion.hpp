#pragma once

#include "pyroclast/mechanics/step/packs.hpp"

/// Motion of gridpoints under the sums of forces, Eqs. (6)-(8), held, tied, driven and loaded as prescribed.
namespace pyroclast {

template <int Dim, class Set>
struct GridpointMotion {
  using R = Packs<Dim, Set>;
  using Real = typename R::Real;
  using Vector = typename R::Vector;
  using Scratch = typename R::Scratch;
  using Sums = typename R::Sums;

  /// Adds applied forces.
  template <bool kMeasure>
  static void load(const State<Dim>& s, const Bundle& bundle, const BundleConstraints& constraints,
                   const Scratch& scratch, Sums& sums) {
    for (int i = 0; i < bundle.packs; ++i) {
      const Vector applied = R::load(s.constraint_packs[constraints.first_pack + i].applied);
      R::store(R::load(scratch.sum[i].c) + applied, scratch.sum[i].c);
      if constexpr (kMeasure) sums.applied += norm(applied);
    }
  }

  /// Shares the sum (4) out by mass where gridpoints are tied.
  /// \param forces  sums of forces of all tied gridpoints, by pack from the bundle's first on: those of
  ///                `scratch`, or of all parts of a block
  static void share_out(const State<Dim>& s, const Bundle& bundle, const BundleConstraints& constraints,
                        const VectorPack<Dim>* forces, const Scratch& scratch) {
    for (int t = constraints.first_tie; t < constraints.last_tie; ++t) {
      const Tie& tie = s.ties[t];
      double total = 0.0, mass = 0.0;
      for (int i = tie.begin; i < tie.end; ++i) {
        const int slot = s.tied_slots[i];
        total += forces[slot / kLanes - bundle.first_pack].c[tie.component][slot % kLanes];
        mass += s.time_step / s.step_over_mass[slot];
      }
      for (int i = tie.begin; i < tie.end; ++i) {
        const int slot = s.tied_slots[i], pack = slot / kLanes - bundle.first_pack;
        if (pack < 0 || pack >= bundle.packs) continue;  // that of another part
        scratch.sum[pack].c[tie.component][slot % kLanes] =
            total * (s.time_step / s.step_over_mass[slot]) / mass;
      }
    }
  }

  /// Moves the gridpoints of a bundle.
  /// \param moves  false where a pass takes sums alone
  template <bool kMeasure>
  static void move_packs(State<Dim>& s, int index, bool moves, const Scratch& scratch, Sums& sums) {
    const Bundle& bundle = s.layout.bundles[index];
    const Parameters parameters(s);
    if (const int c = s.constraints_of_bundle[index]; c >= 0) {
      const ConstraintPack<Dim>* const packs = &s.constraint_packs[s.constraints[c].first_pack];
      for (int i = 0; i < bundle.packs; ++i)
        move_pack<kMeasure, true>(s, parameters, bundle, i, &packs[i], moves, scratch, sums);
    } else {
      for (int i = 0; i < bundle.packs; ++i)
        move_pack<kMeasure, false>(s, parameters, bundle, i, nullptr, moves, scratch, sums);
    }
  }

  /// Books the sums of a bundle.
  /// \param moves  as of move_packs
  template <bool kMeasure>
  static void keep(State<Dim>& s, int index, bool moves, const Sums& sums) {
    BundleSums& kept = s.bundle_sums[index];
    if (!kMeasure || moves) {
      kept.damping_work += sum(sums.damping) * (0.5 * s.time_step);
      if (s.viscous_damping != 0.0) kept.viscous_work += sum(sums.viscous);
      if (const int c = s.constraints_of_bundle[index]; c >= 0)
        s.constraints[c].loading_work += sum(sums.loading);
    }
    if constexpr (kMeasure) {
      if (moves) {
        kept.begun_damping = sum(sums.begun_damping);
        kept.begun_viscous = sum(sums.begun_viscous);
        kept.begun_loading = sum(sums.begun_loading);
        kept.kinetic = sum(sums.kinetic);
      }
      const bool begun = s.layout.bundles[index].is_part;
      kept.stored = (begun ? kept.stored : 0.0) + sum(sums.stored);
      kept.applied = (begun ? kept.applied : 0.0) + sum(sums.applied);
      kept.unbalanced = sum(sums.unbalanced);
    }
  }

  /// Books the sums of a part's zones, to which `keep` adds.
  static void keep_of_zones(State<Dim>& s, int index, const Sums& sums) {
    s.bundle_sums[index].stored = sum(sums.stored);
    s.bundle_sums[index].applied = sum(sums.applied);
  }

 private:
  /// Parameters as the motion needs them. This is a copy: otherwise aliasing forces reloads after every
  /// store.
  struct Parameters {
    explicit Parameters(const StepParameters<Dim>& p)
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
  template <bool kMeasure, bool kConstrained>
  static void move_pack(State<Dim>& s, const Parameters& m, const Bundle& bundle, int i,
                        const ConstraintPack<Dim>* constraints, bool moves, const Scratch& scratch,
                        Sums& sums) {
    const int pack = bundle.first_pack + i;
    const Vector force = R::load(scratch.sum[i].c);
    if constexpr (kMeasure) {
      Vector free = force;
      if constexpr (kConstrained)
        for (int j = 0; j < Dim; ++j)
          free[j] = select(Real::Truth::from_bits(constraints->prescribed[j]), Real(0.0), free[j]);
      sums.unbalanced += norm(free);
    }
    if (kMeasure && !moves) return R::store(force, s.force[pack].c);
    R::fetch_ahead(s.velocity, pack);
    R::fetch_ahead(s.step_over_mass, pack);
    const Real step_over_mass = Real::load(&s.step_over_mass[slot_of(pack, 0)]);
    const Vector before = R::load(s.velocity[pack].c);
    Vector after;
    for (int j = 0; j < Dim; ++j) {
      const Real magnitude = abs(force[j]) * m.lambda;
      Real damping = signed_like(magnitude, before[j]);
      if (m.combined) damping -= signed_like(magnitude, force[j] - Real::load(s.force[pack].c[j]));
      after[j] = before[j] + (force[j] - damping) * step_over_mass;
      if (m.viscous) after[j] = (m.kept * before[j] + (force[j] - damping) * step_over_mass) * m.over;
      if constexpr (kConstrained) {
        const auto prescribed = Real::Truth::from_bits(constraints->prescribed[j]);
        after[j] = select(prescribed, Real::load(constraints->prescribed_velocity[j]), after[j]);
        damping = select(prescribed, Real(0.0), damping);
        const Real reaction = (after[j] - before[j]) / step_over_mass - force[j];
        const Real loading = Real::load(constraints->applied[j]) + select(prescribed, reaction, Real(0.0));
        sums.loading += loading * (before[j] + after[j]) * m.half_dt;
        if constexpr (kMeasure) sums.begun_loading += loading * after[j] * m.half_dt;
      }
      sums.damping += damping * (before[j] + after[j]);
      if constexpr (kMeasure) sums.begun_damping += damping * after[j] * m.half_dt;
      if (m.viscous) {
        Real drag = m.drag * (before[j] + after[j]) / step_over_mass;
        if constexpr (kConstrained)
          drag = select(Real::Truth::from_bits(constraints->prescribed[j]), Real(0.0), drag);
        sums.viscous += drag * (before[j] + after[j]) * m.half_dt;
        if constexpr (kMeasure) sums.begun_viscous += drag * after[j] * m.half_dt;
      }
    }
    if constexpr (kMeasure) sums.kinetic += dot(before, after) * m.half_dt / step_over_mass;
    R::store(force, s.force[pack].c);
    R::store(after, s.velocity[pack].c);
    R::store(R::load(scratch.displacement[i].c) + after * m.dt, &s.displacement[slot_of(pack, 0)]);
  }
};

}  // namespace pyroclast
