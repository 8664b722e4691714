#pragma once

#include <algorithm>

#include "pyroclast/mechanics/compiled_step.hpp"
#include "pyroclast/mechanics/step/contacts.hpp"
#include "pyroclast/mechanics/step/found.hpp"
#include "pyroclast/mechanics/step/motion.hpp"
#include "pyroclast/mechanics/step/zones.hpp"

/// Step of the method, on lanes:
///
///     faces      displacements -> jump -> law -> traction -> contact force     Eqs. (10)-(15)  contacts.hpp
///     found pairs      ^      -> places of facets -> law -> corner forces       Eqs. (10)-(15)  found.hpp
///     large blocks     |      -> zones -> corner forces                        Eqs. (4), (5)   zones.hpp
///                      |                                          |
///                      |                                          v
///     bundles          |   weight + contact forces + zone forces + loads       Eqs. (4), (5)   zones.hpp
///                      |                                          |
///                      +--------------- motion <------------------+            Eqs. (6)-(8)    motion.hpp
///
/// mechanics/layout.hpp draws the place of every item and explains the words; packs.hpp loads, stores and
/// gathers; base/lanes.hpp explains lanes; the laws stand in laws/. sweep.hpp shares a step out to threads:
/// it takes packs of faces and, soon after, the bundles whose faces are all done. Each gridpoint gathers the
/// forces that act on it; no force is scattered. This header is compiled once for each instruction set.
namespace pyroclast {

/// \tparam Set  an instruction set of base/lanes.hpp
template <int Dim, class Set>
class Step {
 public:
  using R = Packs<Dim, Set>;
  using C = ContactForces<Dim, Set>;
  using Z = Zones<Dim, Set>;
  using M = GridpointMotion<Dim, Set>;
  using Vector = typename R::Vector;
  using Scratch = typename R::Scratch;
  using Sums = typename R::Sums;

  /// Does the second half of a step, for bundles whose faces are all done.
  static void move_bundles(State<Dim>& s, int first, int last, Pass pass, double* memory) {
    with_kinematics(s, [&](auto kinematics) {
      with_creep(s, [&](auto creeps) {
        with_measuring(pass, [&](auto measures) {
          for (int b = first; b < last; ++b)
            bundle<kinematics(), measures(), creeps()>(s, b, pass != Pass::measure, memory);
        });
      });
    });
  }

  /// Computes the corner forces of parts of large blocks, in the first half of a step.
  static void place_corner_forces(State<Dim>& s, int first, int last, Pass pass) {
    with_kinematics(s, [&](auto kinematics) {
      with_creep(s, [&](auto creeps) {
        with_measuring(pass, [&](auto measures) {
          for (int i = first; i < last; ++i)
            corner_forces<kinematics(), measures(), creeps()>(s, s.layout.parts[i]);
        });
      });
    });
  }

  /// Ends the step of parts whose gridpoints are tied to others.
  static void move_tied_parts(State<Dim>& s, int first, int last, Pass pass, double* memory) {
    with_measuring(pass, [&](auto measures) {
      for (int i = first; i < last; ++i) {
        const int index = s.layout.parts[i];
        if (const int c = s.constraints_of_bundle[index]; c >= 0 && s.constraints[c].ties())
          tied_part<measures()>(s, index, s.constraints[c], pass != Pass::measure, memory);
      }
    });
  }

  /// Sums |stiffness| over each row of the assembled matrix of zones and contacts, N/m.
  static void sum_stiffness(State<Dim>& s, double* memory) {
    for_each_law(
        s, 0, static_cast<int>(s.layout.faces.size()),
        [&](const PackFunctions<Dim>& law, int first, int last) { law.place_stiffness(s, first, last); });
    for (int b = 0; b < static_cast<int>(s.layout.bundles.size()); ++b)
      if (s.layout.bundles[b].kind == BundleKind::piece) Z::place_corner_stiffness(s, b);
    stiffness(s, memory);
  }

  static constexpr StepPasses<Dim> passes() {
    using Found = FoundContactForces<Dim, Set>;
    return {place_corner_forces,         move_bundles,  move_tied_parts, sum_stiffness,
            PorePressure<Dim, Set>::add, Found::update, Found::way};
  }

  // flatten, because lanes that cross a call go through memory
  /// \param moves  false where a pass takes sums alone
  template <Kinematics kKinematics, bool kMeasure, bool kCreeps>
  [[gnu::flatten]] static void bundle(State<Dim>& s, int index, bool moves, double* memory) {
    const Bundle& bundle = s.layout.bundles[index];
    const Scratch scratch = R::scratch_of(bundle, memory);
    Sums sums;
    take_displacements(s, bundle, scratch);
    sum_weights_and_contacts<kKinematics, kMeasure>(s, bundle, scratch, sums);
    if constexpr (Dim == 3 || kKinematics == Kinematics::finite)
      if (s.found) FoundContactForces<Dim, Set>::add_forces(*s.found, bundle, index, scratch.sum);
    if (bundle.kind == BundleKind::piece && !bundle.is_part)
      Z::template place_corner_forces<kKinematics, kMeasure, kCreeps>(s, index, sums);
    Z::template add_forces<kKinematics, kMeasure, kCreeps>(s, index, scratch, sums);
    if (const int c = s.constraints_of_bundle[index]; c >= 0) {
      const BundleConstraints& constraints = s.constraints[c];
      M::template load<kMeasure>(s, bundle, constraints, scratch, sums);
      if (bundle.is_part && constraints.ties()) return put_aside<kMeasure>(s, index, scratch, sums);
      M::share_out(s, bundle, constraints, scratch.sum, scratch);
    }
    M::template move_packs<kMeasure>(s, index, moves, scratch, sums);
    M::template keep<kMeasure>(s, index, moves, sums);
  }

  template <Kinematics kKinematics, bool kMeasure, bool kCreeps>
  [[gnu::flatten]] static void corner_forces(State<Dim>& s, int part) {
    Sums sums;
    Z::template place_corner_forces<kKinematics, kMeasure, kCreeps>(s, part, sums);
    if constexpr (kMeasure) M::keep_of_zones(s, part, sums);
  }

  /// Puts the sums of forces of a part aside, until those of its block's other parts are there too.
  template <bool kMeasure>
  static void put_aside(State<Dim>& s, int part, const Scratch& scratch, const Sums& sums) {
    const Bundle& bundle = s.layout.bundles[part];
    std::copy_n(scratch.sum, bundle.packs, &s.part_force[bundle.first_gathering_pack]);
    if constexpr (kMeasure) s.bundle_sums[part].applied += sum(sums.applied);
  }

  template <bool kMeasure>
  [[gnu::flatten]] static void tied_part(State<Dim>& s, int part, const BundleConstraints& constraints,
                                         bool moves, double* memory) {
    const Bundle& bundle = s.layout.bundles[part];
    const Scratch scratch = R::scratch_of(bundle, memory);
    const VectorPack<Dim>* const forces = &s.part_force[bundle.first_gathering_pack];
    Sums sums;
    take_displacements(s, bundle, scratch);
    std::copy_n(forces, bundle.packs, scratch.sum);
    M::share_out(s, bundle, constraints, forces, scratch);
    M::template move_packs<kMeasure>(s, part, moves, scratch, sums);
    M::template keep<kMeasure>(s, part, moves, sums);
  }

  // Parts of a bundle's step, public so that each can be timed alone.

  static void take_displacements(const State<Dim>& s, const Bundle& bundle, const Scratch& scratch) {
    for (int i = 0; i < bundle.packs; ++i)
      R::store(R::load(&s.displacement[slot_of(bundle.first_pack + i, 0)]), scratch.displacement[i].c);
  }

  /// Begins the sums of forces of a bundle with its weights and contact forces.
  template <Kinematics kKinematics, bool kMeasure>
  static void sum_weights_and_contacts(const State<Dim>& s, const Bundle& bundle, const Scratch& scratch,
                                       Sums& sums) {
    const bool weighs = s.weighs();
    const Vec<Dim> gravity = s.gravity;
    for (int i = 0; i < bundle.packs; ++i) {
      const int pack = bundle.first_pack + i;
      R::fetch_ahead(s.force, pack);
      Vector total{};
      if (weighs) {
        const auto mass = R::Real::load(&s.real_mass[slot_of(pack, 0)]);
        for (int j = 0; j < Dim; ++j) total[j] = mass * gravity[j];
        if constexpr (kMeasure) sums.applied += norm(total);
      }
      R::store(C::template add_forces<kKinematics, true>(s, pack, total), scratch.sum[i].c);
    }
  }

 private:
  [[gnu::flatten]] static void stiffness(State<Dim>& s, double* memory) {
    for (int index = 0; index < static_cast<int>(s.layout.bundles.size()); ++index) {
      const Bundle& bundle = s.layout.bundles[index];
      const Scratch scratch = R::scratch_of(bundle, memory);
      for (int i = 0; i < bundle.packs; ++i)
        R::store(C::template add_forces<Kinematics::small, false>(s, bundle.first_pack + i, Vector{}),
                 scratch.sum[i].c);
      Z::add_stiffness(s, index, scratch);
      for (int i = 0; i < bundle.packs; ++i) {
        const Vector rows = R::load(scratch.sum[i].c);
        auto most = rows[0];
        for (int j = 1; j < Dim; ++j) most = larger(most, rows[j]);
        most.store(&s.stiffness[slot_of(bundle.first_pack + i, 0)]);
      }
    }
  }
};

template <class Set>
const ByDimension<StepPasses> CompiledStep<Set>::step{Step<2, Set>::passes(), Step<3, Set>::passes()};

}  // namespace pyroclast
