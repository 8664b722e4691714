#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "pyroclast/base/vec.hpp"

namespace pyroclast::specimen {

/// Point of a surface.
template <int Dim>
struct SurfacePoint {
  Vec<Dim> at;      ///< m
  Vec<Dim> normal;  ///< outward unit normal
};

/// Point of a surface that is nearest to a place.
template <int Dim>
struct NearestPoint {
  SurfacePoint<Dim> point;
  double distance;  ///< distance of the place from the surface, m: negative within the shape
};

/// Shape of a stone around its own origin, turned and scaled as it lies.
template <int Dim>
class Surface {
 public:
  virtual ~Surface() = default;
  /// Returns the point of the surface that is nearest to a place; of several, one.
  virtual NearestPoint<Dim> nearest(const Vec<Dim>& place) const = 0;
  /// Returns the radius of a ball around the origin that holds the shape, m.
  virtual double bounding_radius() const = 0;
  /// Returns the radius of a ball around the origin within the shape, m; 0 where the origin lies outside.
  virtual double inner_radius() const = 0;
  virtual double extent() const = 0;  ///< Returns the area, m², or the volume, m³.
  virtual double size() const = 0;    ///< Returns the length of the outline, m, or the surface's area, m².
  /// Returns the number of true corners; 0: the surface is smooth.
  virtual int corner_count() const { return 0; }
  /// Distance of points at a place over `spacing`; empty: 1 everywhere.
  using Relative = std::function<double(const Vec<Dim>& place)>;
  /// Returns points of the surface, evenly and about `spacing` apart (m), or so many times as much. Together
  /// with points that are taken they go all around; there are three at least.
  virtual std::vector<SurfacePoint<Dim>> points(double spacing, std::span<const Vec<Dim>> taken = {},
                                                const Relative& relative = {}) const = 0;
  /// Returns the same shape, larger by a factor.
  virtual std::shared_ptr<const Surface> scaled(double factor) const = 0;
};

}  // namespace pyroclast::specimen
