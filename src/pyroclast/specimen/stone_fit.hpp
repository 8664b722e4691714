#pragma once

#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// How well the blocks of a stone have its shape.
struct StoneFit {
  double extent = 0.0;            ///< area of the stone, m², or volume, m³
  double size = 0.0;              ///< length of its outline, m, or area of its surface, m²
  int blocks = 0;                 ///< number of its blocks
  double extent_of_blocks = 0.0;  ///< m² or m³
  double interface = 0.0;         ///< length, or area, of the facets between its blocks and others
  double deviation = 0.0;         ///< root of the mean square distance of these facets from the surface, m
};

/// Returns the fit of each stone; empty where it is not known of which stone blocks are.
template <int Dim>
std::vector<StoneFit> fits_of(const Specimen<Dim>& specimen);

}  // namespace pyroclast::specimen
