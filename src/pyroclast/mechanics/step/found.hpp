#pragma once

#include <array>
#include <limits>

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
    FoundRows& found = *s.found;
    for (int row = first; row < last; ++row)
      if (!(found.way < found.rows[row].wakes)) update_row(s, found, row);
  }

  /// Adds the forces of rows on the gridpoints of a bundle.
  /// \param index  index of the bundle
  /// \param sum    sums of forces by pack from the bundle's first on, N
  static void add_forces(const FoundRows& found, const Bundle& bundle, int index, VectorPack<2>* sum) {
    for (int i = found.loaded_of_bundle[index]; i < found.loaded_of_bundle[index + 1]; ++i) {
      const LoadedGridpoint& gridpoint = found.loaded[i];
      if (found.way < gridpoint.wakes) continue;
      Vec<2> force{};
      for (int k = gridpoint.first_force; k < gridpoint.last_force; ++k)
        force += found.forces[found.acting[k]];
      auto& of_pack = sum[gridpoint.slot / kLanes - bundle.first_pack].c;
      for (int j = 0; j < 2; ++j) of_pack[j][gridpoint.slot % kLanes] += force[j];
    }
  }

  /// Returns the square of the longest way of a watched gridpoint since the last search, over that of the way
  /// that it may go before the next one.
  /// \param first, last  entries of FoundRows::watched
  static double way(const State<2>& s, int first, int last) {
    const FoundRows& found = *s.found;
    Real longest = 0.0;
    for (int i = first; i < last; ++i) {
      const WatchedPack& watched = found.watched[i];
      const int slot = slot_of(watched.pack, 0);
      const Vector moved = R::load(&s.displacement[slot]) - R::load(&found.searched[slot]);
      longest = larger(longest, dot(moved, moved) * Real::load(watched.over_way.number));
    }
    return largest(longest);
  }

 private:
  /// Corners, pairs and conditions of a row in a step.
  struct Now {
    Truth handed_over;             ///< pairs that are handed over, and face each other
    std::array<Truth, 2> goes_in;  ///< ends whose gap asks the law
    std::array<Real, 2> gap, area_before;
  };

  [[gnu::flatten]] static void update_row(const State<2>& s, FoundRows& found, int index) {
    FoundRow& row = found.rows[index];
    Vec<2>* const forces = &found.forces[4 * kLanes * index];
    const auto corner = [&](int i) {
      return R::gather(s.gathered_position, row.corners[i]) + R::gather(s.displacement, row.corners[i]);
    };
    const Real zero = 0.0;
    const EdgePair<Real> p =
        edge_pair<Real>({corner(0), corner(1)}, {corner(2), corner(3)}, Real::load(row.unloaded_a.number),
                        Real::load(row.unloaded_b.number));
    Now now;
    const Truth was_handed_over = Truth::from_bits(row.handed_over);
    now.handed_over = p.face & was_handed_over;
    const Real most_depth = Real::load(row.most_depth.number);
    for (int k = 0; k < 2; ++k) {
      now.gap[k] = p.gap[k] + Real::load(row.offset[k].number);
      now.area_before[k] = Real::load(row.area[k].number);
      now.goes_in[k] =
          p.face & (now.gap[k] < Real::load(row.rest[k].number)) & (zero - now.gap[k] < most_depth);
    }
    const Truth touches = now.goes_in[0] | now.goes_in[1];
    const bool works =
        any(touches | (now.area_before[0] > zero) | (now.area_before[1] > zero) | is_damped(row));
    const auto leaves = was_handed_over & !p.face;
    // most rows stand apart, or rest
    if (!works) {
      if (row.handed_over != 0 && any(leaves)) let_go(s, row, leaves);
      if (!row.rests) rest(row, forces);
      return;
    }
    row.rests = false;
    const Real not_counted = select(touches, smaller(Real::load(row.not_counted.number), p.overlap), zero);
    not_counted.store(row.not_counted.number);
    if (row.handed_over != 0 && any(leaves)) set_apart(s, row, leaves);
    EndAreas<Real> areas(p, Real::load(row.thickness.number), not_counted, most_depth, now.gap);
    EndTractions<Real> tractions;
    Real stored = zero;
    const auto way = found.is_damped ? gap_ways(s, row, p) : std::array<Real, 2>{zero, zero};
    for (int k = 0; k < 2; ++k) {
      const Truth acts = p.face & Truth::from_bits(row.counts[k]) & (areas.area[k] > zero) &
                         (areas.counted > zero) &
                         (now.goes_in[k] | (now.handed_over & (now.area_before[k] > zero)));
      if (any(acts | (now.area_before[k] > zero))) {
        stored += press_end(s, row, k, acts, now, p.slide[k], areas.area[k], tractions);
      } else {
        areas.area[k] = zero;
        forget(s, row, k, leaves);
      }
      const Truth bears = areas.area[k] > zero;
      auto& end = areas.ends[k];
      for (Real* number : {&end.depth, &end.share, &end.slope}) *number = select(bears, *number, zero);
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
      R::store(f[i], &forces[i * kLanes]);
    }
    applied.store(row.applied.number);
  }

  /// Writes what follows where no pair of a row presses.
  static void rest(FoundRow& row, Vec<2>* forces) {
    const Real zero = 0.0;
    for (int i = 0; i < 4; ++i) R::store(Vector{}, &forces[i * kLanes]);
    for (Line* line : {&row.not_counted, &row.stored, &row.applied}) zero.store(line->number);
    row.rests = true;
  }

  /// Takes one end of eight pairs through its law, and books its losses. Returns the energy stored, J.
  /// \param acts  ends that may press
  /// \param area  in and out: areas; zero where an end bears nothing, m²
  static Real press_end(const State<2>& s, FoundRow& row, int k, const Truth& acts, const Now& now,
                        const Real& slide, Real& area, EndTractions<Real>& tractions) {
    const Real zero = 0.0;
    FoundRows& found = *s.found;
    const LawOfRows& law = found.laws[row.law];
    Line* const internals = &found.internals[row.first_internal + k * law.internals];
    const Real stiffness = Real::load(row.shear_stiffness[k].number);
    const Real& area_before = now.area_before[k];
    area = select(acts, area, zero);
    Real held = Real::load(row.held[k].number), shift = Real::load(row.shift[k].number);
    // An end that begins to press goes on from the jump at which it rested. Where the area grows the force
    // stays and energy is lost; where it shrinks the jump stays, and the energy of what leaves is lost.
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
    const Truth rested = !(area_before > zero);
    shift = select(rested, shift - slide, shift - select(presses_on, held - held_on, zero));
    if (law.held_jump >= 0) {
      double* const number = internals[law.held_jump].number;
      select(grows, abs(held_on), Real::load(number)).store(number);
    }
    std::array<Line, 2> jump;
    select(acts, now.gap[k], Real(kOpen)).store(jump[0].number);
    select(acts, slide + shift, zero).store(jump[1].number);
    Line losses[LawOfRows::kMost], before[LawOfRows::kMost];
    for (int i = 0; i < law.losses; ++i) zero.store(losses[i].number);
    const Truth keeps = now.handed_over & !acts;
    const bool some_keep = any(keeps);
    for (int i = 0; some_keep && i < law.internals; ++i) before[i] = internals[i];
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
      for (int i = 0; i < law.internals; ++i) {
        const Real kept = some_keep ? select(keeps, Real::load(before[i].number), Real(law.broken[i]))
                                    : Real(law.broken[i]);
        select(acts, Real::load(internals[i].number), kept).store(internals[i].number);
      }
    const Real normal = select(acts, Real::load(response.normal_traction.number), zero);
    const Real shear = select(acts, Real::load(response.shear_traction[0].number), zero);
    // An end that is handed over and bears nothing rests, with its jump, until its gap falls below the
    // present one; one that is too deep is asked again in each step.
    const Truth pulls_or_presses = (abs(normal) > zero) | (abs(shear) > zero);
    const Truth bears = acts & (pulls_or_presses | (!now.handed_over));
    const Truth begins_to_rest = now.handed_over & !bears & (acts | !rested);
    const Real rest_at = select(acts, now.gap[k], Real(kAlwaysAsked));
    select(begins_to_rest, rest_at, Real::load(row.rest[k].number)).store(row.rest[k].number);
    const Real jump_at_rest = select(keeps & rested, Real::load(row.shift[k].number), slide + shift);
    area = select(bears, area, zero);
    held = select(bears, shear / stiffness, zero);
    area.store(row.area[k].number);
    held.store(row.held[k].number);
    select(bears, shift, select(now.handed_over, jump_at_rest, zero)).store(row.shift[k].number);
    tractions.normal[k] = normal;
    tractions.shear[k] = shear;
    const Real stored = select(acts, Real::load(response.stored.number), zero);
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

  /// Makes handed-over pairs whose edges have left each other new ones, but for what they still bear.
  static void set_apart(const State<2>& s, FoundRow& row, const Truth& leaves) {
    const Real zero = 0.0;
    select(leaves, Real(s.thickness), Real::load(row.thickness.number)).store(row.thickness.number);
    for (int k = 0; k < 2; ++k)
      for (Line* line : {&row.offset[k], &row.rest[k]})
        select(leaves, zero, Real::load(line->number)).store(line->number);
    row.handed_over &= ~bits_of(leaves);
  }

  /// Makes handed-over pairs that rest, and whose edges have left each other, new ones.
  static void let_go(const State<2>& s, FoundRow& row, const Truth& leaves) {
    set_apart(s, row, leaves);
    for (int k = 0; k < 2; ++k) forget(s, row, k, leaves);
  }

  /// Takes the history of one end from pairs that rest and leave each other.
  static void forget(const State<2>& s, FoundRow& row, int k, const Truth& leaves) {
    if (!any(leaves)) return;
    const LawOfRows& law = s.found->laws[row.law];
    select(leaves, Real(0.0), Real::load(row.shift[k].number)).store(row.shift[k].number);
    Line* const internals = &s.found->internals[row.first_internal + k * law.internals];
    for (int i = 0; i < law.internals; ++i)
      select(leaves, Real(law.broken[i]), Real::load(internals[i].number)).store(internals[i].number);
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
  static constexpr double kAlwaysAsked = std::numeric_limits<double>::max();  ///< opening, m
};

}  // namespace pyroclast
