#include "pyroclast/app/specimen_scatter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace pyroclast::app {

namespace {

constexpr auto kStudiedStrengths = std::to_array<StudiedStrength>({
    {0.42, 6, 10, 0.12},
    {0.30, 5, 10, 0.08},
    {0.21, 8, 10, 0.06},
    {0.15, 8, 10, 0.03},
    {0.09, 5, 5, 0.03},
});

}  // namespace

std::optional<StudiedStrength> studied_like(const specimen::SpecimenParameters& s) {
  if (s.prism() || s.blocks.count == 0 || !s.blocks.finer.empty() || s.aggregates.fraction <= 0.0)
    return std::nullopt;
  const double size = s.block_size() / s.aggregates.d_max;
  return *std::ranges::min_element(kStudiedStrengths, {}, [&](const StudiedStrength& studied) {
    return std::abs(std::log(size / studied.size));
  });
}

}  // namespace pyroclast::app
