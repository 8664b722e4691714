#include "pyroclast/simulation/stress_free.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/place_text.hpp"

namespace pyroclast {

namespace {

/// Places in the order of their x, so that places near a point stand together.
class PlacesByX {
 public:
  explicit PlacesByX(const std::vector<Vec<3>>& places) : places_(places) {
    for (int i = 0; i < static_cast<int>(places.size()); ++i) order_.push_back(i);
    std::ranges::stable_sort(order_, {}, [&](int i) { return places_[i][0]; });
  }

  /// Returns the nearest place, the first of equals in the order of x; -1 without a place within the reach,
  /// m.
  int nearest(const Vec<3>& point, double reach) const {
    double best = reach * reach;
    int found = -1;
    const auto from =
        std::ranges::lower_bound(order_, point[0] - reach, {}, [&](int i) { return places_[i][0]; });
    for (auto place = from; place != order_.end(); ++place) {
      const Vec<3> way = places_[*place] - point;
      if (way[0] > 0.0 && way[0] * way[0] > best) break;
      if (dot(way, way) < best || (found < 0 && dot(way, way) <= best)) {
        best = dot(way, way);
        found = *place;
      }
    }
    return found;
  }

 private:
  const std::vector<Vec<3>>& places_;
  std::vector<int> order_;
};

}  // namespace

Interval StressFree::range() const {
  Interval all = nothing();
  for (const double temperature : temperatures) include(all, temperature);
  return all;
}

std::vector<double> stress_free_gridpoints(const StressFree& field, const Model& model, double reach) {
  std::vector<double> temperature(model.gridpoint_count(), kReferenceTemperature);
  const PlacesByX places(field.places);
  for (int b = 0; b < model.block_count(); ++b) {
    if (model.is_of_bearing(b)) continue;
    for (int g = model.block_gridpoints[b]; g < model.block_gridpoints[b + 1]; ++g) {
      const Vec<3> at = model.place(g);
      const int place = places.nearest(at, reach);
      if (place < 0)
        throw Error(fmt::format(
            "{}: the other run has no gridpoint within {:.3g} mm of {} mm; its body must cover the specimen",
            field.place.empty() ? "coupling.stress_free" : field.place, 1e3 * reach,
            place_text(1e3 * at, model.dimension(), "{:.4g}")));
      temperature[g] = field.temperatures[place];
    }
  }
  return temperature;
}

}  // namespace pyroclast
