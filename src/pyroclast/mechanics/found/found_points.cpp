#include "pyroclast/mechanics/found/found_points.hpp"

#include <algorithm>
#include <type_traits>

#include "pyroclast/mechanics/found/of_all_pairs.hpp"
#include "pyroclast/mechanics/found/pair_rows.hpp"

namespace pyroclast {

namespace {

/// Two edges that press, at the displacements of the last forces.
class PressedEdges {
 public:
  PressedEdges(const Body<2>& body, const FoundPair<2>& pair)
      : at_(PairFacts<2>(body).places_of_forces(pair.facets)),
        pair_(PairFacts<2>(body).shape(pair.facets, at_).p) {}

  Vec<3> place(int k) const {
    return resized<3>((at_[0] + pair_.edge_a * pair_.at_a[k] + at_[2] + pair_.edge_b * pair_.at_b[k]) * 0.5);
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
  PairFacts<2>::Corners at_;
  EdgePair<double> pair_;
};

/// Two triangles that press, at the displacements of the last forces.
class PressedTriangles {
 public:
  PressedTriangles(const Body<3>& body, const FoundPair<3>& pair)
      : shape_(PairFacts<3>(body).shape(pair.facets, pair.pressed_at)),
        tangents_(tangents_of(shape_.p.a, shape_.p.normal)) {}

  Vec<3> place(int k) const { return (shape_.p.on_a(k) + shape_.p.on_b(k)) * 0.5; }
  Vec<3> middle() const {
    Vec<3> moment{};
    for (int k = 0; k < shape_.points; ++k) moment += place(k) * shape_.p.part[k];
    return moment * (1.0 / shape_.p.overlap);
  }
  Vec<3> normal() const { return shape_.p.normal; }
  double gap(int k) const { return shape_.p.gap[k]; }
  Tangential<3> jump(int, const PairPoint<3>& point) const { return point.shift; }

  void put(int k, const Tangential<3>& jump, const PointResponse& response, FoundPoint& point) const {
    const Vec<3> shear =
        tangents_[0] * response.shear_traction[0] + tangents_[1] * response.shear_traction[1];
    point.slip = norm(jump);
    point.shear_traction = norm(shear);
    if (point.shear_traction > 0.0) point.tangent = shear * (1.0 / point.shear_traction);
    point.force = shape_.p.gap_slope[k] * (point.normal_traction * point.area) + shear * point.area;
  }

 private:
  PairShape<3> shape_;
  std::array<Vec<3>, 2> tangents_;
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
