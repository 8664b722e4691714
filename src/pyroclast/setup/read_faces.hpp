#pragma once

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/setup/read_space.hpp"
#include "pyroclast/simulation/acting/boundary_faces.hpp"

namespace pyroclast {

/// Reads the faces on which a boundary acts. Errors are recorded in the deck.
BoundaryFaces read_faces(const Section& s, const DeckSpace& space);

/// Tells whether two choices of faces meet in any specimen. A box is compared with a side once there is a
/// specimen.
bool overlap(const BoundaryFaces& a, const BoundaryFaces& b);

}  // namespace pyroclast
