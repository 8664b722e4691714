#pragma once

#include <array>
#include <vector>

#include "pyroclast/moisture/moisture_mesh.hpp"
#include "pyroclast/moisture/pore_material.hpp"

namespace pyroclast {

/// Crack between two cells: their face stands open.
struct OpenFace {
  int face = 0;                 ///< index into MoistureMesh::faces
  double width = 0.0;           ///< mean over the face, m, above 0
  std::vector<double> at_ends;  ///< width at each end of the face, in their order, m; 0: closed there
};

/// Flow of vapour through a gap between two parallel walls, as a slow flow between plates (cubic law): from
/// the middle of a crack to one of its ends, and from there into other cracks or out of the body.
struct CrackConduit {
  std::array<int, 2> cracks;  ///< indices into the list of cracks
  double conductance;         ///< of a flow conductance density / viscosity (p_a - p_b), m3
};

/// End of a crack at a face of the outline.
struct CrackMouth {
  int crack;
  int outer_face;      ///< index into MoistureMesh::outer_faces
  double conductance;  ///< m3
};

/// Cracks of a body as vapour flows through them.
struct CrackNetwork {
  std::vector<CrackConduit> conduits;
  std::vector<CrackMouth> mouths;
};

/// Joins the cracks of a body where they meet. A crack passes width^3 / (12 roughness) times its breadth over
/// the distance; where it narrows evenly from its middle to an end, 2 w_m^2 w_e^2 / (w_m + w_e) stands for
/// width^3. Where several meet, the pressure of their common end is eliminated (star and delta, Karimi-Fard,
/// Durlofsky and Aziz 2004): an end holds no vapour. At an end on the outline, every crack opens to the
/// outside alone.
///
/// \param opens      true for outer faces that are not sealed
/// \param roughness  1 for smooth walls, up to 5
CrackNetwork crack_network(const MoistureMesh& mesh, const std::vector<OpenFace>& cracks,
                           const std::vector<bool>& opens, double roughness);

/// Water in a crack at a pressure of vapour. Steam condenses at saturation, within 3 % of it, into half of
/// the gap; then it takes pressure to condense more. What has condensed stays where it is and hinders no
/// vapour. The rule keeps a cold crack from carrying steam of any pressure, and Newton's method from a jump.
template <class Real>
PoreWater<Real> crack_water(const PoreConditions& at, const Real& pressure) {
  constexpr double kWithin = 0.03, kHalf = 0.5, kBeyond = 0.05;
  PoreWater<Real> w;
  w.vapour_density = vapour_density(at, pressure);
  const Real over = pressure / Real(at.saturation_pressure);
  Real condensed = 0.0;  // share of the gap
  if (value_of(over) >= 1.0 + kWithin) {
    condensed = Real(kHalf) + Real(kBeyond) * (over - Real(1.0 + kWithin));
  } else if (value_of(over) > 1.0 - kWithin) {
    const Real t = (over - Real(1.0 - kWithin)) / Real(2.0 * kWithin);
    condensed = Real(kHalf) * t * t * (Real(3.0) - Real(2.0) * t);
  }
  w.content = w.vapour_density + Real(at.liquid_density) * condensed;
  w.saturation = condensed;
  w.liquid_pressure = pressure;
  w.liquid_mobility = 0.0;
  w.vapour_mobility = 1.0 / at.vapour_viscosity;
  w.diffusion = 1.0;  // the half of the cell beside it limits what diffuses
  return w;
}

}  // namespace pyroclast
