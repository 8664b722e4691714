#pragma once

#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// How well the blocks of a grain have its shape.
struct GrainFit {
  double area = 0.0;            ///< area of the grain, m²
  double perimeter = 0.0;       ///< length of its outline, m
  int blocks = 0;               ///< number of its blocks
  double area_of_blocks = 0.0;  ///< m²
  double interface = 0.0;       ///< length of the edges between its blocks and others, m
  double deviation = 0.0;       ///< root of the mean square distance of these edges from the outline, m
};

/// Returns the fit of each grain; empty where it is not known of which grain blocks are.
std::vector<GrainFit> fits_of(const Specimen<2>& specimen);

}  // namespace pyroclast::specimen
