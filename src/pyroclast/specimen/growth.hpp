#pragma once

#include <optional>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/placement.hpp"

namespace pyroclast::specimen {

/// Places grains that are too many to be placed one by one: all of them begin smaller, at random centres,
/// grow, and push each other away where they come too close, as Lubachevsky and Stillinger (J. Stat. Phys.
/// 60, 561, 1990) grow discs, but without velocities. No grain turns. \param grains    grains as large as
/// they will be, around any centre \param gap       least gap between grains, and to the room's surface, m
/// \param standing  grains that stand and do not move
/// \return the grains at their places; none where they do not come apart
template <int Dim>
std::optional<std::vector<Grain<Dim>>> grow(std::vector<Grain<Dim>> grains, const Room<Dim>& room, double gap,
                                            const std::vector<Grain<Dim>>& standing, Random& random);

}  // namespace pyroclast::specimen
