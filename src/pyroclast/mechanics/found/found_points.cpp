#include "pyroclast/mechanics/found/found_points.hpp"

#include "pyroclast/mechanics/found/edge_pair.hpp"
#include "pyroclast/mechanics/found/found_contacts.hpp"
#include "pyroclast/mechanics/reader.hpp"

namespace pyroclast {

std::vector<FoundPoint> found_points(const Body<2>& body) {
  std::vector<FoundPoint> points;
  if (!body.found) return points;
  const FoundData<2>& found = *body.found;
  const Reader<2> read(body);
  for (FoundPair<2> pair : found.pairs) {
    take_from_row(found, pair);
    if (!pair.bears()) continue;
    const BlockFacet<2>&first = found.facets[pair.facets[0]], &second = found.facets[pair.facets[1]];
    const auto at = [&](int g) { return body.model.position[g] + read.displacement_of_force(g); };
    const std::array<Vec<2>, 2> a{at(first.gridpoints[0]), at(first.gridpoints[1])};
    const std::array<Vec<2>, 2> b{at(second.gridpoints[1]), at(second.gridpoints[0])};
    const auto p = edge_pair<double>(a, b, first.length, second.length);
    const auto place = [&](int k) {
      return (a[0] + p.edge_a * p.at_a[k] + b[0] + p.edge_b * p.at_b[k]) * 0.5;
    };
    const Vec<2> middle = (place(0) + place(1)) * 0.5;
    const LawTable& law = body.properties.contacts.law(pair.sets[0]);
    const std::size_t count = law.internals(2).size();
    for (int k = 0; k < 2; ++k) {
      const PairPoint<2>& end = pair.points[k];
      if (!(end.area > 0.0)) continue;
      FoundPoint& point = points.emplace_back();
      point.blocks = {first.block, second.block};
      point.face = pair.is_handed_over ? first.face : -1;
      point.interface = pair.interface;
      point.position = place(k);
      point.middle = middle;
      point.normal = p.normal;
      point.area = end.area;
      point.length = end.area / body.model.thickness;
      point.opening = p.gap[k] + end.offset;
      point.slip = p.slide[k] + end.shift[0];
      // the law, taken to the same jump once more, gives the same tractions
      const double jump[2] = {point.opening, point.slip};
      std::vector<double> internals(pair.internals.begin() + static_cast<std::ptrdiff_t>(k * count),
                                    pair.internals.begin() + static_cast<std::ptrdiff_t>((k + 1) * count));
      std::vector<double> losses(law.losses.size());
      const PointResponse response = law.update(2)(body.properties.contacts[pair.sets[k]].constants().data(),
                                                   jump, internals.data(), losses.data());
      point.normal_traction = response.normal_traction + end.damped / end.area;
      point.shear_traction = response.shear_traction[0];
      point.stored = response.stored;
      // a corner presses across the edge that it meets
      point.force =
          p.normal * (point.normal_traction * end.area) +
          p.tangent * ((point.shear_traction * p.slide_factor[k] - point.normal_traction * p.gap_slope[k]) *
                       end.area);
    }
  }
  return points;
}

}  // namespace pyroclast
