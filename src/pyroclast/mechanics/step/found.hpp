#pragma once

#include <array>
#include <bit>
#include <limits>

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

  /// Most rows stand apart, or rest. A row that does not goes through the geometry with all its pairs at
  /// once: the overlaps that it knows stay as long as corners stay on their sides of edges.
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
    row.asked = 0;
    const Truth rests_on = was_handed_over & (!bore) & lie.over & (lie.gap > rest_below + Real(kRounding));
    const Truth is_asked =
        (!lie.beside) & (!rests_on) & (was_handed_over | bore | (lie.gap < Real(kRounding)));
    const Truth flies_off = was_handed_over & lie.beside;
    if (row.rests && !any(is_asked | flies_off)) return;

    const PlacesOfOverlap places = places_of(at, lie);
    const Truth rests_here = is_asked & was_handed_over & !bore;
    const Truth may_begin = is_asked & !was_handed_over & !bore;
    Truth is_pressed = is_asked & bore;
    if (any(may_begin)) is_pressed = is_pressed | (may_begin & may_touch(row, lie, places));
    if (row.rests && !any(is_pressed | rests_here | flies_off)) return;
    const Real sides = sides_of(at, lie);
    const Truth changes = any(rests_here) ? rests_here & may_change(row, lie, places, sides) : rests_here;
    const Truth is_taken = is_pressed | changes, lies_still = rests_here & !changes;
    row.asked = bits_of(is_taken);
    if (row.rests && !any(is_taken | flies_off)) return;
    OverlapsInLanes of;
    TrianglePair<Real> p;
    const std::uint32_t carried = take_to_overlaps(found, row, at, sides, is_taken, of, p);
    const std::uint32_t faces = of.count > 0 ? of.exists[0] : 0U;
    const std::uint32_t live = faces & ~(row.changed & ~carried);  // others rest on
    const Truth is_live = Truth::from_bits(live), face = Truth::from_bits(faces) | rests_on | lies_still;
    const auto leaves = was_handed_over & !face;

    Now now;
    now.handed_over = face & was_handed_over;
    const Real most_depth = Real::load(row.most_depth.number);
    Truth touches = zero > zero;
    for (int k = 0; k < kPoints; ++k) {
      now.gap[k] = k < of.count ? p.gap[k] + Real::load(row.offset[k].number) : zero;
      now.area_before[k] = Real::load(row.area[k].number);
      now.goes_in[k] = Truth::from_bits(k < of.count ? of.exists[k] & live : 0U) &
                       (now.gap[k] < Real::load(row.rest[k].number)) & (zero - now.gap[k] < most_depth);
      touches = touches | now.goes_in[k];
    }
    if (row.rests && !any(touches | bore | leaves)) return;
    row.rests = false;
    const Real left_out = Real::load(row.not_counted.number);
    const Real not_counted = select(is_live, select(touches, smaller(left_out, p.overlap), zero),
                                    select(Truth::from_bits(faces), left_out, zero));
    not_counted.store(row.not_counted.number);
    PointAreas<Real> areas(of.count, p, Real::load(row.thickness.number), not_counted, most_depth, now.gap);
    if (row.handed_over != 0 && any(leaves)) set_apart(s, row, leaves);
    std::array<Truth, kPoints> acts;
    Truth works = bore;
    for (int k = 0; k < kPoints; ++k) {
      acts[k] = zero > zero;
      if (k >= of.count) continue;
      acts[k] = Truth::from_bits(of.exists[k] & live & ~static_cast<unsigned>(row.silent_points[k])) &
                (p.overlap > not_counted) & (areas.area[k] > zero) &
                (now.goes_in[k] | (now.handed_over & (now.area_before[k] > zero)));
      works = works | acts[k];
    }
    // pairs may lie in each other, and bear nothing yet
    if (!any(works | is_damped(row))) {
      for (int k = 0; k < kPoints; ++k) forget(s, row, k, leaves);
      keep_places(row, at, carried);
      unload(row, forces);
      row.rests = !any(not_counted > zero);
      return;
    }
    const auto tangents = tangents_of(p.a, p.normal);
    const auto slides = slides_of(row, p, of.count, tangents);

    std::array<Tractions, kPoints> tractions;
    Real stored = zero;
    Truth loaded = zero > zero;
    for (int k = 0; k < kPoints; ++k) {
      Real area_now = k < of.count ? areas.area[k] : zero;
      if (any(acts[k] | (now.area_before[k] > zero))) {
        const Truth rested = !(now.area_before[k] > zero);
        const Jump slide = choose(rested, Jump{}, slides[k]);
        stored += press_point(s, row, k, acts[k], now, slide, area_now, tractions[k]);
      } else {
        area_now = zero;
        tractions[k] = {zero, zero, Jump{}};
        forget(s, row, k, leaves);
      }
      if (found.is_damped)
        damp(s, row, k, k < of.count ? gap_way(s, row, p, k) : zero, area_now, tractions[k].normal);
      const Truth bears = area_now > zero;
      loaded = loaded | bears;
      areas.area[k] = area_now;
      auto& counts = areas.points[k];
      for (Real* number : {&counts.depth, &counts.share, &counts.slope})
        *number = select(bears, *number, zero);
    }
    stored.store(row.stored.number);
    const std::uint32_t bearing = bits_of(loaded);
    const Truth remembers = (not_counted > zero) | is_damped(row);
    keep_places(row, at, bearing | carried);
    if (bearing != 0)
      place_forces(row, of, p, areas, tractions, tangents, loaded, forces);
    else
      unload(row, forces);
    row.rests = bearing == 0 && !any(remembers);
  }

  /// How eight pairs of triangles lie, seen along the mean normal.
  struct Lie {
    Truth beside;   ///< one triangle lies beyond an edge of the other
    Truth over;     ///< they face each other, and the middle of one lies over the other
    Real gap;       ///< bound below which no gap of them lies, m
    Truth surely;   ///< no rounding decides on which side of an edge a corner lies
    Truth clearly;  ///< corners lie so far from the edges that an overlap which holds one is not tiny
    /// Sides of the corners of b beside each edge of a, then of those of a beside each edge of b: positive
    /// inside.
    std::array<std::array<Real, 3>, kCorners> side;
    Vector sum;  ///< of the area vectors, times 2, m²
    Real sides;  ///< sum of powers of two: those of the corners that lie inside of edges of the other one
  };

  static Lie lie_of(const std::array<Vector, kCorners>& at) {
    const Vector area_a = cross(at[1] - at[0], at[2] - at[0]), area_b = cross(at[4] - at[3], at[5] - at[3]);
    const Vector normal = area_a + area_b;
    const Truth none = Truth::from_bits(0);
    Lie lie{none, none, 0.0, !none, !none, {}, normal, 0.0};
    double power = 1.0;
    for (int own : {0, 3}) {
      const int other = 3 - own;
      const Vector middle = (at[other] + at[other + 1] + at[other + 2]) * Real(1.0 / 3.0);
      Truth is_within = dot(area_a, area_b) > Real(0.0);
      for (int i = 0; i < 3; ++i) {
        const Vector& from = at[own + i];
        const Vector inwards = cross(normal, at[own + (i + 1) % 3] - from);
        const Real surely = dot(inwards, at[own + (i + 2) % 3] - from) * Real(kSurely);
        Real most = 0.0;
        for (int k = 0; k < 3; ++k, power *= 2.0) {
          const Real side = dot(inwards, at[other + k] - from);
          most = k == 0 ? side : larger(most, side);
          lie.side[own + i][k] = side;
          lie.surely = lie.surely & (abs(side) > surely);
          lie.clearly = lie.clearly & (abs(side) > surely * Real(kClearly / kSurely));
          lie.sides += select(side > Real(0.0), Real(power), Real(0.0));
        }
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

  /// Returns a number that names all that decides on the corners of an overlap: on which side of each edge
  /// the corners lie, and how edges cross; -1 where rounding decides. The size of the overlap decides too.
  static Real sides_of(const std::array<Vector, kCorners>& at, const Lie& lie) {
    const Vector area_a = cross(at[1] - at[0], at[2] - at[0]), area_b = cross(at[4] - at[3], at[5] - at[3]);
    const Vector sum = area_a + area_b, normal = sum * (Real(1.0) / norm(sum));
    const Real zero = 0.0;
    double power = kPowerOfFirstCrossing;
    Real sides = lie.sides;
    const auto add = [&](const Truth& condition) {
      sides += select(condition, Real(power), zero);
      power *= 2.0;
    };
    add(dot(area_a, area_b) > zero);
    std::array<Vector, 3> edges_b;
    std::array<Real, 3> lengths_b;
    for (int j = 0; j < 3; ++j) {
      edges_b[j] = at[3 + (j + 1) % 3] - at[3 + j];
      lengths_b[j] = norm(edges_b[j]);
    }
    for (int i = 0; i < 3; ++i) {
      const Vector edge_a = at[(i + 1) % 3] - at[i];
      const Real length_a = norm(edge_a);
      for (int j = 0; j < 3; ++j) {
        const Vector across = cross(edge_a, edges_b[j]);
        const Real least = larger(Real(Overlap::kParallel) * length_a * lengths_b[j],
                                  Real(Overlap::kSteepest) * norm(across));
        add(abs(dot(across, normal)) >= least);
        add(dot(edge_a, edges_b[j]) > zero);
      }
    }
    return select(lie.surely, sides, Real(-1.0));
  }

  /// Tells whether the row knows the overlaps of pairs.
  static Truth is_known(const Row& row, const Real& sides) {
    const Real known = Real::load(row.sides.number);
    return (sides >= Real(0.0)) & (sides <= known) & (known <= sides);
  }

  /// Where overlaps may have corners: at those of triangles, and where edges cross.
  struct PlacesOfOverlap {
    std::array<Truth, kCorners> over;                 ///< true where a corner lies over the other triangle
    std::array<std::array<Truth, 3>, 3> cross;        ///< true where edges cross
    std::array<Real, kCorners> gap;                   ///< gap at corners, m
    std::array<std::array<Real, 3>, 3> gap_of_edges;  ///< gap where edges cross, m
    Real margin;                                      ///< more than rounding may change gaps, m
  };

  static PlacesOfOverlap places_of(const std::array<Vector, kCorners>& at, const Lie& lie) {
    const Real zero = 0.0, one = 1.0;
    PlacesOfOverlap places;
    const Vector area_a = cross(at[1] - at[0], at[2] - at[0]), area_b = cross(at[4] - at[3], at[5] - at[3]);
    const Vector normal = lie.sum * (one / norm(lie.sum));
    const Real over_a = one / dot(area_a, normal), over_b = one / dot(area_b, normal);
    std::array<Real, kCorners> height;
    Real highest = zero;
    std::array<std::array<Truth, 3>, kCorners> inside;
    for (int i = 0; i < kCorners; ++i) {
      height[i] = dot(normal, at[i] - at[0]);
      highest = larger(highest, abs(height[i]));
      places.gap[i] = i < 3 ? dot(area_b, at[3] - at[i]) * over_b : dot(area_a, at[i] - at[0]) * over_a;
      for (int k = 0; k < 3; ++k) inside[i][k] = lie.side[i][k] > zero;
    }
    places.margin = highest * Real(kOfHeights) + Real(kRounding);
    for (int k = 0; k < 3; ++k) {
      places.over[k] = inside[3][k] & inside[4][k] & inside[5][k];
      places.over[3 + k] = inside[0][k] & inside[1][k] & inside[2][k];
    }
    const auto differ = [](const Truth& x, const Truth& y) { return (x & !y) | (y & !x); };
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int i1 = (i + 1) % 3, j1 = (j + 1) % 3;
        const Real &of_a = lie.side[3 + j][i], &of_b = lie.side[i][j];
        const Real along_a = of_a / (of_a - lie.side[3 + j][i1]), along_b = of_b / (of_b - lie.side[i][j1]);
        places.gap_of_edges[i][j] = height[3 + j] + along_b * (height[3 + j1] - height[3 + j]) - height[i] -
                                    along_a * (height[i1] - height[i]);
        places.cross[i][j] =
            differ(inside[3 + j][i], inside[3 + j][i1]) & differ(inside[i][j], inside[i][j1]);
      }
    return places;
  }

  /// Tells which pairs that are not handed over may touch.
  static Truth may_touch(const Row& row, const Lie& lie, const PlacesOfOverlap& places) {
    const Real zero = 0.0, most_depth = Real::load(row.most_depth.number);
    Truth touches = !lie.surely;
    const auto look = [&](const Truth& is_there, const Real& gap) {
      touches = touches | (is_there & (gap < places.margin) & (zero - gap < most_depth + places.margin));
    };
    for (int i = 0; i < kCorners; ++i) look(places.over[i], places.gap[i]);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) look(places.cross[i][j], places.gap_of_edges[i][j]);
    return touches;
  }

  /// Tells which pairs that are handed over and rest may have a point that goes through the law, or may have
  /// left each other.
  static Truth may_change(const Row& row, const Lie& lie, const PlacesOfOverlap& places, const Real& sides) {
    const Real zero = 0.0;
    const OverlapsInLanes& of = row.names;
    Real rest = zero, offset = zero;
    for (int k = 0; k < kPoints; ++k) {
      rest = larger(rest, Real::load(row.rest[k].number));
      offset = smaller(offset, Real::load(row.offset[k].number));
    }
    Truth changes = zero > zero;
    unsigned holds_corner = 0;
    for (int k = 0; k < kPoints && of.exists[k] != 0; ++k) {
      holds_corner |= static_cast<unsigned>(of.of_a[k] | of.of_b[k]);
      Real gap = zero;
      const auto take = [&](unsigned bits, const Real& here) {
        if (bits != 0) gap = select(Truth::from_bits(bits), here, gap);
      };
      for (int i = 0; i < 3; ++i) {
        take(of.of_a[k] & of.on_a[k][i], places.gap[i]);
        take(of.of_b[k] & of.on_b[k][i], places.gap[3 + i]);
        for (int j = 0; j < 3; ++j)
          take(of.crosses[k] & of.on_a[k][i] & of.on_b[k][j], places.gap_of_edges[i][j]);
      }
      // points of another overlap may take their rest from one and their offset from another
      const Real bound = select(Truth::from_bits(row.changed), rest - offset,
                                Real::load(row.rest[k].number) - Real::load(row.offset[k].number));
      changes = changes | (Truth::from_bits(of.exists[k]) & !(gap > bound + places.margin));
    }
    return changes | !(lie.clearly & is_known(row, sides) & Truth::from_bits(holds_corner));
  }

  /// Takes pairs to their overlaps, and points whose overlap has others than before to what they remember.
  /// Returns the bits of the lanes of these.
  static std::uint32_t take_to_overlaps(FoundRows<Dim>& found, Row& row,
                                        const std::array<Vector, kCorners>& at, const Real& sides,
                                        const Truth& is_asked, OverlapsInLanes& of, TrianglePair<Real>& p) {
    const Real zero = 0.0;
    const std::uint32_t asked = bits_of(is_asked & (Real::load(row.thickness.number) > zero));
    alignas(64) typename Row::Places places;
    for (int i = 0; i < kCorners; ++i) R::store(at[i], places[i].data());
    Line new_sides;
    sides.store(new_sides.number);
    std::uint32_t anew = asked & ~bits_of(is_known(row, sides)), seen = 0;
    while (true) {
      for (std::uint32_t left = anew; left != 0; left &= left - 1) {
        const int lane = std::countr_zero(left);
        see_overlap(row, lane, corners_in(places, lane), new_sides.number[lane]);
      }
      seen |= anew;
      name_overlaps(row, asked, of, p);
      place_corners(of, {at[0], at[1], at[2]}, {at[3], at[4], at[5]}, p);
      // where the overlap is tiny there may be none
      if (of.count == 0) break;
      anew = of.exists[0] & ~seen & ~bits_of(p.overlap > p.size * Real(Overlap::kSurelyOne));
      if (anew == 0) break;
      p.overlap = p.outline = zero;
      p.part.fill(zero);
    }
    std::uint32_t carried = 0;
    for (std::uint32_t left = of.count > 0 ? row.changed & of.exists[0] : 0U; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      if (carry_over(found, row, lane, corners_in(places, lane)))
        carried |= 1U << static_cast<unsigned>(lane);
    }
    return carried;
  }

  /// Takes the names of the overlaps of some lanes, and the weights of their fixed corners.
  static void name_overlaps(const Row& row, std::uint32_t lanes, OverlapsInLanes& of, TrianglePair<Real>& p) {
    using Bits = OverlapsInLanes::Bits;
    const auto of_lanes = [&](Bits& bits, Bits all) { bits = static_cast<Bits>(all & lanes); };
    of.count = 0;
    for (int k = 0; k < kPoints; ++k) {
      of_lanes(of.exists[k], row.names.exists[k]);
      of_lanes(of.of_a[k], row.names.of_a[k]);
      of_lanes(of.of_b[k], row.names.of_b[k]);
      of_lanes(of.crosses[k], row.names.crosses[k]);
      for (int i = 0; i < 3; ++i) {
        of_lanes(of.on_a[k][i], row.names.on_a[k][i]);
        of_lanes(of.on_b[k][i], row.names.on_b[k][i]);
      }
      if (of.exists[k] != 0) of.count = k + 1;
      if (fixed_in<Real>(of, k) == 0) continue;
      for (int i = 0; i < 3; ++i) {
        Line at_a, at_b;
        for (int lane = 0; lane < kLanes; ++lane) {
          at_a.number[lane] = row.seen[lane].corners[k].at_a[i];
          at_b.number[lane] = row.seen[lane].corners[k].at_b[i];
        }
        p.at_a[k][i] = Real::load(at_a.number);
        p.at_b[k][i] = Real::load(at_b.number);
      }
    }
  }

  /// Returns the way of each point along the tangents since the last step that pressed, m.
  static std::array<Jump, kPoints> slides_of(const Row& row, const TrianglePair<Real>& p, int count,
                                             const std::array<Vector, 2>& tangents) {
    std::array<Jump, kPoints> slides{};
    if (row.had == 0) return slides;
    const Truth had = Truth::from_bits(row.had);
    std::array<Vector, 3> a, b;
    for (int i = 0; i < 3; ++i) {
      a[i] = R::load(row.pressed_at[i].data());
      b[i] = R::load(row.pressed_at[3 + i].data());
    }
    const Vector sum =
        cross(a[1] - a[0], a[2] - a[0]) * Real(0.5) + cross(b[1] - b[0], b[2] - b[0]) * Real(0.5);
    const auto tangents_then = tangents_of(a, sum * (Real(1.0) / norm(sum)));
    for (int k = 0; k < count; ++k) {
      const Vector apart = p.on_b(k) - p.on_a(k);
      const Vector apart_then =
          TrianglePair<Real>::mixed(b, p.at_b[k]) - TrianglePair<Real>::mixed(a, p.at_a[k]);
      for (int i = 0; i + 1 < Dim; ++i)
        slides[k][i] = select(had, dot(tangents[i], apart) - dot(tangents_then[i], apart_then), Real(0.0));
    }
    return slides;
  }

  /// Returns how far the gap of a point opens in a step, m.
  static Real gap_way(const State<Dim>& s, const Row& row, const TrianglePair<Real>& p, int k) {
    const auto velocity = [&](int i) {
      Line lines[Dim];
      for (int lane = 0; lane < kLanes; ++lane) {
        const Vec<Dim> v = vector_at<Dim>(s.velocity, row.corners[i][lane] / offset_of<Dim>(1));
        for (int j = 0; j < Dim; ++j) lines[j].number[lane] = v[j];
      }
      Vector v;
      for (int j = 0; j < Dim; ++j) v[j] = Real::load(lines[j].number);
      return v;
    };
    Vector apart{};
    for (int i = 0; i < 3; ++i) apart += velocity(3 + i) * p.at_b[k][i] - velocity(i) * p.at_a[k][i];
    return dot(p.gap_slope[k], apart) * Real(s.time_step);
  }

  /// Keeps the places of pairs that press, from which they go on; those of others are forgotten, unless they
  /// are handed over.
  static void keep_places(Row& row, const std::array<Vector, kCorners>& at, std::uint32_t pressed) {
    if (pressed != 0) {
      const Truth is_pressed = Truth::from_bits(pressed);
      for (int i = 0; i < kCorners; ++i) {
        Vec<Dim>* const places = row.pressed_at[i].data();
        R::store(select(is_pressed, at[i], R::load(places)), places);
      }
    }
    for (std::uint32_t left = pressed & row.renewed; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      row.overlap[lane] = row.seen[lane];
    }
    const std::uint32_t forgotten = row.had & ~pressed & ~row.handed_over;
    for (std::uint32_t left = forgotten; left != 0; left &= left - 1)
      row.overlap[std::countr_zero(left)].count = 0;
    row.had = (row.had | pressed) & ~forgotten;
    row.changed &= row.had & ~pressed;
    row.renewed = (row.renewed & ~pressed) | forgotten;
  }

  /// Writes the forces of a row.
  static void place_forces(Row& row, const OverlapsInLanes& of, const TrianglePair<Real>& p,
                           const PointAreas<Real>& areas, const std::array<Tractions, kPoints>& tractions,
                           const std::array<Vector, 2>& tangents, const Truth& loaded, Vec<Dim>* forces) {
    Real applied = 0.0;
    std::array<Vector, kCorners> f{};
    if (of.count > 0) {
      PointTractions<Real> t;
      for (int k = 0; k < of.count; ++k) {
        t.normal[k] = tractions[k].normal;
        t.stored[k] = tractions[k].stored;
        t.shear[k] = tangents[0] * tractions[k].shear[0] + tangents[1] * tractions[k].shear[1];
      }
      f = corner_forces(of, p, areas, t);
    }
    for (int i = 0; i < kCorners; ++i) {
      f[i] = R::where(loaded, f[i]);
      applied += norm(f[i]);
      R::store(f[i], &forces[i * kLanes]);
    }
    applied.store(row.applied.number);
  }

  /// Writes what follows where no pair of a row bears anything.
  static void unload(Row& row, Vec<Dim>* forces) {
    const Real zero = 0.0;
    for (int i = 0; i < kCorners; ++i) R::store(Vector{}, &forces[i * kLanes]);
    for (Line* line : {&row.stored, &row.applied}) zero.store(line->number);
  }
  /// Writes what follows where none touches either.
  static void rest(Row& row, Vec<Dim>* forces) {
    unload(row, forces);
    Real(0.0).store(row.not_counted.number);
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

  static constexpr double kPowerOfFirstCrossing = 0x1p18;  ///< behind the powers of Lie::sides
  /// Distance from an edge, over the height of the triangle, from which on no rounding decides on an overlap.
  static constexpr double kSurely = 1e-9;
  /// Likewise of which follows that an overlap is larger than Overlap::kSurelyOne, unless triangles are as
  /// slender as 1 to 200.
  static constexpr double kClearly = 1e-3;
  static constexpr double kOfHeights = 1e-6;  ///< rounding of gaps over the heights of the corners
  static constexpr double kRounding = 1e-14;  ///< more than rounding may change a gap, m
  static constexpr double kOpen = 1.0;        ///< opening of a point that does not press, m
  static constexpr double kAlwaysAsked = std::numeric_limits<double>::max();  ///< opening, m
};

}  // namespace pyroclast
