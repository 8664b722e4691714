#pragma once

#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/simulation/specimen_body.hpp"

namespace pyroclast {

/// Reads which sides of the specimen lie in planes of symmetry. Records an error for a side that cannot.
/// \param bearings  bearings on the specimen, its platens among them
std::vector<PlaneOfSymmetry> read_symmetry(const Section& root, const specimen::SpecimenParameters& specimen,
                                           const std::vector<Bearing>& bearings);

}  // namespace pyroclast
