#include "pyroclast/specimen/placement.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/gradation.hpp"
#include "pyroclast/specimen/stone_grid.hpp"

namespace pyroclast::specimen {
namespace {

/// Share of the specimen above which stones and half of the gaps around them are not even tried. Discs of one
/// size fill 0.547 of the plane at random, balls 0.382 of space; those of a gradation fill more.
template <int Dim>
constexpr double kDensestPlacement = Dim == 2 ? 0.8 : 0.7;

/// Finds a free place for a stone of this diameter; returns none when `attempts` centres are all taken.
template <int Dim>
std::optional<RoundStone<Dim>> find_place(double diameter, const Room<Dim>& room, const StoneGrid<Dim>& grid,
                                          const AggregateParameters& parameters, Random& random) {
  const double margin = 0.5 * diameter + parameters.minimum_gap;
  for (int d = 0; d < Dim; ++d)
    if (2.0 * margin > room.high[d] - room.low[d]) return std::nullopt;
  for (int attempt = 0; attempt < parameters.attempts; ++attempt) {
    RoundStone<Dim> stone{{}, diameter};
    for (int d = 0; d < Dim; ++d)
      stone.centre[d] = random.uniform(room.low[d] + margin, room.high[d] - margin);
    if (room.distance && room.distance(stone.centre) > -margin) continue;
    if (!grid.overlaps(stone, parameters.minimum_gap)) return stone;
  }
  return std::nullopt;
}

/// Throws Error for stones that can never fit: with their gaps they would take more than any packing.
template <int Dim>
void require_feasible(std::span<const double> diameters, double specimen_extent,
                      const AggregateParameters& parameters) {
  double extent = 0.0;
  for (const double d : diameters) extent += extent_of_round<Dim>(d + parameters.minimum_gap);
  if (extent / specimen_extent < kDensestPlacement<Dim>) return;
  throw Error(fmt::format(
      "{}: the aggregates of a fraction of {:.4g} cannot fit: {} {} of {:.4g} to {:.4g} mm with gaps of "
      "{:.4g} mm between them "
      "would take {:.2f} of the specimen, and random placement fills {} at most; allow a lower fraction, a "
      "larger d_min, or a smaller minimum_gap",
      parameters.place, parameters.fraction, diameters.size(), Dim == 2 ? "circles" : "balls",
      1e3 * diameters.back(), 1e3 * diameters.front(), 1e3 * parameters.minimum_gap, extent / specimen_extent,
      kDensestPlacement<Dim>));
}

template <int Dim>
[[noreturn]] void throw_no_place(std::span<const double> diameters, std::size_t placed,
                                 double specimen_extent, const AggregateParameters& parameters) {
  double extent = 0.0;
  for (std::size_t i = 0; i < placed; ++i) extent += extent_of_round<Dim>(diameters[i]);
  throw Error(fmt::format(
      "{}: the aggregates do not fit: after {} of {}, {} fraction of {:.3f} of the {:.3f} asked for, "
      "one of {:.4g} mm found no place in {} attempts; allow a lower fraction, "
      "a smaller minimum_gap than {:.4g} mm, or more attempts",
      parameters.place, placed, diameters.size(), Dim == 2 ? "an area" : "a volume", extent / specimen_extent,
      parameters.fraction, 1e3 * diameters[placed], parameters.attempts, 1e3 * parameters.minimum_gap));
}

}  // namespace

Room<2> room_in(const Region& region) {
  Room<2> room{region.box().low, region.box().high, region.area(), {}};
  if (!region.is_rectangle())
    room.distance = [&region](const Vec<2>& point) { return region.distance_before_cuts(point); };
  return room;
}

template <int Dim>
std::vector<RoundStone<Dim>> place(std::span<const double> diameters, const Room<Dim>& room,
                                   const AggregateParameters& parameters,
                                   const std::vector<RoundStone<Dim>>& standing, Random& random) {
  require_feasible<Dim>(diameters, room.extent, parameters);
  // Bins twice the smallest diameter: a small stone looks at few neighbours, a large one lists in few bins.
  StoneGrid<Dim> grid(room.low, room.high, 2.0 * parameters.d_min);
  for (const auto& stone : standing) grid.insert(stone);
  for (std::size_t i = 0; i < diameters.size(); ++i) {
    const auto stone = find_place(diameters[i], room, grid, parameters, random);
    if (!stone) throw_no_place<Dim>(diameters, i, room.extent, parameters);
    grid.insert(*stone);
  }
  return {grid.stones().begin() + static_cast<std::ptrdiff_t>(standing.size()), grid.stones().end()};
}

template std::vector<RoundStone<2>> place(std::span<const double>, const Room<2>&, const AggregateParameters&,
                                          const std::vector<RoundStone<2>>&, Random&);
template std::vector<RoundStone<3>> place(std::span<const double>, const Room<3>&, const AggregateParameters&,
                                          const std::vector<RoundStone<3>>&, Random&);

template <int Dim>
void draw_and_place(const Room<Dim>& room, const AggregateParameters& parameters, int phase, int kind,
                    Random& random, std::vector<RoundStone<Dim>>& standing) {
  const auto diameters = draw_diameters<Dim>(parameters, room.extent, random);
  for (RoundStone<Dim>& stone : place(diameters, room, parameters, standing, random)) {
    stone.phase = phase;
    stone.kind = kind;
    standing.push_back(stone);
  }
}

template void draw_and_place(const Room<2>&, const AggregateParameters&, int, int, Random&,
                             std::vector<RoundStone<2>>&);
template void draw_and_place(const Room<3>&, const AggregateParameters&, int, int, Random&,
                             std::vector<RoundStone<3>>&);

void require_placed(double placed, double asked, double d_min) {
  if (std::abs(placed - asked) > 0.01)
    throw Error(fmt::format(
        "The aggregates take up a fraction of {:.4f}, {:.4f} was asked for and 0.01 is allowed between "
        "them: the smallest aggregate, {:.4g} m, is too large for the specimen.",
        placed, asked, d_min));
}

std::vector<Fibre> place_fibres(const FibreParameters& p, const Region& region,
                                std::span<const Aggregate> standing, Random& random) {
  const auto fits = [&](const Fibre& fibre) {
    for (const Vec<2>& end : {fibre.from, fibre.to})
      if (region.distance_before_cuts(end) > -p.minimum_gap) return false;
    return std::ranges::none_of(standing, [&](const Aggregate& a) {
      return distance_from_segment(a.centre, fibre.from, fibre.to) < 0.5 * a.diameter + p.minimum_gap;
    });
  };
  std::vector<Fibre> fibres;
  for (int i = 0; i < p.count; ++i) {
    int attempt = 0;
    for (; attempt < p.attempts; ++attempt) {
      const Box& box = region.box();
      const Vec<2> centre{{random.uniform(box.low[0], box.high[0]), random.uniform(box.low[1], box.high[1])}};
      const double angle = random.uniform(0.0, std::numbers::pi);
      const Vec<2> half = Vec<2>{{std::cos(angle), std::sin(angle)}} * (0.5 * p.length);
      const Fibre fibre{centre - half, centre + half};
      if (!fits(fibre)) continue;
      fibres.push_back(fibre);
      break;
    }
    if (attempt == p.attempts)
      throw Error(
          fmt::format("{}: the fibres do not fit: {} of {} of the phase \"{}\", {:.4g} m long, found a place "
                      "within {} attempts; "
                      "allow fewer or shorter ones, a smaller minimum_gap than {:.4g} m, or more attempts",
                      p.place, fibres.size(), p.count, p.phase, p.length, p.attempts, p.minimum_gap));
  }
  return fibres;
}

}  // namespace pyroclast::specimen
