#include "pyroclast/specimen/growth.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "pyroclast/specimen/stone_grid.hpp"

namespace pyroclast::specimen {
namespace {

constexpr double kSmallest = 0.6;  ///< size at which stones begin, as a share
constexpr int kStages = 16;        ///< sizes from the smallest to the whole one
/// Most rounds of pushes at one size. Those before the last need not come to an end.
constexpr int kRoundsOfStage = 60, kRoundsOfLast = 6000;
/// Gap beyond the one asked for to which stones are pushed apart, as a share of the smallest diameter:
/// without it, pushes would end only in the limit.
constexpr double kBeyond = 2e-3;
/// Push with which a size before the last is left, as the same share.
constexpr double kLoose = 0.02;

template <int Dim>
class Growth {
 public:
  Growth(const std::vector<Stone<Dim>>& stones, const Room<Dim>& room, double gap,
         const std::vector<Stone<Dim>>& standing)
      : whole_(stones), room_(room), gap_(gap), standing_(standing) {
    for (const auto& stone : whole_) smallest_ = std::min(smallest_, stone.diameter);
  }

  std::optional<std::vector<Stone<Dim>>> run(Random& random) {
    stones_ = whole_;
    for (auto& stone : stones_) {
      const double margin = std::min(reach(stone) + gap_, 0.45 * least_width());
      do {
        for (int d = 0; d < Dim; ++d)
          stone.centre[d] = random.uniform(room_.low[d] + margin, room_.high[d] - margin);
      } while (room_.distance && room_.distance(stone.centre) > 0.0);
    }
    for (int stage = 0; stage <= kStages; ++stage) {
      set_size(kSmallest + (1.0 - kSmallest) * stage / kStages);
      const bool is_last = stage == kStages;
      for (int round = 0; round < (is_last ? kRoundsOfLast : kRoundsOfStage); ++round)
        if (const double lacking = push_apart(); is_last && lacking <= kBeyond * smallest_) {
          if (fits()) return stones_;
        } else if (!is_last && lacking <= kLoose * smallest_) {
          break;
        }
    }
    return std::nullopt;
  }

 private:
  double least_width() const {
    double width = room_.high[0] - room_.low[0];
    for (int d = 1; d < Dim; ++d) width = std::min(width, room_.high[d] - room_.low[d]);
    return width;
  }

  void set_size(double share) {
    for (std::size_t i = 0; i < stones_.size(); ++i) {
      const Vec<Dim> centre = stones_[i].centre;
      stones_[i] = whole_[i];
      stones_[i].centre = centre;
      stones_[i].diameter *= share;
      if (whole_[i].shape) stones_[i].shape = whole_[i].shape->scaled(share);
    }
  }

  /// Moves each stone by the pushes of all that are too close to it. Returns the largest of these before, m.
  double push_apart() {
    const double target = gap_ + kBeyond * smallest_;
    StoneGrid<Dim> grid(room_.low, room_.high, 2.0 * smallest_);
    for (const auto& stone : stones_) grid.insert(stone);
    for (const auto& stone : standing_) grid.insert(stone);
    std::vector<Vec<Dim>> move(stones_.size());
    std::vector<int> nearby;
    double largest = 0.0;
    for (std::size_t i = 0; i < stones_.size(); ++i) {
      const Stone<Dim>& stone = stones_[i];
      Vec<Dim> half;
      half.c.fill(reach(stone) + target);
      grid.collect(stone.centre - half, stone.centre + half, nearby);
      for (const int number : nearby) {
        const auto other = static_cast<std::size_t>(number);
        const bool stands = other >= stones_.size();
        if (!stands && other <= i) continue;
        const Stone<Dim>& beside = grid.stones()[other];
        if (!are_closer(stone, beside, target)) continue;
        const Approach<Dim> near = approach(stone, beside);
        largest = std::max(largest, target - near.gap);
        const Vec<Dim> push = (target - near.gap) * near.direction;
        // the smaller one gives way
        const double share = stands ? 1.0 : extent(beside) / (extent(stone) + extent(beside));
        move[i] -= share * push;
        if (!stands) move[other] += (1.0 - share) * push;
      }
      largest = std::max(largest, push_from_surface(stone, target, move[i]));
    }
    for (std::size_t i = 0; i < stones_.size(); ++i) {
      // a stone between many is not thrown out by the sum of their pushes
      const double length = norm(move[i]), most = 0.25 * stones_[i].diameter;
      stones_[i].centre += length > most ? move[i] * (most / length) : move[i];
    }
    return largest;
  }

  /// Adds the push of the room's surface to a move. Returns its length, m.
  double push_from_surface(const Stone<Dim>& stone, double target, Vec<Dim>& move) const {
    if (lies_within(stone, room_, target)) return 0.0;
    if constexpr (Dim == 2)
      if (stone.shape && room_.distance && room_.distance(place_within(stone)) < 0.0) {
        const Vec<2> push = push_from_lines(stone, target);
        move += push;
        return norm(push);
      }
    std::vector<Vec<Dim>> points{stone.centre};
    double least = target + 0.5 * stone.diameter;
    if (stone.shape) {
      points = corners_of(stone);
      least = target;
    }
    Vec<Dim> push{};
    for (const Vec<Dim>& point : points)
      for (int d = 0; d < Dim; ++d) {
        const double below = room_.low[d] + least - point[d], above = point[d] - (room_.high[d] - least);
        if (below > push[d]) push[d] = below;
        if (above > 0.0 && -above < push[d]) push[d] = -above;
      }
    if (room_.distance) {
      Vec<Dim> worst = points.front();
      double out = -least;
      for (const Vec<Dim>& point : points)
        if (const double distance = room_.distance(point); distance > out) {
          out = distance;
          worst = point;
        }
      const double step = 1e-3 * smallest_;
      for (int d = 0; d < Dim && out > -least; ++d) {
        Vec<Dim> beside = worst;
        beside[d] += step;
        push[d] -= (out + least) * (room_.distance(beside) - room_.distance(worst)) / step;
      }
    }
    move += push;
    return norm(push);
  }

  /// Returns the push of the line of the room's surface that is nearest to a stone with an outline, m.
  Vec<2> push_from_lines(const Stone<2>& stone, double target) const {
    Approach<2> nearest{target, {}};
    for (const auto& [from, to] : room_.lines)
      if (are_closer(stone, from, to, target))
        if (const Approach<2> near = approach(stone, from, to); near.gap < nearest.gap) nearest = near;
    return (nearest.gap - target) * nearest.direction;
  }

  bool fits() const {
    StoneGrid<Dim> grid(room_.low, room_.high, 2.0 * smallest_);
    for (const auto& stone : standing_) grid.insert(stone);
    for (const auto& stone : stones_) {
      if (!lies_within(stone, room_, gap_) || grid.overlaps(stone, gap_)) return false;
      grid.insert(stone);
    }
    return true;
  }

  const std::vector<Stone<Dim>>& whole_;
  const Room<Dim>& room_;
  double gap_;
  const std::vector<Stone<Dim>>& standing_;
  double smallest_ = std::numeric_limits<double>::infinity();
  std::vector<Stone<Dim>> stones_;
};

}  // namespace

template <int Dim>
std::optional<std::vector<Stone<Dim>>> grow(std::vector<Stone<Dim>> stones, const Room<Dim>& room, double gap,
                                            const std::vector<Stone<Dim>>& standing, Random& random) {
  return Growth<Dim>(stones, room, gap, standing).run(random);
}

template std::optional<std::vector<Stone<2>>> grow(std::vector<Stone<2>>, const Room<2>&, double,
                                                   const std::vector<Stone<2>>&, Random&);
template std::optional<std::vector<Stone<3>>> grow(std::vector<Stone<3>>, const Room<3>&, double,
                                                   const std::vector<Stone<3>>&, Random&);

}  // namespace pyroclast::specimen
