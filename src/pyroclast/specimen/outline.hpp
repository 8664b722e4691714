#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/specimen.hpp"
#include "pyroclast/specimen/surface.hpp"

namespace pyroclast::specimen {

/// Circle or ball around the origin.
template <int Dim>
class Ball final : public Surface<Dim> {
 public:
  explicit Ball(double radius) : radius_(radius) {}

  NearestPoint<Dim> nearest(const Vec<Dim>& place) const override;
  double bounding_radius() const override { return radius_; }
  double inner_radius() const override { return radius_; }
  double extent() const override;
  double size() const override;
  std::vector<SurfacePoint<Dim>> points(double spacing, std::span<const Vec<Dim>> taken = {},
                                        const typename Surface<Dim>::Relative& relative = {}) const override;
  std::shared_ptr<const Surface<Dim>> scaled(double factor) const override;

 private:
  double radius_;
};

template <>
std::vector<SurfacePoint<2>> Ball<2>::points(double, std::span<const Vec<2>>, const Relative&) const;
template <>
std::vector<SurfacePoint<3>> Ball<3>::points(double, std::span<const Vec<3>>, const Relative&) const;

/// Closed line in the plane as straight pieces, without crossings, around its centroid: an ellipse, a
/// polygon, a stone of harmonics or of an image. Pieces that meet at a small angle stand for a curve; at a
/// larger one they have a corner.
class Outline final : public Surface<2> {
 public:
  /// Makes an outline; moves it so that its centroid is the origin. Throws Error where it has fewer than
  /// three corners, two of them at one place in turn, crosses itself, runs around more than once, or has no
  /// area.
  /// \param corners  corners in either sense, m
  explicit Outline(std::vector<Vec<2>> corners);

  NearestPoint<2> nearest(const Vec<2>& place) const override;
  double bounding_radius() const override { return bounding_radius_; }
  double inner_radius() const override { return inner_radius_; }
  double extent() const override { return area_; }
  double size() const override { return starts_.back(); }
  std::vector<SurfacePoint<2>> points(double spacing, std::span<const Vec<2>> taken = {},
                                      const Relative& relative = {}) const override;
  std::shared_ptr<const Surface<2>> scaled(double factor) const override;
  int corner_count() const override { return static_cast<int>(corners_along_.size()); }

  /// Returns the corners, counter-clockwise, m.
  const std::vector<Vec<2>>& corners() const { return corners_; }
  /// Returns a place well within, m: the origin, or the middle of a chord where the outline bends around it.
  const Vec<2>& place_within() const { return place_within_; }
  /// Returns the least distance between two parallel lines that hold the outline, m: the sieve that it
  /// passes.
  double width() const;

 private:
  std::size_t next(std::size_t i) const { return i + 1 == corners_.size() ? 0 : i + 1; }
  /// Place of the line, and the square of its distance from the point that it belongs to, m².
  struct Foot {
    std::size_t piece;
    double share, square;
    Vec<2> at;  ///< m
  };
  Foot foot_of(const Vec<2>& point) const;
  Vec<2> normal_of(std::size_t piece) const;
  SurfacePoint<2> at(double along) const;
  double along_of(const Vec<2>& point) const;
  Vec<2> middle_of_chord() const;

  std::vector<Vec<2>> corners_;
  std::vector<double> starts_;         ///< length of the line up to each corner, then up to its end, m
  std::vector<double> corners_along_;  ///< places of true corners on the line, m
  double area_ = 0.0, bounding_radius_ = 0.0, inner_radius_ = 0.0;
  Vec<2> place_within_{};
};

/// Returns the first corner that lies where the one before lies, but for rounding; none where there is none.
std::optional<std::size_t> repeated_corner(std::span<const Vec<2>> corners);

/// Returns the outline around its centroid of points that lie anywhere, and the centroid, m. The last point
/// may repeat the first.
std::pair<std::shared_ptr<const Outline>, Vec<2>> outline_around(std::vector<Vec<2>> points);

/// Draws the outline of a stone whose width is 1. A circle draws nothing and returns none.
std::shared_ptr<const Outline> draw_outline(const ShapeParameters& parameters, Random& random);

}  // namespace pyroclast::specimen
