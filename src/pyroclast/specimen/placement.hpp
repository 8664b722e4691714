#pragma once

#include <span>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Takes and places: puts a circle of each diameter (m, largest first) at a random centre in the region.
/// There the circle keeps `minimum_gap` to the others, to circles that stand already, and to the outline as
/// it was before notches were cut: a saw goes through aggregate. Throws Error, and says how much is missing,
/// when a circle finds no place within `attempts` centres.
std::vector<Aggregate> place(std::span<const double> diameters, const Region& region,
                             const AggregateParameters& parameters, std::span<const Aggregate> standing,
                             Random& random);

/// Puts each fibre at a random place, in a random direction, where it keeps `minimum_gap` to the aggregates
/// and to the outline; fibres may cross each other. Throws Error when a fibre finds no place.
std::vector<Fibre> place_fibres(const FibreParameters& parameters, const Region& region,
                                std::span<const Aggregate> standing, Random& random);

}  // namespace pyroclast::specimen
