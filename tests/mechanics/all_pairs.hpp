#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "loose_blocks.hpp"
#include "pyroclast/mechanics/found/edge_pair.hpp"
#include "pyroclast/mechanics/found/triangle_pair.hpp"
#include "pyroclast/model/outline.hpp"

/// Contacts of loose boxes as one writes them without lists and rows: an independent code for found contacts.
namespace pyroclast::bodies {

/// Point of a pair of facets that presses, with what it remembers.
template <int Dim>
struct PressedPoint {
  double area = 0.0;  ///< in the last step; 0 where it did not press
  Tangential<Dim, double> shift{}, held{};
  Frictional::Internals<Dim, double> internals{};
};

/// Law of the points, and what it costs.
struct RubbingLaw {
  Frictional::Constants<double> constants;
  double rubbed = 0.0;  ///< J

  static bool goes_in(double gap, double most_depth) { return gap < 0.0 && -gap < most_depth; }

  /// Takes a point that does not press any more from what it held.
  template <int Dim>
  void let_go(PressedPoint<Dim>& point) {
    rubbed += 0.5 * constants.shear_stiffness * dot(point.held, point.held) * point.area;
    point = {};
  }
  /// Takes a point that presses through the law.
  template <int Dim>
  ContactResponse<Dim, double> press(PressedPoint<Dim>& point, double gap,
                                     const Tangential<Dim, double>& slide, double area) {
    if (point.area == 0.0) point.shift = slide * -1.0;
    if (point.area > 0.0 && area > point.area) {  // the force stays
      const auto held = point.held * (point.area / area);
      point.shift -= point.held - held;
      point.internals.held_jump = norm(held);
    }
    Frictional::Losses<double> losses{};
    auto response =
        Frictional::update<Dim, double>(constants, gap, slide + point.shift, point.internals, losses);
    point.area = area;
    point.held = response.shear_traction * (1.0 / constants.shear_stiffness);
    rubbed += losses.friction * area;
    response.stored -= 0.5 * dot(response.shear_traction, point.held);
    return response;
  }
};

/// Facet of a box, with the length of its longest edge.
template <int Dim>
struct BoxFacet {
  int block;
  std::array<int, Dim> gridpoints;
  double length;
};

/// Two facets of different boxes.
template <int Dim>
class PairOfFacets;

template <>
class PairOfFacets<2> {
 public:
  std::array<Vec<2>, 4> forces(const std::array<Vec<2>, 4>& at, const BoxFacet<2>& a, const BoxFacet<2>& b,
                               double thickness, double most_depth, RubbingLaw& law) {
    const auto p = edge_pair<double>({at[0], at[1]}, {at[2], at[3]}, a.length, b.length);
    EndAreas<double> areas(p, thickness, 0.0, most_depth, p.gap);
    EndTractions<double> tractions;
    bool presses = false;
    for (int k = 0; k < 2; ++k) {
      if (!p.face || !RubbingLaw::goes_in(p.gap[k], most_depth) || areas.area[k] <= 0.0) {
        law.let_go(points_[k]);
        areas.area[k] = areas.ends[k].share = areas.ends[k].slope = areas.ends[k].depth = 0.0;
        continue;
      }
      const auto response = law.press<2>(points_[k], p.gap[k], {{p.slide[k]}}, areas.area[k]);
      tractions.normal[k] = response.normal_traction;
      tractions.shear[k] = response.shear_traction[0];
      tractions.stored[k] = response.stored;
      presses = true;
    }
    return presses ? corner_forces(p, areas, tractions) : std::array<Vec<2>, 4>{};
  }

 private:
  std::array<PressedPoint<2>, 2> points_;
};

template <>
class PairOfFacets<3> {
 public:
  std::array<Vec<3>, 6> forces(const std::array<Vec<3>, 6>& at, const BoxFacet<3>&, const BoxFacet<3>&,
                               double thickness, double most_depth, RubbingLaw& law) {
    const Triangle a{at[0], at[1], at[2]}, b{at[3], at[4], at[5]};
    const Overlap overlap = overlap_of(a, b);
    if (overlap.count == 0) {
      for (auto& point : points_) law.let_go(point);
      overlap_.count = 0;
      return {};
    }
    const auto p = triangle_pair(overlap, a, b);
    PointAreas<double> areas(overlap.count, p, thickness, 0.0, most_depth, p.gap);
    if (overlap_.count > 0 && !is_like(overlap)) carry_over(overlap, p, areas);
    const auto tangents = tangents_of(a, p.normal);
    PointTractions<double> tractions;
    bool presses = false;
    for (int k = 0; k < Overlap::kMost; ++k) {
      PressedPoint<3>& point = points_[k];
      if (k >= overlap.count || is_steep(overlap, k) || !RubbingLaw::goes_in(p.gap[k], most_depth) ||
          areas.area[k] <= 0.0) {
        law.let_go(point);
        areas.area[k] = 0.0;
        areas.points[k].share = areas.points[k].slope = areas.points[k].depth = 0.0;
        continue;
      }
      const auto slide = point.area > 0.0 ? slide_of(p, k, tangents) : Vec<2>{};
      const auto response = law.press<3>(point, p.gap[k], slide, areas.area[k]);
      point.shift += slide;  // the slide is that of one step
      tractions.normal[k] = response.normal_traction;
      tractions.shear[k] =
          tangents[0] * response.shear_traction[0] + tangents[1] * response.shear_traction[1];
      tractions.stored[k] = response.stored;
      presses = true;
    }
    overlap_ = overlap;
    if (!presses) overlap_.count = 0;
    a_ = a;
    b_ = b;
    return presses ? corner_forces(overlap, p, areas, tractions) : std::array<Vec<3>, 6>{};
  }

 private:
  static bool is_steep(const Overlap& overlap, int k) {
    return overlap.corners[k].kind == OverlapCorner::Kind::steep;
  }
  bool is_like(const Overlap& overlap) const {
    return overlap.count == overlap_.count &&
           std::equal(overlap.corners.begin(), overlap.corners.begin() + overlap.count,
                      overlap_.corners.begin(), [](const OverlapCorner& now, const OverlapCorner& then) {
                        return now.before == then.before && now.behind == then.behind;
                      });
  }
  /// Returns how far two places that lie over each other now have slid since the last step, m.
  Vec<2> slide_of(const TrianglePair<double>& p, int k, const std::array<Vec<3>, 2>& tangents) const {
    const Vec<3> now = p.on_b(k) - p.on_a(k);
    const Vec<3> then =
        TrianglePair<double>::mixed(b_, p.at_b[k]) - TrianglePair<double>::mixed(a_, p.at_a[k]);
    const Vec<3> sum = cross(a_[1] - a_[0], a_[2] - a_[0]) + cross(b_[1] - b_[0], b_[2] - b_[0]);
    const auto tangents_then = tangents_of(a_, sum * (1.0 / norm(sum)));
    return {{dot(tangents[0], now) - dot(tangents_then[0], then),
             dot(tangents[1], now) - dot(tangents_then[1], then)}};
  }
  /// Gives what points remember to those of an overlap with other corners: each goes to the nearest one,
  /// which takes the mean by area, and where none comes there is one like the nearest.
  void carry_over(const Overlap& overlap, const TrianglePair<double>& p, const PointAreas<double>& areas) {
    const auto p_then = triangle_pair(overlap_, a_, b_);
    std::array<PressedPoint<3>, Overlap::kMost> carried{};
    std::array<Vec<3>, Overlap::kMost> then{};  // places that moved with a
    for (int i = 0; i < overlap_.count; ++i) then[i] = TrianglePair<double>::mixed(p.a, p_then.at_a[i]);
    const auto add = [](PressedPoint<3>& sum, const PressedPoint<3>& point) {
      sum.area += point.area;
      sum.shift += point.shift * point.area;
      sum.held += point.held * point.area;
      sum.internals.slip += point.internals.slip * point.area;
    };
    for (int i = 0; i < overlap_.count; ++i) {
      int nearest = 0;
      for (int k = 1; k < overlap.count; ++k)
        if (norm(p.on_a(k) - then[i]) < norm(p.on_a(nearest) - then[i])) nearest = k;
      add(carried[nearest], points_[i]);
    }
    for (int k = 0; k < overlap.count; ++k) {
      PressedPoint<3>& point = carried[k];
      if (point.area == 0.0) {
        int nearest = 0;
        for (int i = 1; i < overlap_.count; ++i)
          if (norm(p.on_a(k) - then[i]) < norm(p.on_a(k) - then[nearest])) nearest = i;
        add(point, points_[nearest]);
      }
      if (point.area == 0.0 || areas.area[k] <= 0.0 || is_steep(overlap, k)) {
        point = {};
        continue;
      }
      for (Vec<2>* mean : {&point.shift, &point.held, &point.internals.slip}) *mean *= 1.0 / point.area;
      point.internals.held_jump = norm(point.held);
      point.area = areas.area[k];
    }
    points_ = carried;
  }

  // of the last step, if the pair pressed
  Overlap overlap_;
  Triangle a_{}, b_{};
  std::array<PressedPoint<3>, Overlap::kMost> points_;
};

/// Contacts of loose boxes: in each step every facet meets every facet of the other blocks, one pair after
/// the other, with the law of one point.
template <int Dim>
class AllPairs {
 public:
  AllPairs(const Body<Dim>& body, const Frictional::Properties<double>& law)
      : model_(body.model), law_{Frictional::derive(law)}, most_depth_(model_.block_count(), 1.0) {
    const auto block_of = gridpoint_blocks(model_);
    for (const auto& face : outline(model_, body.geometry, std::vector<bool>(model_.block_count(), true))) {
      const int block = block_of[face.gridpoints[0]];
      double length = 0.0, height = 0.0;
      for (const int from : face.gridpoints)
        for (const int to : face.gridpoints)
          length = std::max(length, norm(model_.position[to] - model_.position[from]));
      for (int g = model_.block_gridpoints[block]; g < model_.block_gridpoints[block + 1]; ++g)
        height = std::max(height, dot(face.normal, face.centre - model_.position[g]));
      facets_.push_back({block, face.gridpoints, length});
      most_depth_[block] = std::min(most_depth_[block], 0.25 * height);
    }
    pairs_.resize(facets_.size() * facets_.size());
  }

  double rubbed() const { return law_.rubbed; }

  /// Puts the forces at the present places on the gridpoints of a body that has no contacts.
  /// \param held_blocks  number of the first blocks, which are held
  void load(Mechanics<Dim>& m, int held_blocks) {
    std::vector<Vec<Dim>> forces(model_.position.size());
    for (std::size_t a = 0; a < facets_.size(); ++a)
      for (std::size_t b = a + 1; b < facets_.size(); ++b) {
        if (facets_[a].block == facets_[b].block) continue;
        std::array<int, 2 * Dim> corners{};
        std::array<Vec<Dim>, 2 * Dim> at;
        for (int i = 0; i < Dim; ++i) {
          corners[i] = facets_[a].gridpoints[i];
          // the other way round, beginning where the product begins: in space a list of corners that begins
          // at another one counts as changed
          corners[Dim + i] = facets_[b].gridpoints[(3 - i) % Dim];
        }
        for (int i = 0; i < 2 * Dim; ++i)
          at[i] = model_.position[corners[i]] + m.read().displacement(corners[i]);
        const auto f = pairs_[a * facets_.size() + b].forces(
            at, facets_[a], facets_[b], model_.thickness,
            std::min(most_depth_[facets_[a].block], most_depth_[facets_[b].block]), law_);
        for (int i = 0; i < 2 * Dim; ++i) forces[corners[i]] += f[i];
      }
    for (int g = model_.block_gridpoints[held_blocks]; g < model_.gridpoint_count(); ++g)
      m.constraints().apply_force(g, forces[g]);
  }

 private:
  const ModelOf<Dim>& model_;
  RubbingLaw law_;
  std::vector<BoxFacet<Dim>> facets_;
  std::vector<double> most_depth_;
  std::vector<PairOfFacets<Dim>> pairs_;  // by facet a, then b
};

/// Lets loose boxes fall on held ones, and expects that they go the way that they go with all pairs in each
/// step.
///
/// \param held  number of the first blocks, which are held
template <int Dim>
void expect_the_way_of_all_pairs(const ModelOf<Dim>& model, int held, const std::vector<Vec<Dim>>& velocities,
                                 double duration, int every) {
  const auto law = rubbing(1e8, 0.4);
  auto parameters = flying<Dim>(kGravity, 0.3);
  auto m = mechanics<Dim>(model, law, parameters, 3e8);
  parameters.found.is_on = false;
  const double own_step = mechanics<Dim>(model, law, parameters, 3e8).time_step();
  parameters.safety *= m.time_step() / own_step;
  auto expected = mechanics<Dim>(model, law, parameters, 3e8);
  ASSERT_NEAR(expected.time_step(), m.time_step(), 1e-15 * m.time_step());
  for (Mechanics<Dim>* body : {&m, &expected}) {
    for (int b = 0; b < held; ++b) hold(*body, b);
    body->begin_moving(velocities);
  }
  AllPairs<Dim> pairs(m.body(), law);
  while (m.time() < duration) {
    pairs.load(expected, held);
    expected.advance(1);
    m.advance(1);
    if (m.steps() % every != 0) continue;
    double difference = 0.0;
    for (int g = 0; g < model.gridpoint_count(); ++g)
      difference = std::max(difference, norm(m.read().displacement(g) - expected.read().displacement(g)));
    EXPECT_LT(difference, 1e-13);  // rounding; blocks have gone 30 to 50 mm
  }
  const EnergyLedger e = m.totals().energy();
  EXPECT_GT(e.dissipated.of("friction"), 0.2 * e.kinetic);  // blocks have met
  EXPECT_NEAR(e.dissipated.of("friction"), pairs.rubbed(), 1e-10 * pairs.rubbed());
}

}  // namespace pyroclast::bodies
