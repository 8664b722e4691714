#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/specimen.hpp"
#include "pyroclast/specimen/surface.hpp"

namespace pyroclast::specimen {

/// Closed surface of triangles in space around its centroid: an ellipsoid, a polyhedron, a stone of harmonics
/// or of an image. As in an Outline of the plane, triangles that meet at a small angle stand for a curved
/// surface; where the angle is larger, there is an edge, and the surface falls into sides.
class Shell final : public Surface<3> {
 public:
  using Triangle = std::array<int, 3>;

  /// Makes a surface; moves it so that the centroid of its volume is the origin. Throws Error unless each
  /// edge of a triangle is walked once the other way by another one, and the surface holds a volume.
  /// \param vertices   m
  /// \param triangles  vertices of each, counter-clockwise seen from outside
  /// \param is_smooth  true where triangles stand for a curved surface up to an angle of 60 degrees, not 30
  Shell(std::vector<Vec<3>> vertices, std::vector<Triangle> triangles, bool is_smooth = false);

  NearestPoint<3> nearest(const Vec<3>& place) const override;
  double bounding_radius() const override;
  double inner_radius() const override;
  double extent() const override;
  double size() const override;
  /// Returns the number of sides that edges part; 0: the surface is smooth.
  int corner_count() const override;
  /// Returns points that are spread evenly over each side: the farthest one from all others in turn, then
  /// moved to the middles of their parts. A small side gives way where points of larger ones are near.
  std::vector<SurfacePoint<3>> points(double spacing, std::span<const Vec<3>> taken = {},
                                      const Relative& relative = {}) const override;
  /// Returns the same shape, larger by a factor; shares the triangles.
  std::shared_ptr<const Surface<3>> scaled(double factor) const override;

  /// Returns the vertices, m: they lie densely enough to stand for the surface where shells meet.
  std::vector<Vec<3>> vertices() const;
  const std::vector<Triangle>& triangles() const;
  /// Tells whether a vertex lies closer to another shell than `gap` (m), or in it.
  /// \param from  place of the origin, seen from that of the other shell, m
  bool has_vertex_closer(const Shell& other, const Vec<3>& from, double gap) const;
  /// Returns the nearest approach of a vertex to another shell, with the point of that one: negative within.
  NearestPoint<3> approach_of_vertices(const Shell& other, const Vec<3>& from) const;
  /// Returns the largest extent across an axis, m: of a stone as long as wide across its length the hole of a
  /// sieve that it passes.
  double width_across(const Vec<3>& axis) const;
  /// Returns the same across the line from the centroid to the farthest vertex, m.
  double width() const;
  bool is_smooth() const;  ///< Tells whether triangles stand for a curved surface up to 60 degrees.
  /// Returns the place of the centroid among the vertices as they were given, m.
  const Vec<3>& given_centre() const;

 private:
  struct Mesh;
  bool has_vertex_closer(int box, const Shell& other, const Vec<3>& from, double gap) const;
  void find_approach(int box, const Shell& other, const Vec<3>& from, NearestPoint<3>& least) const;
  Shell(std::shared_ptr<const Mesh> mesh, double factor) : mesh_(std::move(mesh)), factor_(factor) {}

  std::shared_ptr<const Mesh> mesh_;
  double factor_ = 1.0;
};

/// Returns points that are spread over a ball around the origin by Fibonacci's spiral.
std::vector<Vec<3>> points_of_ball(int count, double radius);

/// Returns the shell of a ball, m.
Shell ball_of_shell(double radius);

/// Draws the shape of a stone in space whose width is 1, turned at random. A ball draws nothing and returns
/// none.
std::shared_ptr<const Shell> draw_shell(const ShapeParameters& parameters, Random& random);

}  // namespace pyroclast::specimen
