#pragma once

#include <string>
#include <vector>

#include "pyroclast/solid/complex.hpp"

/// Cells in space that lie beside each other and do not share vertices or faces.
namespace pyroclast::solid {

/// Joins cells: vertices nearer to each other than `distance` (m) become the first of them, and faces that
/// then have the same corners in turn, in either sense, the first of them. Vertices and faces that no cell
/// has any more are dropped. Throws Error, naming the face, where two corners of a face are as near to each
/// other. \param complex  cells whose faces have corners, and no neighbours yet \return the number that each
/// face had
std::vector<int> join(Complex& complex, double distance);

/// Describes cells that are not joined by faces: the number of their pieces, one cell of the smallest and its
/// place. Empty where the cells are one piece.
std::string describe_pieces(const Complex& complex);

/// Says how many vertices coincide, how many faces then have the corners of another, and by which distance
/// `join` joins them. The text goes behind another sentence.
std::string describe_joinable(const Complex& complex);

}  // namespace pyroclast::solid
