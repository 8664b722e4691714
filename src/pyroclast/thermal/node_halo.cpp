#include "pyroclast/thermal/node_halo.hpp"

#include "pyroclast/base/place_in.hpp"

namespace pyroclast {

ItemHalo node_halo(const Model& model, const ThermalNodes& nodes, const ChunkList& chunks) {
  if (!model.part) return {};
  const std::vector<int>& in_whole = model.part->gridpoint;  // ascending
  const auto own = chunks.own();
  std::vector<int> foreign;
  for (int node = 0; node < nodes.count(); ++node)
    if (!own.contain(node)) foreign.push_back(node);
  const auto own_node = [&](int gridpoint) {
    const int here = place_in_ascending(in_whole, gridpoint);
    if (here < 0) return -1;
    const int node = nodes.of_gridpoint[here];
    return own.contain(node) ? node : -1;
  };
  return {model.ranks(), foreign, [&](int node) { return in_whole[nodes.gridpoint[node]]; }, own_node};
}

}  // namespace pyroclast
