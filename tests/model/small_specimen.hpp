#pragma once

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast {

/// A specimen of 50 mm x 100 mm that is made in no time.
inline specimen::Specimen small_specimen(int blocks = 300) {
  specimen::SpecimenParameters p;
  p.width = 0.05;
  p.height = 0.1;
  p.seed = 2;
  p.aggregates = {.fraction = 0.3,
                  .d_min = 5e-3,
                  .d_max = 15e-3,
                  .fuller_exponent = 0.45,
                  .sieves = {5e-3, 15e-3},
                  .minimum_gap = 5e-4,
                  .attempts = 10000};
  p.blocks.count = blocks;
  p.blocks.shortest_edge = 0.2;
  return specimen::make_specimen(p);
}

}  // namespace pyroclast
