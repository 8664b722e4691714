#pragma once

#include <string>
#include <vector>

#include "pyroclast/mechanics/motion.hpp"
#include "pyroclast/thermal/gap_heat.hpp"

namespace pyroclast {

/// Contacts that stand apart from the start, for heat: no bridge joins their faces, and the motion adds its
/// opening to the stated width.
struct StatedGap {
  std::string contacts;  ///< name of a set of contacts
  double width = 0.0;    ///< width, m
  std::string place;     ///< place that states the gap, for messages
};

/// Returns the damage of a contact in tension or mixed mode, 0 to 1; 0 where its law knows none.
double damage_in_tension(const Motion& motion, int contact);
/// Returns the largest damage of a contact by any mode; -1 where its law knows none.
double largest_damage(const Motion& motion, int contact);

/// Returns the gap of each contact of a body for heat, from the stated gaps and the present damage and
/// opening.
/// \param motion  null where nothing moves
///
/// Throws Error, with the gap's place, when its set is missing, or holds a contact that another gap has.
std::vector<ContactGap> contact_gaps(const Model& model, const std::vector<StatedGap>& stated,
                                     const Motion* motion);

}  // namespace pyroclast
