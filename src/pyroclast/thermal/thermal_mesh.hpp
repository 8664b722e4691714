#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pyroclast/model/outline.hpp"

namespace pyroclast {

/// Gridpoints that share one temperature.
struct ThermalNodes {
  std::vector<int> of_gridpoint;  ///< node of each gridpoint; -1 where the block conducts no heat
  std::vector<int> gridpoint;     ///< first gridpoint of each node

  int count() const { return static_cast<int>(gridpoint.size()); }
};

/// Makes the nodes for heat that crosses contacts without resistance (paper, 2.1): gridpoints that contacts
/// join are one node.
///
/// \param conducts  true where a block takes part
/// \param parts     true where a contact has a resistance, see GapConduction, and joins nothing; empty: no
///                  contact
///
/// Throws Error when a contact joins gridpoints that do not coincide, or a gridpoint belongs to no zone.
template <int Dim>
ThermalNodes join_through_contacts(const ModelOf<Dim>& model, const std::vector<bool>& conducts,
                                   const std::vector<std::uint8_t>& parts = {});

}  // namespace pyroclast
