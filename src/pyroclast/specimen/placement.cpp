#include "pyroclast/specimen/placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/gradation.hpp"
#include "pyroclast/specimen/growth.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/stone.hpp"
#include "pyroclast/specimen/stone_grid.hpp"

namespace pyroclast::specimen {
namespace {

/// Share of the specimen above which stones and half of the gaps around them are not even tried. Discs of one
/// size fill 0.547 of the plane at random, balls 0.382 of space; those of a gradation fill more.
template <int Dim>
constexpr double kDensestPlacement = Dim == 2 ? 0.8 : 0.7;

/// Finds a free place for a stone; tells whether there is one within `attempts` centres.
template <int Dim>
bool find_place(Stone<Dim>& stone, const Room<Dim>& room, const StoneGrid<Dim>& grid,
                const AggregateParameters& parameters, Random& random) {
  const double inner = stone.shape ? stone.shape->inner_radius() : 0.5 * stone.diameter;
  const double margin = inner + parameters.minimum_gap;
  for (int d = 0; d < Dim; ++d)
    if (2.0 * margin > room.high[d] - room.low[d]) return false;
  for (int attempt = 0; attempt < parameters.attempts; ++attempt) {
    for (int d = 0; d < Dim; ++d)
      stone.centre[d] = random.uniform(room.low[d] + margin, room.high[d] - margin);
    if (room.distance && room.distance(stone.centre) > -margin) continue;
    if (stone.shape && !lies_within(stone, room, parameters.minimum_gap)) continue;
    if (!grid.overlaps(stone, parameters.minimum_gap)) return true;
  }
  return false;
}

/// Throws Error for stones that can never fit: with their gaps they would take more than any packing.
template <int Dim>
void require_feasible(const std::vector<Stone<Dim>>& stones, double specimen_extent,
                      const AggregateParameters& parameters) {
  double sum = 0.0;
  for (const auto& stone : stones) {
    const double larger = (stone.diameter + parameters.minimum_gap) / stone.diameter;
    sum += stone.shape ? extent(stone) * larger * larger
                       : extent_of_round<Dim>(stone.diameter + parameters.minimum_gap);
  }
  if (sum / specimen_extent < kDensestPlacement<Dim>) return;
  throw Error(fmt::format(
      "{}: the aggregates of a fraction of {:.4g} cannot fit: {} {} of {:.4g} to {:.4g} mm with gaps of "
      "{:.4g} mm between them "
      "would take {:.2f} of the specimen, and random placement fills {} at most; allow a lower fraction, a "
      "larger d_min, or a smaller minimum_gap",
      parameters.place, parameters.fraction, stones.size(),
      stones.front().shape ? "stones" : (Dim == 2 ? "circles" : "balls"), 1e3 * stones.back().diameter,
      1e3 * stones.front().diameter, 1e3 * parameters.minimum_gap, sum / specimen_extent,
      kDensestPlacement<Dim>));
}

template <int Dim>
[[noreturn]] void throw_no_place(const std::vector<Stone<Dim>>& stones, std::size_t placed,
                                 double specimen_extent, const AggregateParameters& parameters) {
  throw Error(fmt::format(
      "{}: the aggregates do not fit: after {} of {}, {} fraction of {:.3f} of the {:.3f} asked for, "
      "one of {:.4g} mm found no place in {} attempts, nor do all of them come apart while they grow; allow "
      "a "
      "lower fraction, a smaller minimum_gap than {:.4g} mm, or more attempts",
      parameters.place, placed, stones.size(), Dim == 2 ? "an area" : "a volume",
      extent_of(std::span(stones).first(placed)) / specimen_extent, parameters.fraction,
      1e3 * stones[placed].diameter, parameters.attempts, 1e3 * parameters.minimum_gap));
}

}  // namespace

template <int Dim>
bool lies_within(const Stone<Dim>& stone, const Room<Dim>& room, double distance) {
  const auto is_in_box = [&](const Vec<Dim>& point, double least) {
    for (int d = 0; d < Dim; ++d)
      if (point[d] - least < room.low[d] || point[d] + least > room.high[d]) return false;
    return true;
  };
  if (!stone.shape) {
    const double least = 0.5 * stone.diameter + distance;
    return is_in_box(stone.centre, least) && (!room.distance || room.distance(stone.centre) <= -least);
  }
  if constexpr (Dim == 2) {
    if (!std::ranges::all_of(corners_of(stone), [&](const Vec<2>& c) { return is_in_box(c, distance); }))
      return false;
    return !room.distance || (room.distance(place_within(stone)) < 0.0 &&
                              std::ranges::none_of(room.lines, [&](const std::array<Vec<2>, 2>& line) {
                                return are_closer(stone, line[0], line[1], distance);
                              }));
  } else {
    if (!room.distance)
      return std::ranges::all_of(corners_of(stone), [&](const Vec<3>& c) { return is_in_box(c, distance); });
    if (room.distance(stone.centre) <= -reach(stone) - distance) return true;
    return std::ranges::all_of(corners_of(stone),
                               [&](const Vec<3>& c) { return room.distance(c) <= -distance; });
  }
}

template bool lies_within(const Stone<2>&, const Room<2>&, double);
template bool lies_within(const Stone<3>&, const Room<3>&, double);

template <int Dim>
std::vector<Stone<Dim>> place(const std::vector<Stone<Dim>>& stones, const Room<Dim>& room,
                              const AggregateParameters& parameters, const std::vector<Stone<Dim>>& standing,
                              Random& random) {
  require_feasible<Dim>(stones, room.extent, parameters);
  // Bins twice the smallest diameter: a small stone looks at few neighbours, a large one lists in few bins.
  StoneGrid<Dim> grid(room.low, room.high, 2.0 * parameters.d_min);
  for (const auto& stone : standing) grid.insert(stone);
  for (std::size_t i = 0; i < stones.size(); ++i) {
    Stone<Dim> stone = stones[i];
    if (!find_place(stone, room, grid, parameters, random)) {
      auto grown = grow(stones, room, parameters.minimum_gap, standing, random);
      if (!grown) throw_no_place<Dim>(stones, i, room.extent, parameters);
      return std::move(*grown);
    }
    grid.insert(stone);
  }
  return {grid.stones().begin() + static_cast<std::ptrdiff_t>(standing.size()), grid.stones().end()};
}

template std::vector<Stone<2>> place(const std::vector<Stone<2>>&, const Room<2>&, const AggregateParameters&,
                                     const std::vector<Stone<2>>&, Random&);
template std::vector<Stone<3>> place(const std::vector<Stone<3>>&, const Room<3>&, const AggregateParameters&,
                                     const std::vector<Stone<3>>&, Random&);

template <int Dim>
void draw_and_place(const Room<Dim>& room, const AggregateParameters& parameters, int phase, int kind,
                    Random& random, std::vector<Stone<Dim>>& standing) {
  const auto stones = draw_stones<Dim>(parameters, room.extent, random);
  for (Stone<Dim>& stone : place(stones, room, parameters, standing, random)) {
    stone.phase = phase;
    stone.kind = kind;
    standing.push_back(stone);
  }
}

template void draw_and_place(const Room<2>&, const AggregateParameters&, int, int, Random&,
                             std::vector<Stone<2>>&);
template void draw_and_place(const Room<3>&, const AggregateParameters&, int, int, Random&,
                             std::vector<Stone<3>>&);

void require_placed(double placed, double asked, const AggregateParameters& parameters) {
  if (std::abs(placed - asked) > 0.01)
    throw Error(fmt::format(
        "{}: the aggregates take up a fraction of {:.4f}, {:.4f} was asked for and 0.01 is allowed between "
        "them: the smallest aggregate, {:.4g} m, is too large for the specimen, or hardly any is drawn by "
        "the grading",
        parameters.place, placed, asked, parameters.d_min));
}

namespace {

const Region& section_of(const Region& region) {
  return region;
}
const Region& section_of(const Prism& body) {
  return body.section();
}
Vec<2> in_section_of(const Region& /*region*/, const Vec<2>& place) {
  return place;
}
Vec<2> in_section_of(const Prism& body, const Vec<3>& place) {
  return body.in_section(place);
}

Vec<2> direction_in(std::integral_constant<int, 2> /*dimension*/, Random& random) {
  const double angle = random.uniform(0.0, std::numbers::pi);
  return {{std::cos(angle), std::sin(angle)}};
}
Vec<3> direction_in(std::integral_constant<int, 3> /*dimension*/, Random& random) {
  const double z = random.uniform(-1.0, 1.0), angle = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double across = std::sqrt(1.0 - z * z);
  return {{across * std::cos(angle), across * std::sin(angle), z}};
}

}  // namespace

template <int Dim>
std::vector<Fibre<Dim>> place_fibres(const FibreParameters& p, const OutlineOf<Dim>& outline,
                                     std::span<const Stone<Dim>> standing, Random& random) {
  const auto fits = [&](const Fibre<Dim>& fibre) {
    for (const Vec<Dim>& end : {fibre.from, fibre.to})
      if (outline.distance_before_cuts(end) > -p.minimum_gap) return false;
    const Vec<2> from = in_section_of(outline, fibre.from), to = in_section_of(outline, fibre.to);
    const auto meets = [&](const Piece& piece) {
      return distance_of_segments(from, to, piece.from, piece.to) < p.minimum_gap ||
             cross_each_other(from, to, piece.from, piece.to);
    };
    return std::ranges::none_of(section_of(outline).pieces_before_cuts(), meets) &&
           std::ranges::none_of(standing, [&](const Stone<Dim>& a) {
             return are_closer(a, fibre.from, fibre.to, p.minimum_gap);
           });
  };
  std::vector<Fibre<Dim>> fibres;
  for (int i = 0; i < p.count; ++i) {
    int attempt = 0;
    for (; attempt < p.attempts; ++attempt) {
      Vec<Dim> centre;
      for (int d = 0; d < Dim; ++d) centre[d] = random.uniform(outline.low()[d], outline.high()[d]);
      const Vec<Dim> half = direction_in(std::integral_constant<int, Dim>{}, random) * (0.5 * p.length);
      const Fibre<Dim> fibre{centre - half, centre + half};
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

template std::vector<Fibre<2>> place_fibres<2>(const FibreParameters&, const Region&,
                                               std::span<const Stone<2>>, Random&);
template std::vector<Fibre<3>> place_fibres<3>(const FibreParameters&, const Prism&,
                                               std::span<const Stone<3>>, Random&);

}  // namespace pyroclast::specimen
