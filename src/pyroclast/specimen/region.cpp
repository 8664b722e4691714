#include "pyroclast/specimen/region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <clipper.hpp>
#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/polygon.hpp"

namespace pyroclast::specimen {
namespace {

/// Largest distance between points that count as one, as a share of the body's size.
constexpr double kSame = 1e-9;
/// Length by which the cut of a notch begins before its mouth, in widths of the notch: so the notch opens
/// where it meets a side askew.
constexpr double kBeforeMouth = 1.0;

double size_of(const Box& box) {
  return std::max(box.width(), box.height());
}

/// Grid of integers for Clipper (A. Johnson). Its cells are 1e-13 of the body's size, so that corners keep
/// twelve digits. A corner that comes back unchanged gets its own coordinates back.
class Grid {
 public:
  explicit Grid(const Box& box) : low_(box.low), cell_(size_of(box) * 1e-13) {}

  ClipperLib::Path path(const std::vector<Vec<2>>& corners) {
    ClipperLib::Path path;
    for (const Vec<2>& corner : corners) {
      const std::pair at{std::llround((corner[0] - low_[0]) / cell_),
                         std::llround((corner[1] - low_[1]) / cell_)};
      known_.emplace(at, corner);
      path.emplace_back(at.first, at.second);
    }
    return path;
  }

  Vec<2> corner(const ClipperLib::IntPoint& at) const {
    const auto known = known_.find({at.X, at.Y});
    if (known != known_.end()) return known->second;
    return low_ + Vec<2>{{static_cast<double>(at.X) * cell_, static_cast<double>(at.Y) * cell_}};
  }

 private:
  Vec<2> low_;
  double cell_;
  std::map<std::pair<long long, long long>, Vec<2>> known_;
};

/// Returns a loop in the sense asked for; its pieces keep their sides.
Loop turned(std::vector<Vec<2>> corners, std::vector<int> side, bool counter_clockwise) {
  if ((area(corners) > 0.0) != counter_clockwise) {
    std::ranges::reverse(corners);
    std::ranges::reverse(side);  // the piece from corner i to i + 1 is now that from n - 2 - i
    std::rotate(side.begin(), side.begin() + 1, side.end());  // Clang 14 cannot do ranges::rotate
  }
  return {std::move(corners), std::move(side)};
}

/// Throws Error where a loop has fewer than three corners or a piece without length, touches itself, or turns
/// back on itself.
void require_simple(const Loop& loop, const std::string& name, double size) {
  const std::size_t n = loop.corners.size();
  if (n < 3) throw Error(fmt::format("{}: {} corners, but it must have 3 or more", name, n));
  const auto at = [&](std::size_t i) { return loop.corners[i % n]; };
  for (std::size_t i = 0; i < n; ++i)
    if (norm(at(i + 1) - at(i)) <= kSame * size)
      throw Error(fmt::format("{}: corner {} and the next are both at ({:.6g}, {:.6g}) m", name, i + 1,
                              at(i)[0], at(i)[1]));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (distance_of_segments(at(i), at(i + 1), at(j), at(j + 1)) <= kSame * size)
        throw Error(fmt::format("{}: the side from corner {} and the side from corner {} cross or touch",
                                name, i + 1, j + 1));
    }
  for (std::size_t i = 0; i < n; ++i) {
    const Vec<2> before = at(i + n - 1) - at(i), after = at(i + 1) - at(i);
    if (std::abs(cross(before, after)) <= kSame * norm(before) * norm(after) && dot(before, after) > 0.0)
      throw Error(fmt::format("{}: at corner {} the outline turns back on itself", name, i + 1));
  }
}

double signed_distance(const std::vector<Piece>& pieces, const Vec<2>& p) {
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = false;
  for (const auto& [from, to, side] : pieces) {
    nearest = std::min(nearest, distance_from_segment(p, from, to));
    // a ray to the right crosses the outline an odd number of times
    if ((from[1] > p[1]) != (to[1] > p[1]) &&
        p[0] < from[0] + (p[1] - from[1]) / (to[1] - from[1]) * (to[0] - from[0]))
      inside = !inside;
  }
  return inside ? -nearest : nearest;
}

/// Returns the outline of the part that a notch takes out of the body, from before its mouth on.
std::vector<Vec<2>> outline_of(const Notch& notch) {
  const double length = notch.length(), before = kBeforeMouth * notch.width;
  const Vec<2> ahead = (notch.tip - notch.mouth) * (1.0 / length);
  const Vec<2> half = 0.5 * notch.width * Vec<2>{{-ahead[1], ahead[0]}};
  if (notch.point >= length) {
    const double widened = (length + before) / length;
    const Vec<2> begin = notch.mouth - before * ahead;
    return {begin - widened * half, notch.tip, begin + widened * half};
  }
  const Vec<2> begin = notch.mouth - before * ahead, shoulder = notch.tip - notch.point * ahead;
  return {begin - half, shoulder - half, notch.tip, shoulder + half, begin + half};
}

/// Returns the side from which each piece of a new loop comes; `otherwise` where it comes from no old piece.
std::vector<int> sides_of(const std::vector<Vec<2>>& corners, const std::vector<Piece>& old, int otherwise,
                          double tolerance) {
  std::vector<int> side;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec<2> middle = 0.5 * (corners[i] + corners[(i + 1) % corners.size()]);
    const auto found = std::ranges::find_if(old, [&](const Piece& piece) {
      return distance_from_segment(middle, piece.from, piece.to) <= tolerance;
    });
    side.push_back(found == old.end() ? otherwise : found->side);
  }
  return side;
}

}  // namespace

void LineSet::insert(int number) {
  if (count == kMost) throw Error("more than 4 lines of the outline meet in one point");
  line[count++] = number;
}

int shared_line(const LineSet& a, const LineSet& b, int begin, int end) {
  for (int i = 0; i < a.count; ++i)
    for (int j = 0; j < b.count; ++j)
      if (a.line[i] == b.line[j] && begin <= a.line[i] && a.line[i] < end) return a.line[i];
  return -1;
}

std::optional<LineSet> both(const LineSet& a, const LineSet& b) {
  std::array<int, 2 * LineSet::kMost> all;
  const auto end = std::set_union(a.line.begin(), a.line.begin() + a.count, b.line.begin(),
                                  b.line.begin() + b.count, all.begin());
  if (end - all.begin() > LineSet::kMost) return std::nullopt;
  LineSet result;
  for (auto at = all.begin(); at != end; ++at) result.insert(*at);
  return result;
}

std::vector<std::string> names_of(std::span<const Side> sides) {
  std::vector<std::string> names;
  for (const Side& side : sides) names.push_back(side.name);
  return names;
}

Vec<2> out_of(const Piece& piece) {
  const Vec<2> along = piece.to - piece.from;
  return Vec<2>{{along[1], -along[0]}} * (1.0 / norm(along));
}

std::vector<FlatPart> Region::flat_parts() const {
  std::vector<FlatPart> parts;
  for (const Piece& piece : pieces_)
    parts.push_back({{resized<3>(piece.from), resized<3>(piece.to)}, resized<3>(out_of(piece)), piece.side});
  return parts;
}

int find_side(std::span<const Side> sides, std::string_view name) {
  const auto found = std::ranges::find(sides, name, &Side::name);
  return found == sides.end() ? -1 : static_cast<int>(found - sides.begin());
}

Box box_of(std::span<const Vec<2>> points) {
  Box box{points.front(), points.front()};
  for (const Vec<2>& p : points)
    for (int i = 0; i < 2; ++i) {
      box.low[i] = std::min(box.low[i], p[i]);
      box.high[i] = std::max(box.high[i], p[i]);
    }
  return box;
}

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
/// Least number of sides by which a circle is drawn.
constexpr double kFewest = 12.0;

/// Returns the corners at some angles of a polygon around a circle's centre that has the circle's area.
/// \param twice_area  twice the polygon's area for a radius of 1
std::vector<Vec<2>> corners_at(const std::vector<double>& angles, const Vec<2>& centre, double diameter,
                               double twice_area) {
  const double radius = diameter * std::sqrt(0.5 * std::numbers::pi / twice_area);
  std::vector<Vec<2>> result;
  for (const double angle : angles)
    result.push_back(centre + radius * Vec<2>{{std::cos(angle), std::sin(angle)}});
  return result;
}

}  // namespace

std::vector<Vec<2>> circle_corners(const Vec<2>& centre, double diameter,
                                   const std::function<double(const Vec<2>&)>& side,
                                   std::vector<double> angles) {
  constexpr int kStretches = 720;  // of each arc
  const auto steps_in = [&](double angle, double part) {
    const Vec<2> place = centre + 0.5 * diameter * Vec<2>{{std::cos(angle), std::sin(angle)}};
    return part / std::min(kTurn / kFewest, 2.0 * side(place) / diameter);
  };
  std::ranges::sort(angles);
  std::vector<double> corners;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double arc = (i + 1 < angles.size() ? angles[i + 1] : angles.front() + kTurn) - angles[i];
    const double part = arc / kStretches;
    std::vector<double> steps{0.0};
    for (int k = 0; k < kStretches; ++k)
      steps.push_back(steps.back() + steps_in(angles[i] + (k + 0.5) * part, part));
    const int n = std::max(1, static_cast<int>(std::lround(steps.back())));
    corners.push_back(angles[i]);
    for (int k = 1; k < n; ++k) {
      const double wanted = steps.back() * k / n;
      const auto after = std::ranges::upper_bound(steps, wanted);
      const double share = (wanted - *(after - 1)) / (*after - *(after - 1));
      corners.push_back(angles[i] + (static_cast<double>(after - steps.begin() - 1) + share) * part);
    }
  }
  double twice_area = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    twice_area += std::sin((i + 1 < corners.size() ? corners[i + 1] : corners.front() + kTurn) - corners[i]);
  return corners_at(corners, centre, diameter, twice_area);
}

std::vector<Vec<2>> circle_corners(const Vec<2>& centre, double diameter, double side,
                                   std::vector<double> angles) {
  const double widest = std::min(kTurn / kFewest, 2.0 * side / diameter);
  std::ranges::sort(angles);
  std::vector<double> corners;
  double twice_area = 0.0;  // for a radius of 1
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double arc =
        i + 1 < angles.size() ? angles[i + 1] - angles[i] : angles.front() + kTurn - angles.back();
    const int n = std::max(1, static_cast<int>(std::lround(arc / widest)));
    for (int k = 0; k < n; ++k) corners.push_back(angles[i] + k * arc / n);
    twice_area += n * std::sin(arc / n);
  }
  return corners_at(corners, centre, diameter, twice_area);
}

Region Region::rectangle(double width, double height) {
  Region region = polygon({{{0.0, 0.0}}, {{width, 0.0}}, {{width, height}}, {{0.0, height}}},
                          {"bottom", "right", "top", "left"});
  region.area_ = width * height;
  region.is_rectangle_ = true;
  return region;
}

Region Region::polygon(std::vector<Vec<2>> corners, const std::vector<std::string>& names, bool is_round) {
  if (corners.size() < 3)
    throw Error(fmt::format("the outline has {} corners, but it must have 3 or more", corners.size()));
  if (names.size() != (is_round ? 1 : corners.size()))
    throw Error(
        fmt::format("the outline has {} corners and {} names of sides", corners.size(), names.size()));
  Region region;
  for (const std::string& name : names) region.sides_.push_back({name, is_round, false});
  std::vector<int> side;
  for (std::size_t i = 0; i < corners.size(); ++i) side.push_back(is_round ? 0 : static_cast<int>(i));
  region.loops_.push_back(turned(std::move(corners), std::move(side), true));
  require_simple(region.loops_.front(), "the outline", size_of(box_of(region.loops_.front().corners)));
  region.list_pieces();
  return region;
}

Region Region::with_holes(std::span<const Hole> holes) const {
  Region region = *this;
  region.is_rectangle_ = region.is_rectangle_ && holes.empty();
  const double size = size_of(box_);
  for (const Hole& hole : holes) {
    const int number = static_cast<int>(region.sides_.size());
    region.sides_.push_back({hole.name, hole.is_round, false});
    Loop loop = turned(hole.corners, std::vector<int>(hole.corners.size(), number), false);
    require_simple(loop, hole.name, size);
    for (std::size_t i = 0; i < loop.corners.size(); ++i) {
      const Vec<2>&from = loop.corners[i], &to = loop.corners[(i + 1) % loop.corners.size()];
      if (signed_distance(region.pieces_, from) >= 0.0)
        throw Error(fmt::format("{}: its corner at ({:.6g}, {:.6g}) m is not within the body", hole.name,
                                from[0], from[1]));
      for (const Piece& piece : region.pieces_)
        if (distance_of_segments(from, to, piece.from, piece.to) <= kSame * size)
          throw Error(fmt::format("{}: it meets {} near ({:.6g}, {:.6g}) m", hole.name,
                                  region.sides_[piece.side].name, from[0], from[1]));
    }
    for (const Loop& other : region.loops_)
      if (specimen::area(other.corners) < 0.0) {
        std::vector<Vec<2>> reversed(loop.corners.rbegin(), loop.corners.rend());
        std::vector<Piece> own;
        for (std::size_t i = 0; i < reversed.size(); ++i)
          own.push_back({reversed[i], reversed[(i + 1) % reversed.size()], number});
        if (signed_distance(own, other.corners.front()) < 0.0)
          throw Error(fmt::format("{}: it holds {}", hole.name, region.sides_[other.side.front()].name));
      }
    region.loops_.push_back(std::move(loop));
    region.list_pieces();
  }
  return region;
}

Region Region::with_notches(std::span<const Notch> notches) const {
  Region region = *this;
  if (notches.empty()) return region;
  region.is_rectangle_ = false;
  if (region.before_cuts_.empty()) region.before_cuts_ = pieces_;
  const double size = size_of(box_);
  for (const Notch& notch : notches) {
    const int number = static_cast<int>(region.sides_.size());
    region.sides_.push_back({notch.name, false, true});
    const double at_mouth = signed_distance(region.pieces_, notch.mouth);
    if (std::abs(at_mouth) > 1e-6 * size)
      throw Error(
          fmt::format("{}: it begins at ({:.6g}, {:.6g}) m, {:.4g} mm from the outline, but must "
                      "begin on it",
                      notch.name, notch.mouth[0], notch.mouth[1], 1e3 * std::abs(at_mouth)));
    if (signed_distance(region.pieces_, notch.tip) >= 0.0)
      throw Error(fmt::format("{}: its tip at ({:.6g}, {:.6g}) m is not within the body", notch.name,
                              notch.tip[0], notch.tip[1]));
    const double length = notch.length();
    const Vec<2> ahead = (notch.tip - notch.mouth) * (1.0 / length);
    const Vec<2> after_mouth = notch.mouth + 1e-6 * size * ahead;
    for (const Piece& piece : region.pieces_)
      if (cross_each_other(after_mouth, notch.tip, piece.from, piece.to))
        throw Error(fmt::format("{}: it crosses {}", notch.name, region.sides_[piece.side].name));
    for (const Notch& other : region.notches_)
      if (distance_of_segments(notch.mouth, notch.tip, other.mouth, other.tip) <= kSame * size)
        throw Error(fmt::format("{}: it crosses {}", notch.name, other.name));
    region.notches_.push_back(notch);
    if (notch.width == 0.0) continue;
    if (!(notch.width < length))
      throw Error(fmt::format("{}: {:.4g} mm wide and {:.4g} mm long, but a notch must be longer than wide",
                              notch.name, 1e3 * notch.width, 1e3 * length));
    const std::vector<Vec<2>> slot = outline_of(notch);
    Grid grid(region.box_);
    ClipperLib::Clipper clipper;
    for (const Loop& loop : region.loops_)
      clipper.AddPath(grid.path(loop.corners), ClipperLib::ptSubject, true);
    clipper.AddPath(grid.path(slot), ClipperLib::ptClip, true);
    ClipperLib::Paths paths;
    clipper.Execute(ClipperLib::ctDifference, paths, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
    std::vector<Loop> loops;
    for (const ClipperLib::Path& path : paths) {
      Loop loop;
      for (const ClipperLib::IntPoint& at : path) loop.corners.push_back(grid.corner(at));
      loop.side = sides_of(loop.corners, region.pieces_, number, 10 * kSame * size);
      loops.push_back(std::move(loop));
    }
    const auto outer =
        std::ranges::count_if(loops, [](const Loop& l) { return specimen::area(l.corners) > 0.0; });
    if (outer != 1 || loops.size() > region.loops_.size())
      throw Error(fmt::format("{}: it parts the body, or meets a hole", notch.name));
    region.loops_ = std::move(loops);
    region.list_pieces();
  }
  return region;
}

Region Region::with_patches(std::span<const Patch> patches) const {
  Region region = *this;
  region.is_rectangle_ = region.is_rectangle_ && patches.empty();
  const double tolerance = kSame * size_of(box_);
  for (const Patch& patch : patches) {
    const auto [loop, first] = region.corner_at(patch, patch.from);
    const auto [other_loop, last] = region.corner_at(patch, patch.to);
    auto& [corners, side] = region.loops_[loop];
    // inserting the second corner may have moved the first one on
    const std::size_t n = corners.size();
    const auto begin = static_cast<std::size_t>(
        std::ranges::find_if(corners, [&](const Vec<2>& c) { return norm(c - patch.from) <= tolerance; }) -
        corners.begin());
    if (loop != other_loop || begin == last)
      throw Error(fmt::format("{}: its ends are not two points of one outline", patch.name));
    const int whole = side[begin];
    const int number = static_cast<int>(region.sides_.size());
    region.sides_.push_back({patch.name, region.sides_[whole].is_round, false, whole});
    for (std::size_t i = begin; i != last; i = (i + 1) % n) {
      if (side[i] != whole || region.sides_[whole].part_of >= 0)
        throw Error(fmt::format("{}: it goes from {} on to {}, but must lie on one side", patch.name,
                                region.sides_[whole].name, region.sides_[side[i]].name));
      side[i] = number;
    }
    region.list_pieces();
  }
  return region;
}

/// Finds the corner of the outline at a point, or makes one there. Returns its loop and its number in the
/// loop. Throws Error where the point is not on the outline.
std::pair<std::size_t, std::size_t> Region::corner_at(const Patch& patch, const Vec<2>& point) {
  const double tolerance = kSame * size_of(box_);
  for (std::size_t l = 0; l < loops_.size(); ++l) {
    auto& [corners, side] = loops_[l];
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec<2>& next = corners[(i + 1) % corners.size()];
      if (norm(point - corners[i]) <= tolerance) return {l, i};
      if (norm(point - next) <= tolerance || distance_from_segment(point, corners[i], next) > tolerance)
        continue;
      if (sides_[side[i]].is_round) break;
      const auto at = static_cast<std::ptrdiff_t>(i) + 1;
      corners.insert(corners.begin() + at, point);
      side.insert(side.begin() + at, side[i]);
      return {l, i + 1};
    }
  }
  throw Error(
      fmt::format("{}: its end at ({:.6g}, {:.6g}) m is not on the outline", patch.name, point[0], point[1]));
}

void Region::list_pieces() {
  pieces_.clear();
  area_ = 0.0;
  for (const Loop& loop : loops_) {
    area_ += specimen::area(loop.corners);
    for (std::size_t i = 0; i < loop.corners.size(); ++i)
      pieces_.push_back({loop.corners[i], loop.corners[(i + 1) % loop.corners.size()], loop.side[i]});
  }
  box_ = box_of(loops_.front().corners);
  for (const Loop& loop : loops_) {
    const Box box = box_of(loop.corners);
    for (int i = 0; i < 2; ++i) {
      box_.low[i] = std::min(box_.low[i], box.low[i]);
      box_.high[i] = std::max(box_.high[i], box.high[i]);
    }
  }
}

LineSet Region::lines_at(const Vec<2>& point) const {
  const double tolerance = kSame * size_of(box_);
  LineSet lines;
  int number = 0;
  for (const Piece& piece : pieces_) {
    if (distance_from_segment(point, piece.from, piece.to) <= tolerance) lines.insert(number);
    ++number;
  }
  for (const Notch& notch : notches_) {
    if (notch.width == 0.0 && distance_from_segment(point, notch.mouth, notch.tip) <= tolerance)
      lines.insert(number);
    ++number;
  }
  for (const Notch& notch : notches_) {
    if (notch.width == 0.0 && norm(point - notch.tip) <= tolerance) lines.insert(number);
    ++number;
  }
  return lines;
}

std::optional<int> Region::side_of(const Vec<2>& from, const Vec<2>& to) const {
  const int line = shared_line(lines_at(from), lines_at(to), 0, static_cast<int>(pieces_.size()));
  return line < 0 ? std::nullopt : std::optional(pieces_[line].side);
}

std::optional<int> Region::slit_of(const Vec<2>& from, const Vec<2>& to) const {
  if (notches_.empty()) return std::nullopt;
  const int first = static_cast<int>(pieces_.size());
  const int line =
      shared_line(lines_at(from), lines_at(to), first, first + static_cast<int>(notches_.size()));
  return line < 0 ? std::nullopt : std::optional(line - first);
}

double Region::distance(const Vec<2>& point) const {
  return signed_distance(pieces_, point);
}

double Region::distance_before_cuts(const Vec<2>& point) const {
  return signed_distance(pieces_before_cuts(), point);
}

double distance_of_segments(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d) {
  if (cross_each_other(a, b, c, d)) return 0.0;
  return std::min({distance_from_segment(a, c, d), distance_from_segment(b, c, d),
                   distance_from_segment(c, a, b), distance_from_segment(d, a, b)});
}

}  // namespace pyroclast::specimen
