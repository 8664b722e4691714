#include "pyroclast/mechanics/found/found_points.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "pyroclast/mechanics/found/edge_pair.hpp"
#include "pyroclast/mechanics/found/found_contacts.hpp"
#include "pyroclast/mechanics/reader.hpp"

namespace pyroclast {

namespace {

/// Two edges that press, at the displacements of the last forces.
class PressedEdges {
 public:
  PressedEdges(const Body<2>& body, const FoundPair<2>& pair)
      : a_(edge(body, pair.facets[0])), b_(edge(body, pair.facets[1])) {
    std::swap(b_[0], b_[1]);
    const auto& facets = body.found->facets;
    pair_ = edge_pair<double>(a_, b_, facets[pair.facets[0]].length, facets[pair.facets[1]].length);
  }

  Vec<3> place(int k) const {
    return resized<3>((a_[0] + pair_.edge_a * pair_.at_a[k] + b_[0] + pair_.edge_b * pair_.at_b[k]) * 0.5);
  }
  Vec<3> middle() const { return (place(0) + place(1)) * 0.5; }
  Vec<3> normal() const { return resized<3>(pair_.normal); }
  double gap(int k) const { return pair_.gap[k]; }
  Tangential<2> jump(int k, const PairPoint<2>& point) const { return {pair_.slide[k] + point.shift[0]}; }

  /// Sets what follows from the tractions. A corner presses across the edge that it meets.
  void put(int k, const Tangential<2>& jump, const PointResponse& response, FoundPoint& point) const {
    point.tangent = resized<3>(pair_.tangent);
    point.slip = jump[0];
    point.shear_traction = response.shear_traction[0];
    const double along =
        point.shear_traction * pair_.slide_factor[k] - point.normal_traction * pair_.gap_slope[k];
    point.force = resized<3>(pair_.normal * (point.normal_traction * point.area) +
                             pair_.tangent * (along * point.area));
  }

 private:
  static std::array<Vec<2>, 2> edge(const Body<2>& body, int facet) {
    const auto& g = body.found->facets[facet].gridpoints;
    const auto at = [&](int i) {
      return body.model.position[g[i]] + Reader<2>(body).displacement_of_force(g[i]);
    };
    return {at(0), at(1)};
  }

  std::array<Vec<2>, 2> a_, b_;
  EdgePair<double> pair_;
};

/// Two triangles that press, at the displacements of the last forces.
class PressedTriangles {
 public:
  PressedTriangles(const Body<3>&, const FoundPair<3>& pair) {
    Triangle a, b;
    for (int i = 0; i < 3; ++i) {
      a[i] = pair.pressed_at[i];
      b[i] = pair.pressed_at[3 + i];
    }
    overlap_ = overlap_of(a, b);
    pair_ = triangle_pair(overlap_, a, b);
    tangents_ = tangents_of(pair_.a, pair_.normal);
  }

  Vec<3> place(int k) const { return (pair_.on_a(k) + pair_.on_b(k)) * 0.5; }
  Vec<3> middle() const {
    Vec<3> moment{};
    for (int k = 0; k < overlap_.count; ++k) moment += place(k) * pair_.part[k];
    return moment * (1.0 / pair_.overlap);
  }
  Vec<3> normal() const { return pair_.normal; }
  double gap(int k) const { return pair_.gap[k]; }
  Tangential<3> jump(int, const PairPoint<3>& point) const { return point.shift; }

  void put(int k, const Tangential<3>& jump, const PointResponse& response, FoundPoint& point) const {
    const Vec<3> shear =
        tangents_[0] * response.shear_traction[0] + tangents_[1] * response.shear_traction[1];
    point.slip = norm(jump);
    point.shear_traction = norm(shear);
    if (point.shear_traction > 0.0) point.tangent = shear * (1.0 / point.shear_traction);
    point.force = pair_.gap_slope[k] * (point.normal_traction * point.area) + shear * point.area;
  }

 private:
  Overlap overlap_;
  TrianglePair<double> pair_;
  std::array<Vec<3>, 2> tangents_{};
};

/// Returns the answer of the law to the jump of a point: taken to it once more, the law gives the same.
template <int Dim>
PointResponse response_of(const Body<Dim>& body, const FoundPair<Dim>& pair, int k, double opening,
                          const Tangential<Dim>& along) {
  const int set = pair.sets[set_of_point<Dim>(k)];
  const LawTable& law = body.properties.contacts.law(set);
  const auto count = static_cast<std::ptrdiff_t>(law.internals(Dim).size());
  std::vector<double> internals(pair.internals.begin() + k * count, pair.internals.begin() + (k + 1) * count);
  std::vector<double> losses(law.losses.size());
  std::array<double, Dim> jump{opening};
  std::copy_n(along.c.begin(), Dim - 1, jump.begin() + 1);
  return law.update(Dim)(body.properties.contacts[set].constants().data(), jump.data(), internals.data(),
                         losses.data());
}

}  // namespace

template <int Dim>
std::vector<FoundPoint> found_points(const Body<Dim>& body) {
  if (!body.found) return {};
  const FoundData<Dim>& found = *body.found;
  const auto give = [&](FoundPair<Dim> pair, auto add) {
    take_from_row(found, pair);
    if (!pair.bears()) return;
    const std::conditional_t<Dim == 2, PressedEdges, PressedTriangles> pressed(body, pair);
    const BlockFacet<Dim>&first = found.facets[pair.facets[0]], &second = found.facets[pair.facets[1]];
    for (int k = 0; k < kPointsOfPair<Dim>; ++k) {
      const PairPoint<Dim>& of_pair = pair.points[k];
      if (!(of_pair.area > 0.0)) continue;
      FoundPoint point;
      point.blocks = {first.block, second.block};
      point.face = pair.is_handed_over ? first.face : -1;
      point.interface = pair.interface;
      point.position = pressed.place(k);
      point.middle = pressed.middle();
      point.normal = pressed.normal();
      point.area = of_pair.area;
      point.opening = pressed.gap(k) + of_pair.offset;
      const auto along = pressed.jump(k, of_pair);
      const PointResponse response = response_of(body, pair, k, point.opening, along);
      point.normal_traction = response.normal_traction + of_pair.damped / of_pair.area;
      point.stored = response.stored;
      pressed.put(k, along, response, point);
      add(point);
    }
  };
  return of_all_pairs<FoundPoint>(body, give, false);
}

template std::vector<FoundPoint> found_points(const Body<2>&);
template std::vector<FoundPoint> found_points(const Body<3>&);

}  // namespace pyroclast
