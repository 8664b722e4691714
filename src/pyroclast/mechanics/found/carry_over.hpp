#pragma once

#include "pyroclast/mechanics/found/rows.hpp"

namespace pyroclast {

/// Takes a pair of a row to its overlap at present.
///
/// \param sides  sides on which the corners lie; less than 0 where rounding decides
void see_overlap(FoundRow<3>& row, int lane, const TriangleCorners& corners, double sides);

/// Lets the points of a pair go on from what the nearest of those remember that its overlap had in the last
/// step that pressed; the row books the energy of the shear that this takes. Returns false where the pair
/// rests on, and nothing changes.
bool carry_over(const FoundRows<3>& found, FoundRow<3>& row, int lane, const TriangleCorners& corners);

}  // namespace pyroclast
