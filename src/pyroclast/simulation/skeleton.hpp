#pragma once

#include <span>
#include <string>
#include <vector>

#include "pyroclast/material/concrete.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/simulation/specimen_body.hpp"

namespace pyroclast {

/// Stones whose blocks hold together by contacts that never part, so that no crack runs between the stones.
struct Skeleton {
  int stones = 0;           ///< stones that have a block in it
  double volume = 0.0;      ///< m³
  double share = 0.0;       ///< share of the volume of all stones
  double of_largest = 0.0;  ///< its volume over that of the largest stone
};

/// Returns the largest skeleton: a collective. Ranks but the first get none.
/// \param stone     stone of each block of the specimen, in their order; -1: none
/// \param contacts  materials of the interfaces of the model
Skeleton largest_skeleton(const Model& model, std::span<const int> stone,
                          const std::vector<ContactMaterial>& contacts);

/// Returns a line that says where stones form a skeleton: one of a quarter of the stones' volume or more that
/// is twice as large as the largest stone. Empty where there is none, or where stones are not known. A
/// collective; empty on ranks but the first.
/// \param stone  as above, or empty
std::string skeleton(const Model& model, std::span<const int> stone,
                     const std::vector<ContactMaterial>& contacts);

/// Returns what a user should know of a specimen and of the contacts between its blocks, one line each.
std::vector<std::string> warnings(const MadeSpecimen& specimen, const Model& model,
                                  const std::vector<ContactMaterial>& contacts);

}  // namespace pyroclast
