#pragma once

#include <optional>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/placement.hpp"

namespace pyroclast::specimen {

/// Places stones that are too many to be placed one by one: all of them begin smaller, at random centres,
/// grow, and push each other away where they come too close, as Lubachevsky and Stillinger (J. Stat. Phys.
/// 60, 561, 1990) grow discs, but without velocities. No stone turns. \param stones    stones as large as
/// they will be, around any centre \param gap       least gap between stones, and to the room's surface, m
/// \param standing  stones that stand and do not move
/// \return the stones at their places; none where they do not come apart
template <int Dim>
std::optional<std::vector<Stone<Dim>>> grow(std::vector<Stone<Dim>> stones, const Room<Dim>& room, double gap,
                                            const std::vector<Stone<Dim>>& standing, Random& random);

}  // namespace pyroclast::specimen
