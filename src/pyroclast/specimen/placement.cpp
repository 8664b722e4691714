#include "pyroclast/specimen/placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/gradation.hpp"
#include "pyroclast/specimen/grain.hpp"
#include "pyroclast/specimen/grain_grid.hpp"
#include "pyroclast/specimen/growth.hpp"
#include "pyroclast/specimen/polygon.hpp"

namespace pyroclast::specimen {
namespace {

/// Share of the specimen above which stones and half of the gaps around them are not even tried. Discs of one
/// size fill 0.547 of the plane at random, balls 0.382 of space; those of a gradation fill more.
template <int Dim>
constexpr double kDensestPlacement = Dim == 2 ? 0.8 : 0.7;

/// Finds a free place for a grain; tells whether there is one within `attempts` centres.
template <int Dim>
bool find_place(Grain<Dim>& grain, const Room<Dim>& room, const GrainGrid<Dim>& grid,
                const AggregateParameters& parameters, Random& random) {
  const double inner = grain.shape ? grain.shape->inner_radius() : 0.5 * grain.diameter;
  const double margin = inner + parameters.minimum_gap;
  for (int d = 0; d < Dim; ++d)
    if (2.0 * margin > room.high[d] - room.low[d]) return false;
  for (int attempt = 0; attempt < parameters.attempts; ++attempt) {
    for (int d = 0; d < Dim; ++d)
      grain.centre[d] = random.uniform(room.low[d] + margin, room.high[d] - margin);
    if (room.distance && room.distance(grain.centre) > -margin) continue;
    if (grain.shape && !lies_within(grain, room, parameters.minimum_gap)) continue;
    if (!grid.overlaps(grain, parameters.minimum_gap)) return true;
  }
  return false;
}

/// Throws Error for grains that can never fit: with their gaps they would take more than any packing.
template <int Dim>
void require_feasible(const std::vector<Grain<Dim>>& grains, double specimen_extent,
                      const AggregateParameters& parameters) {
  double sum = 0.0;
  for (const auto& grain : grains) {
    const double larger = (grain.diameter + parameters.minimum_gap) / grain.diameter;
    sum += grain.shape ? extent(grain) * larger * larger
                       : extent_of_round<Dim>(grain.diameter + parameters.minimum_gap);
  }
  if (sum / specimen_extent < kDensestPlacement<Dim>) return;
  throw Error(fmt::format(
      "{}: the aggregates of a fraction of {:.4g} cannot fit: {} {} of {:.4g} to {:.4g} mm with gaps of "
      "{:.4g} mm between them "
      "would take {:.2f} of the specimen, and random placement fills {} at most; allow a lower fraction, a "
      "larger d_min, or a smaller minimum_gap",
      parameters.place, parameters.fraction, grains.size(),
      grains.front().shape ? "grains" : (Dim == 2 ? "circles" : "balls"), 1e3 * grains.back().diameter,
      1e3 * grains.front().diameter, 1e3 * parameters.minimum_gap, sum / specimen_extent,
      kDensestPlacement<Dim>));
}

template <int Dim>
[[noreturn]] void throw_no_place(const std::vector<Grain<Dim>>& grains, std::size_t placed,
                                 double specimen_extent, const AggregateParameters& parameters) {
  throw Error(fmt::format(
      "{}: the aggregates do not fit: after {} of {}, {} fraction of {:.3f} of the {:.3f} asked for, "
      "one of {:.4g} mm found no place in {} attempts, nor do all of them come apart while they grow; allow "
      "a "
      "lower fraction, a smaller minimum_gap than {:.4g} mm, or more attempts",
      parameters.place, placed, grains.size(), Dim == 2 ? "an area" : "a volume",
      extent_of(std::span(grains).first(placed)) / specimen_extent, parameters.fraction,
      1e3 * grains[placed].diameter, parameters.attempts, 1e3 * parameters.minimum_gap));
}

}  // namespace

template <int Dim>
bool lies_within(const Grain<Dim>& grain, const Room<Dim>& room, double distance) {
  const auto is_in_box = [&](const Vec<Dim>& point, double least) {
    for (int d = 0; d < Dim; ++d)
      if (point[d] - least < room.low[d] || point[d] + least > room.high[d]) return false;
    return true;
  };
  if (!grain.shape) {
    const double least = 0.5 * grain.diameter + distance;
    return is_in_box(grain.centre, least) && (!room.distance || room.distance(grain.centre) <= -least);
  }
  if constexpr (Dim == 2) {
    if (!std::ranges::all_of(corners_of(grain), [&](const Vec<2>& c) { return is_in_box(c, distance); }))
      return false;
    return !room.distance || (room.distance(place_within(grain)) < 0.0 &&
                              std::ranges::none_of(room.lines, [&](const std::array<Vec<2>, 2>& line) {
                                return are_closer(grain, line[0], line[1], distance);
                              }));
  } else {
    if (!room.distance)
      return std::ranges::all_of(corners_of(grain), [&](const Vec<3>& c) { return is_in_box(c, distance); });
    if (room.distance(grain.centre) <= -reach(grain) - distance) return true;
    return std::ranges::all_of(corners_of(grain),
                               [&](const Vec<3>& c) { return room.distance(c) <= -distance; });
  }
}

template bool lies_within(const Grain<2>&, const Room<2>&, double);
template bool lies_within(const Grain<3>&, const Room<3>&, double);

template <int Dim>
std::vector<Grain<Dim>> place(const std::vector<Grain<Dim>>& grains, const Room<Dim>& room,
                              const AggregateParameters& parameters, const std::vector<Grain<Dim>>& standing,
                              Random& random) {
  require_feasible<Dim>(grains, room.extent, parameters);
  // Bins twice the smallest diameter: a small grain looks at few neighbours, a large one lists in few bins.
  GrainGrid<Dim> grid(room.low, room.high, 2.0 * parameters.d_min);
  for (const auto& grain : standing) grid.insert(grain);
  for (std::size_t i = 0; i < grains.size(); ++i) {
    Grain<Dim> grain = grains[i];
    if (!find_place(grain, room, grid, parameters, random)) {
      auto grown = grow(grains, room, parameters.minimum_gap, standing, random);
      if (!grown) throw_no_place<Dim>(grains, i, room.extent, parameters);
      return std::move(*grown);
    }
    grid.insert(grain);
  }
  return {grid.stones().begin() + static_cast<std::ptrdiff_t>(standing.size()), grid.stones().end()};
}

template std::vector<Grain<2>> place(const std::vector<Grain<2>>&, const Room<2>&, const AggregateParameters&,
                                     const std::vector<Grain<2>>&, Random&);
template std::vector<Grain<3>> place(const std::vector<Grain<3>>&, const Room<3>&, const AggregateParameters&,
                                     const std::vector<Grain<3>>&, Random&);

template <int Dim>
void draw_and_place(const Room<Dim>& room, const AggregateParameters& parameters, int phase, int kind,
                    Random& random, std::vector<Grain<Dim>>& standing) {
  const auto grains = draw_grains<Dim>(parameters, room.extent, random);
  for (Grain<Dim>& grain : place(grains, room, parameters, standing, random)) {
    grain.phase = phase;
    grain.kind = kind;
    standing.push_back(grain);
  }
}

template void draw_and_place(const Room<2>&, const AggregateParameters&, int, int, Random&,
                             std::vector<Grain<2>>&);
template void draw_and_place(const Room<3>&, const AggregateParameters&, int, int, Random&,
                             std::vector<Grain<3>>&);

void require_placed(double placed, double asked, const AggregateParameters& parameters) {
  if (std::abs(placed - asked) > 0.01)
    throw Error(fmt::format(
        "{}: the aggregates take up a fraction of {:.4f}, {:.4f} was asked for and 0.01 is allowed between "
        "them: the smallest aggregate, {:.4g} m, is too large for the specimen, or hardly any is drawn by "
        "the grading",
        parameters.place, placed, asked, parameters.d_min));
}

std::vector<Fibre> place_fibres(const FibreParameters& p, const Region& region,
                                std::span<const Grain<2>> standing, Random& random) {
  const auto fits = [&](const Fibre& fibre) {
    for (const Vec<2>& end : {fibre.from, fibre.to})
      if (region.distance_before_cuts(end) > -p.minimum_gap) return false;
    const auto meets = [&](const Piece& piece) {
      return distance_of_segments(fibre.from, fibre.to, piece.from, piece.to) < p.minimum_gap ||
             cross_each_other(fibre.from, fibre.to, piece.from, piece.to);
    };
    return std::ranges::none_of(region.pieces_before_cuts(), meets) &&
           std::ranges::none_of(standing, [&](const Grain<2>& a) {
             return are_closer(a, fibre.from, fibre.to, p.minimum_gap);
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
