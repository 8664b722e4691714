#include "pyroclast/thermal/prescriptions.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/thermal/heat_boundary.hpp"

namespace pyroclast {

void Prescriptions::add(const std::vector<int>& gridpoints, const Curve& temperature) {
  require_curve_of_time(temperature, "prescribed temperature");
  for (const int g : gridpoints) of_gridpoint_[g] = static_cast<int>(curves_.size());
  curves_.push_back(temperature);
  held_at_.resize(curves_.size());
}

void Prescriptions::set_nodes(const ThermalNodes& nodes, const ChunkList& chunks) {
  of_node_.assign(nodes.gridpoint.size(), -1);
  for (std::size_t g = 0; g < of_gridpoint_.size(); ++g)
    if (const int node = nodes.of_gridpoint[g]; node >= 0)
      of_node_[node] = std::max(of_node_[node], of_gridpoint_[g]);
  nodes_.clear();
  for (int node = 0; node < nodes.count(); ++node)
    if (hold(node)) nodes_.push_back(node);
  chunks_ = chunks.of_some(nodes_);
  acting_.clear();
  for (int i = 0; i < static_cast<int>(curves_.size()); ++i)
    if (chunks.ranks().any(std::ranges::any_of(nodes_, [&](int node) { return of_node_[node] == i; })))
      acting_.push_back(i);
}

void Prescriptions::read(double time, const Interval& range) {
  for (std::size_t i = 0; i < curves_.size(); ++i)
    held_at_[i] = std::clamp(curves_[i](time), range.lower, range.upper);
}

void Prescriptions::require_within(const Interval& range, double begin, double end) const {
  for (const Curve& curve : curves_) {
    require_defined(curve, "prescribed temperature", begin, end);
    const double least = curve.minimum(begin, end);
    const double greatest = curve.maximum(begin, end);
    if (!range.holds({least, greatest}, absolute_zero))
      throw Error(
          fmt::format("prescribed temperature ({}) goes from {} to {} degC, but the run's temperature range "
                      "is {} to {} degC",
                      curve.describe(), least, greatest, range.lower, range.upper));
  }
}

Interval Prescriptions::reach(double begin, double end) const {
  Interval reach = nothing();
  for (const int i : acting_)
    include(reach, {curves_[i].minimum(begin, end), curves_[i].maximum(begin, end)});
  return reach;
}

}  // namespace pyroclast
