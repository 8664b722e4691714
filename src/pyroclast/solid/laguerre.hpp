#pragma once

#include <vector>

#include "pyroclast/base/team.hpp"
#include "pyroclast/solid/complex.hpp"
#include "pyroclast/solid/seeds.hpp"

namespace pyroclast::solid {

/// Complex, or the seeds that prevent it.
struct LaguerreComplex {
  Complex complex;          ///< cell i belongs to seed i; complete only when `broken` is empty
  std::vector<int> plane;   ///< plane of the body on which each face lies; -1 within it
  std::vector<int> broken;  ///< seeds whose cell is empty or does not match its neighbours, ascending
};

/// Returns the Laguerre tessellation of a body, by Voro++ (Rycroft, Chaos 19, 041111, 2009). Vertices are
/// shared: those closer than 1e-7 mean spacings are one. The result is bitwise the same for any number of
/// threads.
/// \param team  team that shares the cells out; without a team the calling thread works alone
LaguerreComplex laguerre_complex(const SolidSeeds& seeds, const Prism& body, Team* team = nullptr);

}  // namespace pyroclast::solid
