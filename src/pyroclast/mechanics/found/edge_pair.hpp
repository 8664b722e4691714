#pragma once

#include <array>

#include "pyroclast/base/vec.hpp"
#include "pyroclast/mechanics/found/counted_share.hpp"

/// Two edges of different blocks that press each other wherever they lie: the contact that is found, in the
/// plane.
///
/// Edge a runs counter-clockwise round its block; edge b runs beside it, so clockwise round its own. They are
/// seen along the normal of their mean edge. Their overlap has two ends, and each end is a contact point with
/// half of the overlap: without slide, the two points of a joined face. All numbers of the points are
/// functions of the four corners, and the forces are minus their exact gradient, so that edges which slide,
/// turn and leave each other neither gain nor lose energy.
namespace pyroclast {

/// Places of two edges, seen along their mean edge. Real is a double, or Lanes for eight pairs at once.
template <class Real>
struct EdgePair {
  using Vector = Vec<2, Real>;
  using Truth = decltype(Real(0.0) < Real(0.0));

  Vector edge_a, edge_b, tangent, normal;  ///< edges, m; unit vectors of their mean, `normal` from a to b
  Real mean_length, length_a, length_b;    ///< m
  Real along_a;                            ///< length of edge a along the tangent, m
  Real cosine;                             ///< cosine of the angle between the edges
  Real overlap;                            ///< length of the overlap, m
  Truth face;                              ///< true where the edges face each other and overlap

  // The two ends of the overlap.
  std::array<Truth, 2> is_of_b;      ///< true where the end is a corner of b, else one of a
  std::array<Real, 2> at_a, at_b;    ///< place along each edge, from 0 to 1
  std::array<Real, 2> gap;           ///< distance from a to b along the normal, m
  std::array<Real, 2> slide;         ///< place along a less that along b, in lengths without load, m
  std::array<Real, 2> gap_slope;     ///< slope of the edge that the corner meets, to the mean edge
  std::array<Real, 2> slide_factor;  ///< length without load over length along the tangent, of that edge
};

/// \param a, b                  ends of the edges in the order of the tangent, m
/// \param unloaded_a, unloaded_b  lengths of the edges without load, m
template <class Real>
EdgePair<Real> edge_pair(const std::array<Vec<2, Real>, 2>& a, const std::array<Vec<2, Real>, 2>& b,
                         const Real& unloaded_a, const Real& unloaded_b) {
  using std::sqrt;
  EdgePair<Real> p;
  p.edge_a = a[1] - a[0];
  p.edge_b = b[1] - b[0];
  p.length_a = norm(p.edge_a);
  p.length_b = norm(p.edge_b);
  p.cosine = dot(p.edge_a, p.edge_b) / (p.length_a * p.length_b);
  const Vec<2, Real> mean = (p.edge_a + p.edge_b) * Real(0.5);
  p.mean_length = norm(mean);
  p.tangent = mean * (Real(1.0) / p.mean_length);
  p.normal = {{p.tangent[1], -p.tangent[0]}};
  const Vec<2, Real> between = b[0] - a[0];
  p.along_a = dot(p.tangent, p.edge_a);
  const Real along_b = dot(p.tangent, p.edge_b);
  const Real begin_b = dot(p.tangent, between), end_b = begin_b + along_b;
  const Real rise_a = dot(p.normal, p.edge_a), rise_b = dot(p.normal, p.edge_b);
  const Real over_a = Real(1.0) / p.along_a, over_b = Real(1.0) / along_b;
  p.is_of_b = {begin_b > Real(0.0), end_b < p.along_a};
  p.at_a = {select(p.is_of_b[0], begin_b * over_a, Real(0.0)),
            select(p.is_of_b[1], end_b * over_a, Real(1.0))};
  p.at_b = {select(p.is_of_b[0], Real(0.0), (Real(0.0) - begin_b) * over_b),
            select(p.is_of_b[1], Real(1.0), (p.along_a - begin_b) * over_b)};
  p.overlap = (p.at_a[1] - p.at_a[0]) * p.along_a;
  const Real gap_of_begins = dot(p.normal, between);
  for (int k = 0; k < 2; ++k) {
    p.gap[k] = gap_of_begins + p.at_b[k] * rise_b - p.at_a[k] * rise_a;
    p.slide[k] = unloaded_a * p.at_a[k] - unloaded_b * p.at_b[k];
    p.gap_slope[k] = select(p.is_of_b[k], rise_a * over_a, rise_b * over_b);
    p.slide_factor[k] = select(p.is_of_b[k], unloaded_a * over_a, unloaded_b * over_b);
  }
  p.face = (p.cosine > Real(0.0)) & (p.overlap > Real(0.0));
  return p;
}

/// Tractions of the law at the two ends, and the energy of their normal part.
template <class Real>
struct EndTractions {
  std::array<Real, 2> normal{}, shear{};  ///< Pa, tension positive
  std::array<Real, 2> stored{};           ///< J/m²
};

/// Areas of the two ends: half of the overlap times the thickness, where edges do not lie parallel times the
/// square of the cosine, and times the share that counts.
template <class Real>
struct EndAreas {
  Real half_thickness;                      ///< half of the thickness, times the ratio of the pair, m
  Real counted;                             ///< overlap less that of the pair's beginning, m
  Real width;                               ///< length by which depths are divided, m
  decltype(Real(0.0) < Real(0.0)) is_long;  ///< true where the overlap is longer than that
  std::array<CountedShare<Real>, 2> ends;   ///< share of each end
  std::array<Real, 2> area;                 ///< m²

  /// \param thickness    thickness of the body times the ratio of the pair's areas to these, m
  /// \param not_counted  overlap that does not count, because the edges lay in each other when the pair
  ///                     began, m
  /// \param most_depth   depth from which on an end does not count, m
  /// \param gap          gap of each end from which its depth is taken, m
  EndAreas(const EdgePair<Real>& p, const Real& thickness, const Real& not_counted, const Real& most_depth,
           const std::array<Real, 2>& gap)
      : half_thickness(thickness * Real(0.5)),
        counted(p.overlap - not_counted),
        width(smaller(counted, most_depth * Real(1.0 / CountedShare<Real>::kMost))),
        is_long(width < counted),
        ends{CountedShare<Real>(depth_over(gap[0])), CountedShare<Real>(depth_over(gap[1]))} {
    const Real whole = half_thickness * p.cosine * p.cosine * counted;
    for (int k = 0; k < 2; ++k) area[k] = whole * ends[k].share;
  }

 private:
  Real depth_over(const Real& gap) const { return (Real(0.0) - gap) / width; }
};

/// Forces on the corners of a pair: on a[0], a[1], b[0], b[1], N.
template <class Real>
using CornerForces = std::array<Vec<2, Real>, 4>;

/// Returns the forces of the tractions at the ends: minus the gradient of their energy, where the ends' areas
/// move with the corners too. The shear acts as its area stands.
template <class Real>
CornerForces<Real> corner_forces(const EdgePair<Real>& p, const EndAreas<Real>& areas,
                                 const EndTractions<Real>& tractions) {
  const Real zero(0.0);
  const Real of_cosines = areas.half_thickness * p.cosine;
  CornerForces<Real> f{};
  Real by_overlap(0.0), by_cosine(0.0);  // derivatives of the energy
  Real turning(0.0);                     // moment of the part that turns with the mean edge
  for (int k = 0; k < 2; ++k) {
    const CountedShare<Real>& counts = areas.ends[k];
    const Real of_whole = of_cosines * p.cosine * tractions.stored[k];
    const Real by_depth = of_whole * counts.slope;
    const Real normal = tractions.normal[k] * areas.area[k] -
                        select(areas.is_long, by_depth * (areas.counted / areas.width), by_depth);
    const Real shear = tractions.shear[k] * areas.area[k] * p.slide_factor[k] - normal * p.gap_slope[k];
    const Vec<2, Real> force = p.normal * normal + p.tangent * shear;
    f[0] += force * (Real(1.0) - p.at_a[k]);
    f[1] += force * p.at_a[k];
    f[2] -= force * (Real(1.0) - p.at_b[k]);
    f[3] -= force * p.at_b[k];
    turning += p.gap[k] * shear;
    by_overlap += of_whole * counts.share - select(areas.is_long, zero, by_depth * counts.depth);
    by_cosine += Real(2.0) * of_cosines * areas.counted * tractions.stored[k] * counts.share;
  }
  // the overlap ends at corners and turns with the mean edge
  const Vec<2, Real> along = p.tangent * by_overlap;
  for (int i = 0; i < 2; ++i) {
    f[2][i] += select(p.is_of_b[0], along[i], zero);
    f[0][i] += select(p.is_of_b[0], zero, along[i]);
    f[3][i] -= select(p.is_of_b[1], along[i], zero);
    f[1][i] -= select(p.is_of_b[1], zero, along[i]);
  }
  const Real rise_a = dot(p.normal, p.edge_a);
  const auto height = [&](int k) { return p.at_a[k] * rise_a + select(p.is_of_b[k], p.gap[k], zero); };
  turning += by_overlap * (height(1) - height(0));
  const Vec<2, Real> turn = p.normal * (turning * Real(0.5) / p.mean_length);
  // the cosine
  const Real over_a = Real(1.0) / p.length_a, over_b = Real(1.0) / p.length_b;
  const Vec<2, Real> unit_a = p.edge_a * over_a, unit_b = p.edge_b * over_b;
  const Vec<2, Real> of_a = turn + (unit_b - unit_a * p.cosine) * (over_a * by_cosine);
  const Vec<2, Real> of_b = turn + (unit_a - unit_b * p.cosine) * (over_b * by_cosine);
  f[0] += of_a;
  f[1] -= of_a;
  f[2] += of_b;
  f[3] -= of_b;
  return f;
}

}  // namespace pyroclast
