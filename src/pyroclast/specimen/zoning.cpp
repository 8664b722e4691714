#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

ZonedBlock zone_block(const std::vector<Vec<2>>& corners) {
  ZonedBlock block{corners, {}};
  block.gridpoints.push_back(centroid(corners));
  const int n = static_cast<int>(corners.size());
  for (int i = 0; i < n; ++i) block.zones.push_back({i, i + 1 < n ? i + 1 : 0, n});
  return block;
}

}  // namespace pyroclast::specimen
