#pragma once

#include <vector>

#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

/// Gridpoints that lie in blocks with which theirs has no contact: pieces that passed through others, because
/// contacts join the faces of the start alone.
struct PassedThrough {
  int gridpoints = 0;  ///< gridpoints deeper than kDeep of the size of the smaller block
  int blocks = 0;      ///< blocks that they belong to
  int block = -1;  ///< block of the deepest of all gridpoints, however deep; -1 where none lies in another
  int other = -1;  ///< block in which it lies
  double depth = 0.0;  ///< depth of that gridpoint, m
  static constexpr double kDeep = 0.01;
};
/// Finds what passed through, at the present displacements: a collective. Nothing on ranks but the
/// first.
PassedThrough passed_through(const Simulation& simulation);

/// Piece of a body that falls: blocks that contacts hold together, none of which is held or pressed by
/// another piece.
struct FallingPiece {
  std::vector<int> blocks;
  double share_of_gravity = 1.0;  ///< acceleration over that of gravity
};
/// Finds the pieces that fall under gravity, the largest first: a collective. Nothing on ranks but the first.
std::vector<FallingPiece> falling_pieces(const Simulation& simulation);

/// Returns the warnings of both, one line each: a collective. None on ranks but the first, and in a body
/// whose blocks may meet any other and fall as they should.
std::vector<std::string> warnings_of_loose_pieces(const Simulation& simulation);

}  // namespace pyroclast
