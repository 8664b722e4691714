#include "pyroclast/thermal/thermal_mesh.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "pyroclast/base/disjoint_sets.hpp"
#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

/// Returns the largest distance of gridpoints that coincide, m. Contacts are made of coinciding faces, so
/// anything beyond rounding is an error in the model.
template <int Dim>
double coincidence_tolerance(const ModelOf<Dim>& model) {
  double size = 0.0;
  for (const auto& x : model.position) size = std::max(size, norm(x - model.position.front()));
  return 1e-9 * size;
}

}  // namespace

template <int Dim>
ThermalNodes join_through_contacts(const ModelOf<Dim>& model, const std::vector<bool>& conducts,
                                   const std::vector<std::uint8_t>& parts) {
  const auto conducting = gridpoints_of(model, conducts);
  const double tolerance = coincidence_tolerance(model);
  DisjointSets sets(model.gridpoint_count());
  for (std::size_t i = 0; i < model.contacts.size(); ++i) {
    const auto& c = model.contacts[i];
    if (!conducting[c.a] || !conducting[c.b]) continue;
    if (const double gap = norm(model.position[c.a] - model.position[c.b]); !(gap <= tolerance))
      throw Error(
          fmt::format("a contact joins gridpoints {} and {}, which lie {:g} m apart; heat crosses only "
                      "contacts whose gridpoints coincide",
                      c.a, c.b, gap));
    if (parts.empty() || parts[i] == 0) sets.join(c.a, c.b);
  }

  std::vector<bool> in_zone(model.position.size());
  for (const auto& zone : model.zones)
    for (int g : zone) in_zone[g] = true;

  ThermalNodes nodes;
  nodes.of_gridpoint.assign(model.position.size(), -1);
  for (int g = 0; g < model.gridpoint_count(); ++g) {
    if (!conducting[g]) continue;
    if (!in_zone[g]) throw Error(fmt::format("gridpoint {} belongs to no zone, so it can hold no heat", g));
    const int first = sets.first_of(g);
    if (first == g) {
      nodes.of_gridpoint[g] = nodes.count();
      nodes.gridpoint.push_back(g);
    } else {
      nodes.of_gridpoint[g] = nodes.of_gridpoint[first];
    }
  }
  return nodes;
}

template ThermalNodes join_through_contacts(const ModelOf<2>&, const std::vector<bool>&,
                                            const std::vector<std::uint8_t>&);
template ThermalNodes join_through_contacts(const ModelOf<3>&, const std::vector<bool>&,
                                            const std::vector<std::uint8_t>&);

}  // namespace pyroclast
