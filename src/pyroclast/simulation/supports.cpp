#include "pyroclast/simulation/supports.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

namespace {

/// Two held lines are one where they are this near to each other, in sizes of the body.
constexpr double kSameLine = 1e-6;

}  // namespace

/// A line on which a component is held hinders motion along it, and all of them any turn but that about a
/// point which lies on every one of them.
template <>
std::optional<std::string> Supports<2>::free_motion() const {
  const auto size_of = [&] {
    double size = 0.0;
    for (const auto& x : model_.position) size = std::max(size, norm(x - model_.position.front()));
    return size;
  };
  std::array<bool, 2> any{};
  // where lines meet: x of those along y, and y of those along x
  std::array<double, 2> least{{1e300, 1e300}}, most{{-1e300, -1e300}};
  for (int g = 0; g < model_.gridpoint_count(); ++g)
    for (const int c : {0, 1})
      if (held_[g][c]) {
        any[c] = true;
        least[c] = std::min(least[c], model_.position[g][1 - c]);
        most[c] = std::max(most[c], model_.position[g][1 - c]);
      }
  if (!any[0] && !any[1]) return "along x and y, and turning";
  if (!any[0]) return "along x";
  if (!any[1]) return "along y";
  const double tolerance = kSameLine * size_of();
  if (most[0] - least[0] <= tolerance && most[1] - least[1] <= tolerance) return "turning about one point";
  return std::nullopt;
}

Supports<2> supports_of(const Simulation& simulation) {
  Supports<2> supports(simulation.model());
  for (int g = 0; g < simulation.model().gridpoint_count(); ++g)
    for (const int c : {0, 1})
      if (simulation.mechanics().is_prescribed(g, c)) supports.hold(g, c);
  return supports;
}

bool has_weight(const Simulation& simulation) {
  const Vec<2> gravity = simulation.mechanics().state().gravity;
  return gravity[0] != 0.0 || gravity[1] != 0.0;
}

void require_held(const Simulation& simulation, const Supports<2>& supports, const std::string& what) {
  if (simulation.has_press()) return;
  if (const auto motion = supports.free_motion())
    throw Error(
        fmt::format("{}: nothing holds the body against moving {}, but it has weight or a load: hold "
                    "a set of it by a drive, or set gravity to 0",
                    what, *motion));
}

}  // namespace pyroclast
