#pragma once

#include <array>
#include <bit>
#include <limits>
#include <optional>

#include "pyroclast/mechanics/found/carry_over.hpp"
#include "pyroclast/mechanics/found/edge_pair.hpp"
#include "pyroclast/mechanics/found/rows.hpp"
#include "pyroclast/mechanics/step/packs.hpp"

/// Contacts that are found: rows of eight pairs of facets, from places to jumps to tractions to forces.
namespace pyroclast {

template <int Dim, class Set>
struct FoundContactForces {
  using R = Packs<Dim, Set>;
  using Real = typename R::Real;
  using Truth = typename Real::Truth;
  using Vector = typename R::Vector;
  using Row = FoundRow<Dim>;
  using Jump = Tangential<Dim, Real>;

  static constexpr int kPoints = Row::kPoints, kCorners = Row::kCorners;

  /// Computes the forces of rows.
  static void update(State<Dim>& s, int first, int last) {
    FoundRows<Dim>& found = *s.found;
    for (int row = first; row < last; ++row)
      if (!(found.way < found.rows[row].wakes)) update_row(s, found, row);
  }

  /// Adds the forces of rows on the gridpoints of a bundle.
  /// \param index  index of the bundle
  /// \param sum    sums of forces by pack from the bundle's first on, N
  static void add_forces(const FoundRows<Dim>& found, const Bundle& bundle, int index, VectorPack<Dim>* sum) {
    for (int i = found.loaded_of_bundle[index]; i < found.loaded_of_bundle[index + 1]; ++i) {
      const LoadedGridpoint& gridpoint = found.loaded[i];
      if (found.way < gridpoint.wakes) continue;
      Vec<Dim> force{};
      for (int k = gridpoint.first_force; k < gridpoint.last_force; ++k)
        force += found.forces[found.acting[k]];
      auto& of_pack = sum[gridpoint.slot / kLanes - bundle.first_pack].c;
      for (int j = 0; j < Dim; ++j) of_pack[j][gridpoint.slot % kLanes] += force[j];
    }
  }

  /// Returns the square of the longest way of a watched gridpoint since the last search, over that of the way
  /// that it may go before the next one.
  /// \param first, last  entries of FoundRows::watched
  static double way(const State<Dim>& s, int first, int last) {
    const FoundRows<Dim>& found = *s.found;
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
  /// Conditions and gaps of a row in a step.
  struct Now {
    Truth handed_over;                   ///< pairs that are handed over, and face each other
    std::array<Truth, kPoints> goes_in;  ///< points whose gap asks the law
    std::array<Real, kPoints> gap, area_before;
  };

  /// Answer of the law at a point.
  struct Tractions {
    Real normal, stored;  ///< Pa; energy of the normal part, J/m²
    Jump shear;           ///< Pa
  };

  static Jump load(const typename Row::Jump& lines) {
    Jump jump;
    for (int i = 0; i + 1 < Dim; ++i) jump[i] = Real::load(lines[i].number);
    return jump;
  }
  static void store(const Jump& jump, typename Row::Jump& lines) {
    for (int i = 0; i + 1 < Dim; ++i) jump[i].store(lines[i].number);
  }
  static Jump choose(const Truth& condition, const Jump& yes, const Jump& no) {
    Jump jump;
    for (int i = 0; i + 1 < Dim; ++i) jump[i] = select(condition, yes[i], no[i]);
    return jump;
  }

  static Vector corner(const State<Dim>& s, const Row& row, int i) {
    return R::gather(s.gathered_position, row.corners[i]) + R::gather(s.displacement, row.corners[i]);
  }

  [[gnu::flatten]] static void update_row(const State<Dim>& s, FoundRows<Dim>& found, int index) {
    if constexpr (Dim == 2)
      update_edges(s, found, index);
    else
      update_triangles(s, found, index);
  }

  static void update_edges(const State<Dim>& s, FoundRows<Dim>& found, int index) {
    Row& row = found.rows[index];
    Vec<Dim>* const forces = &found.forces[kCorners * kLanes * index];
    const Real zero = 0.0;
    const EdgePair<Real> p =
        edge_pair<Real>({corner(s, row, 0), corner(s, row, 1)}, {corner(s, row, 2), corner(s, row, 3)},
                        Real::load(row.unloaded_a.number), Real::load(row.unloaded_b.number));
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
        Tractions t;
        stored += press_point(s, row, k, acts, now, {{p.slide[k]}}, areas.area[k], t);
        tractions.normal[k] = t.normal;
        tractions.shear[k] = t.shear[0];
        tractions.stored[k] = t.stored;
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

  /// Bits of lanes that are touched, and numbers of their points as the law takes them.
  struct Touched {
    std::uint32_t faces = 0;                          ///< lanes whose triangles face each other and overlap
    std::array<std::uint32_t, kPoints> counts{};      ///< points that there are, and that may press
    std::array<Line, kPoints> gap{}, area{}, way{};   ///< m, m², m
    std::array<typename Row::Jump, kPoints> slide{};  ///< m
  };

  /// Overlaps and the law's tractions differ from lane to lane, so a row goes through the geometry pair by
  /// pair, and through the law point by point.
  static void update_triangles(const State<Dim>& s, FoundRows<Dim>& found, int index) {
    Row& row = found.rows[index];
    Vec<Dim>* const forces = &found.forces[kCorners * kLanes * index];
    const Real zero = 0.0;
    std::array<Vector, kCorners> at;
    for (int i = 0; i < kCorners; ++i) at[i] = corner(s, row, i);
    const Lie lie = lie_of(at);
    const Truth was_handed_over = Truth::from_bits(row.handed_over);
    Truth bore = zero > zero;
    Real rest_below = 0.0;
    for (int k = 0; k < kPoints; ++k) {
      bore = bore | (Real::load(row.area[k].number) > zero);
      rest_below = larger(rest_below, Real::load(row.rest[k].number) - Real::load(row.offset[k].number));
    }
    // most pairs stand apart, lie beside each other, or rest; overlaps of the others are taken one by one
    const Truth rests_on = was_handed_over & (!bore) & lie.over & (lie.gap > rest_below + Real(kRounding));
    const Truth is_asked =
        (!lie.beside) & (!rests_on) & (was_handed_over | bore | (lie.gap < Real(kRounding)));
    if (row.rests && !any(is_asked | (was_handed_over & lie.beside))) return;

    alignas(64) std::array<std::array<Vec<Dim>, kLanes>, kCorners> places;
    for (int i = 0; i < kCorners; ++i) R::store(at[i], places[i].data());
    std::array<std::optional<TouchedPair>, kLanes> pairs;
    Touched touched{.faces = bits_of(rests_on)};
    for (std::uint32_t asked = bits_of(is_asked); asked != 0; asked &= asked - 1) {
      const int lane = std::countr_zero(asked);
      TriangleCorners corners;
      for (int i = 0; i < kCorners; ++i) corners[i] = places[i][lane];
      touch(s, found, row, lane, corners, pairs[lane].emplace(), touched);
    }
    row.rests = false;
    select(is_asked, Real::load(row.not_counted.number), zero).store(row.not_counted.number);
    const Truth face = Truth::from_bits(touched.faces);
    const auto leaves = was_handed_over & !face;
    if (row.handed_over != 0 && any(leaves)) set_apart(s, row, leaves);

    Now now;
    now.handed_over = face & was_handed_over;
    const Real most_depth = Real::load(row.most_depth.number);
    std::array<Tractions, kPoints> tractions;
    std::array<Line, kPoints> area{};
    Real stored = zero;
    Truth loaded = zero > zero;
    for (int k = 0; k < kPoints; ++k) {
      now.gap[k] = Real::load(touched.gap[k].number);
      now.area_before[k] = Real::load(row.area[k].number);
      now.goes_in[k] =
          face & (now.gap[k] < Real::load(row.rest[k].number)) & (zero - now.gap[k] < most_depth);
      Real area_now = Real::load(touched.area[k].number);
      const Truth acts = face & Truth::from_bits(touched.counts[k]) & (area_now > zero) &
                         (now.goes_in[k] | (now.handed_over & (now.area_before[k] > zero)));
      if (any(acts | (now.area_before[k] > zero))) {
        const Truth rested = !(now.area_before[k] > zero);
        const Jump slide = choose(rested, Jump{}, load(touched.slide[k]));
        stored += press_point(s, row, k, acts, now, slide, area_now, tractions[k]);
      } else {
        area_now = zero;
        tractions[k] = {zero, zero, Jump{}};
        forget(s, row, k, leaves);
      }
      if (found.is_damped) damp(s, row, k, Real::load(touched.way[k].number), area_now, tractions[k].normal);
      area_now.store(area[k].number);
      loaded = loaded | (area_now > zero);
    }
    stored.store(row.stored.number);
    const std::uint32_t bearing = bits_of(loaded);
    const Truth remembers = (Real::load(row.not_counted.number) > zero) | is_damped(row);
    const bool presses = bearing != 0 || any(remembers);
    if (!presses && row.handed_over == 0) {
      row.overlap.fill({});
      rest(row, forces);
      return;
    }
    place_forces(row, bearing, pairs, area, tractions, forces);
    row.rests = !presses;
  }

  /// How eight pairs of triangles lie, seen along the mean normal.
  struct Lie {
    Truth beside;  ///< one triangle lies beyond an edge of the other
    Truth over;    ///< they face each other, and the middle of one lies over the other
    Real gap;      ///< bound below which no gap of them lies, m
  };

  static Lie lie_of(const std::array<Vector, kCorners>& at) {
    const Vector area_a = cross(at[1] - at[0], at[2] - at[0]), area_b = cross(at[4] - at[3], at[5] - at[3]);
    const Vector normal = area_a + area_b;
    const Truth none = Truth::from_bits(0);
    Lie lie{none, none, 0.0};
    for (int own : {0, 3}) {
      const int other = 3 - own;
      const Vector middle = (at[other] + at[other + 1] + at[other + 2]) * Real(1.0 / 3.0);
      Truth is_within = dot(area_a, area_b) > Real(0.0);
      for (int i = 0; i < 3; ++i) {
        const Vector& from = at[own + i];
        const Vector inwards = cross(normal, at[own + (i + 1) % 3] - from);
        const Real surely = dot(inwards, at[own + (i + 2) % 3] - from) * Real(kSurely);
        Real most = dot(inwards, at[other] - from);
        for (int k = 1; k < 3; ++k) most = larger(most, dot(inwards, at[other + k] - from));
        lie.beside = lie.beside | (most < -surely);
        is_within = is_within & (dot(inwards, middle - from) > surely);
      }
      lie.over = lie.over | is_within;
    }
    // no corner of b lies less above the plane of a, and none of a less below that of b
    Real above = dot(area_a, at[3] - at[0]), below = dot(area_b, at[3] - at[0]);
    for (int i = 1; i < 3; ++i) {
      above = smaller(above, dot(area_a, at[3 + i] - at[0]));
      below = smaller(below, dot(area_b, at[3] - at[i]));
    }
    lie.gap = larger(above / dot(area_a, normal), below / dot(area_b, normal)) * norm(normal);
    return lie;
  }

  /// Takes one pair to its overlap and the areas of its points, which go on from those of the last step.
  static void touch(const State<Dim>& s, FoundRows<Dim>& found, Row& row, int lane,
                    const TriangleCorners& corners, TouchedPair& pair, Touched& touched) {
    const double thickness = row.thickness.number[lane];
    if (thickness == 0.0) return;
    const auto bit = 1U << static_cast<unsigned>(lane);
    if (!touch_pair(found, row, lane, corners, pair)) {
      row.not_counted.number[lane] = 0.0;
      return;
    }
    touched.faces |= bit;
    for (int k = 0; k < pair.overlap.count; ++k) {
      if (pair.counts[k]) touched.counts[k] |= bit;
      touched.gap[k].number[lane] = pair.gap[k];
      touched.area[k].number[lane] = pair.areas.area[k];
      for (int i = 0; i + 1 < Dim; ++i) touched.slide[k][i].number[lane] = pair.slide[k][i];
    }
    if (!found.is_damped) return;
    TriangleCorners velocity;
    for (int i = 0; i < kCorners; ++i)
      velocity[i] = vector_at<Dim>(s.velocity, row.corners[i][lane] / offset_of<Dim>(1));
    for (int k = 0; k < pair.overlap.count; ++k)
      touched.way[k].number[lane] = pair.opening_velocity(k, velocity) * s.time_step;
  }

  /// Writes the forces of a row, and the places from which it goes on.
  static void place_forces(Row& row, std::uint32_t bearing,
                           std::array<std::optional<TouchedPair>, kLanes>& pairs,
                           const std::array<Line, kPoints>& area,
                           const std::array<Tractions, kPoints>& tractions, Vec<Dim>* forces) {
    struct Lines {
      Line normal, stored;
      typename Row::Jump shear;
    };
    std::array<Lines, kPoints> lines;
    for (int k = 0; k < kPoints; ++k) {
      tractions[k].normal.store(lines[k].normal.number);
      tractions[k].stored.store(lines[k].stored.number);
      store(tractions[k].shear, lines[k].shear);
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      TriangleCorners f{};
      double applied = 0.0;
      const bool bears = (bearing >> static_cast<unsigned>(lane) & 1U) != 0;
      if (bears) {
        TouchedPair& pair = *pairs[lane];
        PointTractions<double> t;
        for (int k = 0; k < pair.overlap.count; ++k) {
          pair.keep_area(k, area[k].number[lane]);
          t.normal[k] = lines[k].normal.number[lane];
          t.stored[k] = lines[k].stored.number[lane];
          t.shear[k] = pair.tangents[0] * lines[k].shear[0].number[lane] +
                       pair.tangents[1] * lines[k].shear[1].number[lane];
        }
        f = corner_forces(pair.overlap, pair.pair, pair.areas, t);
      }
      if (bears || (pairs[lane] && pairs[lane]->is_carried_over)) {
        row.pressed_at[lane] = pairs[lane]->corners;
        row.overlap[lane] = pairs[lane]->overlap;
      } else if ((row.handed_over >> static_cast<unsigned>(lane) & 1U) == 0) {
        row.overlap[lane] = {};
      }
      for (int i = 0; i < kCorners; ++i) {
        if (bears) applied += norm(f[i]);
        forces[i * kLanes + lane] = f[i];
      }
      row.applied.number[lane] = applied;
    }
  }

  /// Writes what follows where no pair of a row presses.
  static void rest(Row& row, Vec<Dim>* forces) {
    const Real zero = 0.0;
    for (int i = 0; i < kCorners; ++i) R::store(Vector{}, &forces[i * kLanes]);
    for (Line* line : {&row.not_counted, &row.stored, &row.applied}) zero.store(line->number);
    row.rests = true;
  }

  /// Takes one point of eight pairs through its law, and books its losses. Returns the energy stored, J.
  /// \param acts   points that may press
  /// \param slide  see PairPoint::shift
  /// \param area   in and out: areas; zero where a point bears nothing, m²
  static Real press_point(const State<Dim>& s, Row& row, int k, const Truth& acts, const Now& now,
                          const Jump& slide, Real& area, Tractions& tractions) {
    const Real zero = 0.0;
    FoundRows<Dim>& found = *s.found;
    const LawOfRows& law = found.laws[row.law];
    const int set = set_of_point<Dim>(k);
    Line* const internals = &found.internals[row.first_internal + k * law.internals];
    const Real stiffness = Real::load(row.shear_stiffness[set].number);
    const Real& area_before = now.area_before[k];
    area = select(acts, area, zero);
    Jump held = load(row.held[k]), shift = load(row.shift[k]);
    // A point that begins to press goes on from the jump at which it rested. Where the area grows the force
    // stays and energy is lost; where it shrinks the jump stays, and the energy of what leaves is lost.
    const Truth presses_on = acts & (area_before > zero);
    const Truth grows = presses_on & (area > area_before);
    const Jump held_on = choose(grows, held * (area_before / area), held);
    Real shrunk = 0.5 * stiffness * held[0] * held[0] * (area_before - area);
    for (int i = 1; i + 1 < Dim; ++i) shrunk += 0.5 * stiffness * held[i] * held[i] * (area_before - area);
    const Real lost =
        select(presses_on,
               0.5 * stiffness *
                   (dot(held, held) * area_before - dot(held_on, held_on) * select(grows, area, area_before)),
               zero) +
        select(presses_on & (area < area_before), shrunk, zero);
    (Real::load(row.lost_area.number) + lost).store(row.lost_area.number);
    const Truth rested = !(area_before > zero);
    shift = choose(rested, shift - slide, shift - choose(presses_on, held - held_on, Jump{}));
    if (law.held_jump >= 0) {
      double* const number = internals[law.held_jump].number;
      select(grows, norm(held_on), Real::load(number)).store(number);
    }
    std::array<Line, Dim> jump;
    select(acts, now.gap[k], Real(kOpen)).store(jump[0].number);
    for (int i = 0; i + 1 < Dim; ++i) select(acts, slide[i] + shift[i], zero).store(jump[i + 1].number);
    Line losses[LawOfRows::kMost], before[LawOfRows::kMost];
    for (int i = 0; i < law.losses; ++i) zero.store(losses[i].number);
    const Truth keeps = now.handed_over & !acts;
    const bool some_keep = any(keeps);
    for (int i = 0; some_keep && i < law.internals; ++i) before[i] = internals[i];
    const LanesResponse response = s.laws[row.law].update_lanes(
        &found.choices[row.first_choice], &found.constants[row.first_constant + set * law.constants],
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
    Jump shear;
    for (int i = 0; i + 1 < Dim; ++i)
      shear[i] = select(acts, Real::load(response.shear_traction[i].number), zero);
    // A point that is handed over and bears nothing rests, with its jump, until its gap falls below the
    // present one; one that is too deep is asked again in each step.
    const Truth pulls_or_presses = (abs(normal) > zero) | (norm(shear) > zero);
    const Truth bears = acts & (pulls_or_presses | (!now.handed_over));
    const Truth begins_to_rest = now.handed_over & !bears & (acts | !rested);
    const Real rest_at = select(acts, now.gap[k], Real(kAlwaysAsked));
    select(begins_to_rest, rest_at, Real::load(row.rest[k].number)).store(row.rest[k].number);
    const Jump jump_at_rest = choose(keeps & rested, load(row.shift[k]), slide + shift);
    area = select(bears, area, zero);
    for (int i = 0; i + 1 < Dim; ++i) held[i] = select(bears, shear[i] / stiffness, zero);
    area.store(row.area[k].number);
    store(held, row.held[k]);
    // the slide of the next step begins at the places of this one, or where the edges began
    const Jump shift_on = Dim == 2 ? shift : slide + shift;
    store(choose(bears, shift_on, choose(now.handed_over, jump_at_rest, Jump{})), row.shift[k]);
    tractions.normal = normal;
    tractions.shear = shear;
    const Real stored = select(acts, Real::load(response.stored.number), zero);
    tractions.stored = stored;
    for (int i = 0; i + 1 < Dim; ++i) tractions.stored = tractions.stored - 0.5 * shear[i] * held[i];
    return stored * area;
  }

  /// Tells where damping still acted in the last step.
  static Truth is_damped(const Row& row) {
    Truth damped = abs(Real::load(row.damped[0].number)) > Real(0.0);
    for (int k = 1; k < kPoints; ++k) damped = damped | (abs(Real::load(row.damped[k].number)) > Real(0.0));
    return damped;
  }

  /// Returns how far the gap of each end has opened in the last step, m.
  static std::array<Real, 2> gap_ways(const State<Dim>& s, const Row& row, const EdgePair<Real>& now) {
    const auto before = [&](int i) {
      Line velocity[2];
      for (int lane = 0; lane < kLanes; ++lane) {
        const int slot = row.corners[i][lane] / offset_of<2>(1);
        for (int j = 0; j < 2; ++j) velocity[j].number[lane] = s.velocity[slot / kLanes].c[j][slot % kLanes];
      }
      const Vector v{{Real::load(velocity[0].number), Real::load(velocity[1].number)}};
      return corner(s, row, i) - v * Real(s.time_step);
    };
    const auto p = edge_pair<Real>({before(0), before(1)}, {before(2), before(3)},
                                   Real::load(row.unloaded_a.number), Real::load(row.unloaded_b.number));
    return {now.gap[0] - p.gap[0], now.gap[1] - p.gap[1]};
  }

  /// Damps one point of eight pairs while it is pressed, and books the work by the trapezoidal rule, as the
  /// ledger does that of forces.
  static void damp(const State<Dim>& s, Row& row, int k, const Real& way, const Real& area, Real& traction) {
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

  /// Makes handed-over pairs whose facets have left each other new ones, but for what they still bear.
  static void set_apart(const State<Dim>& s, Row& row, const Truth& leaves) {
    const Real zero = 0.0;
    select(leaves, Real(s.thickness), Real::load(row.thickness.number)).store(row.thickness.number);
    for (int k = 0; k < kPoints; ++k)
      for (Line* line : {&row.offset[k], &row.rest[k]})
        select(leaves, zero, Real::load(line->number)).store(line->number);
    row.handed_over &= ~bits_of(leaves);
  }

  /// Makes handed-over pairs that rest, and whose facets have left each other, new ones.
  static void let_go(const State<Dim>& s, Row& row, const Truth& leaves) {
    set_apart(s, row, leaves);
    for (int k = 0; k < kPoints; ++k) forget(s, row, k, leaves);
  }

  /// Takes the history of one point from pairs that rest and leave each other.
  static void forget(const State<Dim>& s, Row& row, int k, const Truth& leaves) {
    if (!any(leaves)) return;
    const LawOfRows& law = s.found->laws[row.law];
    store(choose(leaves, Jump{}, load(row.shift[k])), row.shift[k]);
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

  /// Distance from an edge, over the height of the triangle, from which on no rounding decides on an overlap.
  static constexpr double kSurely = 1e-9;
  static constexpr double kRounding = 1e-14;  ///< more than rounding may change a gap, m
  static constexpr double kOpen = 1.0;        ///< opening of a point that does not press, m
  static constexpr double kAlwaysAsked = std::numeric_limits<double>::max();  ///< opening, m
};

}  // namespace pyroclast
