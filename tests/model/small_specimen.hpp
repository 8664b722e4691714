#pragma once

#include "pyroclast/model/concrete_model.hpp"

namespace pyroclast {

/// A specimen of 50 mm x 100 mm that is made in no time.
inline specimen::Specimen<2> small_specimen(int blocks = 300) {
  specimen::SpecimenParameters p;
  p.outline = specimen::Region::rectangle(0.05, 0.1);
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

/// A specimen between two platens; thicknesses in m.
inline ModelOf<2> between_platens(const specimen::Specimen<2>& specimen, double of_platens,
                                  double thickness) {
  return make_model(specimen, thickness, {}, platens(of_platens));
}

}  // namespace pyroclast
