#pragma once

#include <array>

#include "pyroclast/mechanics/found/edge_pair.hpp"
#include "pyroclast/mechanics/found/rows.hpp"
#include "pyroclast/mechanics/step/packs.hpp"

/// Contacts that are found: rows of eight pairs of edges, from places to jumps to tractions to forces.
namespace pyroclast {

template <class Set>
struct FoundContactForces {
  using R = Packs<2, Set>;
  using Real = typename R::Real;
  using Truth = typename Real::Truth;
  using Vector = typename R::Vector;

  /// Computes the forces of rows.
  static void update(State<2>& s, int first, int last) {
    for (int row = first; row < last; ++row) update_row(s, *s.found, row);
  }

  /// Sums the forces of rows on gridpoints.
  /// \param first, last  entries of FoundRows::loaded
  static void sum_forces(State<2>& s, int first, int last) {
    FoundRows& found = *s.found;
    const double* const forces = &found.forces.data()->c[0][0];
    for (int i = first; i < last; ++i) {
      const LoadedGridpoint& gridpoint = found.loaded[i];
      Vec<2> sum{};
      for (int k = gridpoint.first_force; k < gridpoint.last_force; ++k) {
        sum[0] += forces[found.acting[k]];
        sum[1] += forces[found.acting[k] + kLanes];
      }
      found.force[gridpoint.slot] = sum;
    }
  }

  /// Returns the square of the longest way of a watched gridpoint since the last search, m².
  /// \param first, last  entries of FoundRows::watched
  static double way(const State<2>& s, int first, int last) {
    const FoundRows& found = *s.found;
    Real longest = 0.0;
    for (int i = first; i < last; ++i) {
      const int slot = slot_of(found.watched[i], 0);
      const Vector moved = R::load(&s.displacement[slot]) - R::load(&found.searched[slot]);
      longest = larger(longest, dot(moved, moved));
    }
    return largest(longest);
  }

 private:
  [[gnu::flatten]] static void update_row(const State<2>& s, FoundRows& found, int index) {
    FoundRow& row = found.rows[index];
    VectorPack<2>* const forces = &found.forces[4 * index];
    const auto corner = [&](int i) {
      return R::gather(s.gathered_position, row.corners[i]) + R::gather(s.displacement, row.corners[i]);
    };
    const Real zero = 0.0;
    const EdgePair<Real> p =
        edge_pair<Real>({corner(0), corner(1)}, {corner(2), corner(3)}, Real::load(row.unloaded_a.number),
                        Real::load(row.unloaded_b.number));
    const std::array<Real, 2> gap{p.gap[0] + Real::load(row.offset[0].number),
                                  p.gap[1] + Real::load(row.offset[1].number)};
    const std::array<Real, 2> area_before{Real::load(row.area[0].number), Real::load(row.area[1].number)};
    const Real most_depth = Real::load(row.most_depth.number);
    const auto is_pressed = [&](int k) { return (gap[k] < zero) & (zero - gap[k] < most_depth); };
    const Truth handed_over = p.face & Truth::from_bits(row.handed_over);
    const Truth touches = p.face & (is_pressed(0) | is_pressed(1));
    // most rows stand apart
    if (!any(touches | handed_over | (area_before[0] > zero) | (area_before[1] > zero) | is_damped(row))) {
      if (row.handed_over != 0) let_go(s, row, 0);
      zero.store(row.not_counted.number);
      for (int i = 0; i < 4; ++i) R::store(Vector{}, forces[i].c);
      for (Line* line : {&row.stored, &row.applied}) zero.store(line->number);
      return;
    }
    const Real not_counted = select(touches, smaller(Real::load(row.not_counted.number), p.overlap), zero);
    not_counted.store(row.not_counted.number);
    if (row.handed_over != 0) let_go(s, row, bits_of(handed_over));
    EndAreas<Real> areas(p, Real::load(row.thickness.number), not_counted, gap);
    EndTractions<Real> tractions;
    Real stored = zero;
    const auto way = found.is_damped ? gap_ways(s, row, p) : std::array<Real, 2>{zero, zero};
    for (int k = 0; k < 2; ++k) {
      const Truth acts = p.face & Truth::from_bits(row.counts[k]) & (areas.area[k] > zero) &
                         (areas.counted > zero) & (is_pressed(k) | handed_over);
      auto& end = areas.ends[k];
      areas.area[k] = select(acts, areas.area[k], zero);
      for (Real* number : {&end.depth, &end.share, &end.slope}) *number = select(acts, *number, zero);
      stored += press_end(s, row, k, acts, gap[k], p.slide[k], area_before[k], areas.area[k], tractions);
    }
    for (int k = 0; found.is_damped && k < 2; ++k)
      damp(s, row, k, way[k], areas.area[k], tractions.normal[k]);
    stored.store(row.stored.number);
    auto f = corner_forces(p, areas, tractions);
    const Truth loaded = (areas.area[0] > zero) | (areas.area[1] > zero);
    Real applied = zero;
    for (int i = 0; i < 4; ++i) {
      f[i] = R::where(loaded, f[i]);
      applied += norm(f[i]);
      R::store(f[i], forces[i].c);
    }
    applied.store(row.applied.number);
  }

  /// Takes one end of eight pairs through its law, and books its losses. Returns the energy stored, J.
  static Real press_end(const State<2>& s, FoundRow& row, int k, const Truth& acts, const Real& gap,
                        const Real& slide, const Real& area_before, const Real& area,
                        EndTractions<Real>& tractions) {
    const Real zero = 0.0;
    FoundRows& found = *s.found;
    const LawOfRows& law = found.laws[row.law];
    Line* const internals = &found.internals[row.first_internal + k * law.internals];
    const Real stiffness = Real::load(row.shear_stiffness[k].number);
    Real held = Real::load(row.held[k].number), shift = Real::load(row.shift[k].number);
    // The elastic jump of a new end is zero. Where the area grows the force stays and energy is lost; where
    // it shrinks the jump stays, and the energy of what leaves is lost.
    const Truth presses_on = acts & (area_before > zero);
    const Truth grows = presses_on & (area > area_before);
    const Real held_on = select(grows, held * (area_before / area), held);
    const Real lost =
        select(presses_on,
               0.5 * stiffness *
                   (held * held * area_before - held_on * held_on * select(grows, area, area_before)),
               zero) +
        select(presses_on & (area < area_before), 0.5 * stiffness * held * held * (area_before - area), zero);
    (Real::load(row.lost_area.number) + lost).store(row.lost_area.number);
    shift = select(presses_on, shift - (held - held_on), zero - slide);
    if (law.held_jump >= 0) {
      double* const number = internals[law.held_jump].number;
      select(grows, abs(held_on), Real::load(number)).store(number);
    }
    std::array<Line, 2> jump;
    select(acts, gap, Real(kOpen)).store(jump[0].number);
    select(acts, slide + shift, zero).store(jump[1].number);
    Line losses[LawOfRows::kMost];
    for (int i = 0; i < law.losses; ++i) zero.store(losses[i].number);
    const LanesResponse response = s.laws[row.law].update_lanes(
        &found.choices[row.first_choice], &found.constants[row.first_constant + k * law.constants],
        jump.data(), internals, losses);
    if (response.changed != 0) {
      const Real area_of_losses = select(acts, area, area_before);
      for (int i = 0; i < law.losses; ++i) {
        double* const number = found.lost[row.first_loss + i].number;
        (Real::load(number) + Real::load(losses[i].number) * area_of_losses).store(number);
      }
    }
    if (any(!acts))
      for (int i = 0; i < law.internals; ++i)
        select(acts, Real::load(internals[i].number), Real(law.broken[i])).store(internals[i].number);
    const auto kept = [&](const Real& number, Line& line) { select(acts, number, zero).store(line.number); };
    const Real shear = select(acts, Real::load(response.shear_traction[0].number), zero);
    held = shear / stiffness;
    const Real stored = select(acts, Real::load(response.stored.number), zero);
    kept(area, row.area[k]);
    kept(held, row.held[k]);
    kept(shift, row.shift[k]);
    tractions.normal[k] = select(acts, Real::load(response.normal_traction.number), zero);
    tractions.shear[k] = shear;
    tractions.stored[k] = stored - 0.5 * shear * held;
    return stored * area;
  }

  /// Tells where damping still acted in the last step.
  static Truth is_damped(const FoundRow& row) {
    return (abs(Real::load(row.damped[0].number)) > Real(0.0)) |
           (abs(Real::load(row.damped[1].number)) > Real(0.0));
  }

  /// Returns how far the gap of each end has opened in the last step, m.
  static std::array<Real, 2> gap_ways(const State<2>& s, const FoundRow& row, const EdgePair<Real>& now) {
    const auto before = [&](int i) {
      Line velocity[2];
      for (int lane = 0; lane < kLanes; ++lane) {
        const int slot = row.corners[i][lane] / offset_of<2>(1);
        for (int j = 0; j < 2; ++j) velocity[j].number[lane] = s.velocity[slot / kLanes].c[j][slot % kLanes];
      }
      const Vector v{{Real::load(velocity[0].number), Real::load(velocity[1].number)}};
      return R::gather(s.gathered_position, row.corners[i]) + R::gather(s.displacement, row.corners[i]) -
             v * Real(s.time_step);
    };
    const auto p = edge_pair<Real>({before(0), before(1)}, {before(2), before(3)},
                                   Real::load(row.unloaded_a.number), Real::load(row.unloaded_b.number));
    return {now.gap[0] - p.gap[0], now.gap[1] - p.gap[1]};
  }

  /// Damps one end of eight pairs while it is pressed, and books the work by the trapezoidal rule, as the
  /// ledger does that of forces.
  static void damp(const State<2>& s, FoundRow& row, int k, const Real& way, const Real& area,
                   Real& traction) {
    const Real zero = 0.0;
    const Truth presses = (area > zero) & (traction < zero);
    const Real more = select(
        presses, smaller(Real::load(row.damping.number) * way * Real(1.0 / s.time_step), zero - traction),
        zero);
    traction += more;
    if (!s.found->moves) return;
    const Real force = more * area, before = Real::load(row.damped[k].number);
    const Real work =
        select((abs(force) > zero) | (abs(before) > zero), (force + before) * Real(0.5) * way, zero);
    (Real::load(row.lost_damping.number) + work).store(row.lost_damping.number);
    force.store(row.damped[k].number);
  }

  /// Makes those handed-over pairs whose edges have left each other new ones.
  /// \param still  bits of those that go on
  static void let_go(const State<2>& s, FoundRow& row, std::uint32_t still) {
    for (int lane = 0; lane < kLanes; ++lane)
      if (((row.handed_over & ~still) >> static_cast<unsigned>(lane) & 1U) != 0) {
        row.thickness.number[lane] = s.thickness;
        for (Line& offset : row.offset) offset.number[lane] = 0.0;
      }
    row.handed_over = still;
  }

  static std::uint32_t bits_of(const Truth& condition) {
    Line line;
    select(condition, Real(1.0), Real(0.0)).store(line.number);
    std::uint32_t bits = 0;
    for (int lane = 0; lane < kLanes; ++lane)
      if (line.number[lane] != 0.0) bits |= 1U << static_cast<unsigned>(lane);
    return bits;
  }

  static constexpr double kOpen = 1.0;  ///< opening of an end that does not press, m
};

}  // namespace pyroclast
