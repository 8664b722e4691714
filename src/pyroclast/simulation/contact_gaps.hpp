#pragma once

#include <string>
#include <vector>

#include "pyroclast/mechanics/mechanics.hpp"
#include "pyroclast/thermal/gap_heat.hpp"

namespace pyroclast {

/// Contacts that stand apart from the start, for heat: no bridge holds them, and to this width comes what the
/// motion opens them by.
struct StatedGap {
  std::string contacts;  ///< name of a set of them
  double width = 0.0;    ///< m
  std::string place;     ///< where it is stated, for messages
};

/// What is left of each contact of a body for heat: of what is stated, and of its damage and opening now. The
/// damage is that in tension or mixed mode.
/// \param mechanics  null where nothing moves
///
/// Throws Error, with the gap's place, when its set is missing, or holds a contact that another gap has.
template <int Dim>
std::vector<ContactGap> contact_gaps(const Model<Dim>& model, const std::vector<StatedGap>& stated,
                                     const Mechanics<Dim>* mechanics);

}  // namespace pyroclast
