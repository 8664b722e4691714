#pragma once

#include "pyroclast/mechanics/step/packs.hpp"
#include "pyroclast/model/zone_shape.hpp"

/// Zones: from displacements to strains, stresses and forces, Eqs. (4) and (5).
namespace pyroclast {

template <int Dim, class Set>
struct Zones {
  using R = Packs<Dim, Set>;
  using Real = typename R::Real;
  using Vector = typename R::Vector;
  using Scratch = typename R::Scratch;
  using Sums = typename R::Sums;
  using Corners = std::array<Vector, Dim + 1>;
  using Edges = std::array<Vector, Dim>;  ///< the first Dim corners, as seen from the last

  /// Adds the forces of a bundle's zones.
  /// \tparam kCreeps  true where zones of the body creep
  template <Kinematics kKinematics, bool kMeasure, bool kCreeps>
  static void add_forces(const State<Dim>& s, int index, const Scratch& scratch, Sums& sums) {
    const double thickness = s.thickness;
    const TensorPack<Dim>* const creep_strain = s.creep_strain.data();
    add_over_zones(s, index, scratch, [&](const Edges& x, const Edges& u, int zone_pack, const auto& used) {
      return forces<kKinematics, kMeasure, kCreeps>(thickness, x, u, properties(s, index, zone_pack),
                                                    kCreeps ? creep_strain + zone_pack : nullptr, used, sums);
    });
  }

  /// Writes the forces of a piece's zones on their corners, which `add_forces` adds later.
  template <Kinematics kKinematics, bool kMeasure, bool kCreeps>
  static void place_corner_forces(State<Dim>& s, int index, Sums& sums) {
    const double thickness = s.thickness;
    const TensorPack<Dim>* const creep_strain = s.creep_strain.data();
    place_at_corners(s, index, [&](const Edges& x, const Edges& u, int zone_pack, const auto& used) {
      return forces<kKinematics, kMeasure, kCreeps>(thickness, x, u, properties(s, index, zone_pack),
                                                    kCreeps ? creep_strain + zone_pack : nullptr, used, sums);
    });
  }

  /// Adds the sums of |stiffness| over the rows of the zones' matrices, N/m.
  static void add_stiffness(const State<Dim>& s, int index, const Scratch& scratch) {
    add_over_zones(s, index, scratch, [&](const Edges& x, const Edges&, int zone_pack, const auto&) {
      return stiffness(s, x, properties(s, index, zone_pack));
    });
  }

  /// Writes the sums of a piece's zones, which `add_stiffness` adds later, in the place of corner forces.
  static void place_corner_stiffness(State<Dim>& s, int index) {
    place_at_corners(s, index, [&](const Edges& x, const Edges&, int zone_pack, const auto&) {
      return stiffness(s, x, properties(s, index, zone_pack));
    });
  }

 private:
  static ZonePropertiesOf<Real> properties(const State<Dim>& s, int index, int zone_pack) {
    const ZonePropertyPack& pack = s.zone_properties[s.by_bundle ? index : zone_pack];
    return {Real::load(pack.lambda), Real::load(pack.mu), Real::load(pack.thermal_strain)};
  }

  /// Returns the forces of eight zones on their gridpoints.
  /// \param creep_strain  creep strains, read where kCreeps
  /// \param used          lanes that are not idle
  template <Kinematics kKinematics, bool kMeasure, bool kCreeps>
  static Corners forces(double thickness, const Edges& x, const Edges& u, const ZonePropertiesOf<Real>& p,
                        [[maybe_unused]] const TensorPack<Dim>* creep_strain,
                        const typename Real::Truth& used, Sums& sums) {
    // Shape gradients times the determinant. The volume is a constant share of the determinant, so the forces
    // need not wait for the division by it.
    std::array<Vector, Dim> vectors;
    const Real determinant = shape_vectors(x, vectors);
    const double share = volume_over_determinant<Dim> * thickness;
    Rotation<Dim, Real> rotation;
    auto strain =
        mechanical_strain<Dim>(vectors, 1.0 / determinant, u, p.thermal_strain, kKinematics, rotation);
    if constexpr (kCreeps)
      for (std::size_t i = 0; i < strain.size(); ++i) strain[i] -= Real::load(creep_strain->component[i]);
    const auto stress =  // minus the stress times the share
        zone_stress<Dim>({p.lambda * -share, p.mu * -share, p.thermal_strain}, strain);
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

  /// Sums |stiffness| over the rows of the matrices of eight zones, N/m.
  static Corners stiffness(const State<Dim>& s, const Edges& x, const ZonePropertiesOf<Real>& p) {
    std::array<Vector, Dim> vectors;
    const Real determinant = shape_vectors(x, vectors);
    Corners g, pack;
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
        pack[m][i] = sum * over;
      }
    return pack;
  }

  // No sum depends on how blocks are bundled. In 2D forces are added zone by zone. In 3D they are added by
  // packs of eight zones of the block, corner by corner, lane by lane. The sum at a centre is taken lane by
  // lane over all packs, and then across the lanes.

  /// Adds the result of `zone(x, u, zone_pack, used)` at the corners of all zones of a bundle; in a piece,
  /// the results that `place_at_corners` wrote.
  template <class Zone>
  static void add_over_zones(const State<Dim>& s, int index, const Scratch& scratch, Zone zone) {
    const Bundle& bundle = s.layout.bundles[index];
    if (bundle.kind == BundleKind::piece) return add_from_corners(s, bundle, scratch);
    if constexpr (Dim == 3) {
      add_over_ragged(s, bundle, scratch, zone);
    } else {
      if (bundle.fan) return add_over_fan(s, bundle, scratch, zone);
      add_over_alike(s, bundle, scratch, zone);
    }
  }

  /// Adds over the zones of a fan. Each zone shares an edge with the one before, so that its corners and the
  /// sum at one corner are at hand.
  template <class Zone>
  static void add_over_fan(const State<Dim>& s, const Bundle& bundle, const Scratch& scratch, Zone zone) {
    const int zones = bundle.zones;
    const auto position = [&](int gridpoint) { return R::load(s.position[bundle.first_pack + gridpoint].c); };
    const auto displacement = [&](int gridpoint) { return R::load(scratch.displacement[gridpoint].c); };
    const Vector x_of_last = position(zones), u_of_last = displacement(zones);
    R::fetch_ahead(s.position, bundle.first_pack + zones);
    Edges x, u;
    x[0] = position(0) - x_of_last;
    u[0] = displacement(0) - u_of_last;
    Vector total = R::load(scratch.sum[0].c), middle = R::load(scratch.sum[zones].c);
    for (int z = 0; z < zones; ++z) {
      const int next = z + 1 < zones ? z + 1 : 0;
      R::fetch_ahead(s.position, bundle.first_pack + z);
      x[1] = position(next) - x_of_last;
      u[1] = displacement(next) - u_of_last;
      const Corners more = zone(x, u, bundle.first_zone_pack + z, Real::Truth::from_bits(0xFF));
      R::store(total + more[0], scratch.sum[z].c);
      total = R::load(scratch.sum[next].c) + more[1];
      middle += more[2];
      x[0] = x[1];
      u[0] = u[1];
    }
    R::store(total, scratch.sum[0].c);
    R::store(middle, scratch.sum[zones].c);
  }

  template <class Zone>
  static void add_over_alike(const State<Dim>& s, const Bundle& bundle, const Scratch& scratch, Zone zone) {
    const auto* const zones = &s.layout.shape_zones[bundle.first_corners];
    for (int z = 0; z < bundle.zones; ++z) {
      if (z < bundle.packs) R::fetch_ahead(s.position, bundle.first_pack + z);
      const auto& corner = zones[z];
      const Vector x_of_last = R::load(s.position[bundle.first_pack + corner[Dim]].c);
      const Vector u_of_last = R::load(scratch.displacement[corner[Dim]].c);
      Edges x, u;
      for (int n = 0; n < Dim; ++n) {
        x[n] = R::load(s.position[bundle.first_pack + corner[n]].c) - x_of_last;
        u[n] = R::load(scratch.displacement[corner[n]].c) - u_of_last;
      }
      const Corners more = zone(x, u, bundle.first_zone_pack + z, Real::Truth::from_bits(0xFF));
      for (int n = 0; n <= Dim; ++n) {
        auto& total = scratch.sum[corner[n]].c;
        R::store(R::load(total) + more[n], total);
      }
    }
  }

  /// Adds over the zones of a block whose zones all have its last gridpoint as their last corner.
  template <class Zone>
  static void add_over_ragged(const State<Dim>& s, const Bundle& bundle, const Scratch& scratch, Zone zone) {
    const Vector u_of_last = R::all(s.displacement[slot_of(bundle.first_pack, bundle.centre)]);
    for (int i = 0; i < bundle.packs; ++i) {
      R::fetch_ahead(s.from_last, bundle.first_pack + i);
      R::store(R::load(scratch.displacement[i].c) - u_of_last, scratch.seen + slot_of(i, 0));
      R::store(R::load(scratch.sum[i].c), scratch.summed + slot_of(i, 0));
    }
    const Four* const from_last = &s.from_last[slot_of(bundle.first_pack, 0)];
    Vector middle = R::all({});
    for (int z = 0; z < bundle.zone_packs(); ++z) {
      R::fetch_ahead(s.layout.ragged_zones, bundle.first_corners + z);
      const auto& corner = s.layout.ragged_zones[bundle.first_corners + z];
      Edges x, u;
      unroll<Dim>([&](auto n) {
        x[n] = R::gather(from_last, corner[n]);
        u[n] = R::gather(scratch.seen, corner[n]);
      });
      const auto used = used_zones(bundle, z);
      Corners force = zone(x, u, bundle.first_zone_pack + z, used);
      unroll<Dim + 1>([&](auto n) { force[n] = R::where(used, force[n]); });
      unroll<Dim>([&](auto n) { R::add(force[n], scratch.summed, corner[n]); });
      middle += force[Dim];
    }
    for (int i = 0; i < bundle.packs; ++i)
      R::store(R::load(scratch.summed + slot_of(i, 0)), scratch.sum[i].c);
    add_at_centre(bundle, scratch, middle);
  }

  /// Adds the sum over the lanes at the gridpoint that all zones of a block have in common.
  static void add_at_centre(const Bundle& bundle, const Scratch& scratch, const Vector& of_lanes) {
    for (int i = 0; i < Dim; ++i)
      scratch.sum[bundle.centre / kLanes].c[i][bundle.centre % kLanes] += sum(of_lanes[i]);
  }

  /// Writes the result of `zone` for the zones of a piece, whose gridpoints stand anywhere in their block.
  template <class Zone>
  static void place_at_corners(State<Dim>& s, int index, Zone zone) {
    const Bundle& bundle = s.layout.bundles[index];
    for (int z = 0; z < bundle.zone_packs(); ++z) {
      const int pack = bundle.first_corners + z;
      const auto& corner = s.layout.piece_zones[pack].offset;
      const auto position = [&](int n) {
        if constexpr (Dim == 2)
          return R::gather(s.gathered_position, corner[n]);
        else
          return R::gather_places(s.from_last, corner[n]);
      };
      const Vector x_of_last = position(Dim), u_of_last = R::gather(s.displacement, corner[Dim]);
      Edges x, u;
      for (int n = 0; n < Dim; ++n) {
        x[n] = position(n) - x_of_last;
        u[n] = R::gather(s.displacement, corner[n]) - u_of_last;
      }
      const auto used = used_zones(bundle, z);
      Corners force = zone(x, u, bundle.first_zone_pack + z, used);
      if constexpr (Dim == 3) force[Dim] = R::where(used, force[Dim]);  // add_from_corners takes all lanes
      for (int n = 0; n <= Dim; ++n) R::store(force[n], &s.corner_force[slot_of(pack * (Dim + 1) + n, 0)]);
    }
  }

  static void add_from_corners(const State<Dim>& s, const Bundle& bundle, const Scratch& scratch) {
    for (int i = 0; i < bundle.packs; ++i) {
      const IndexRange range = s.layout.corners_of_pack[bundle.first_gathering_pack + i];
      Vector total = R::load(scratch.sum[i].c);
      for (int k = range.first; k < range.last; ++k)
        total += R::gather(s.corner_force, s.layout.acting_corners[k]);
      R::store(total, scratch.sum[i].c);
    }
    if constexpr (Dim == 3)
      if (bundle.centre >= 0) {
        Vector middle = R::all({});
        for (int pack = bundle.corners_of_block.first; pack < bundle.corners_of_block.last; ++pack)
          middle += R::load(&s.corner_force[slot_of(pack * (Dim + 1) + Dim, 0)]);
        add_at_centre(bundle, scratch, middle);
      }
  }

  /// Returns the lanes that are not idle in a pack of zones of a block that goes over all lanes.
  static typename Real::Truth used_zones(const Bundle& bundle, int zone_pack) {
    const int left = bundle.zones - kLanes * zone_pack;
    return Real::Truth::from_bits((1U << (left < kLanes ? left : kLanes)) - 1U);
  }
};

}  // namespace pyroclast
