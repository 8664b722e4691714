#pragma once

#include <span>
#include <vector>

#include "pyroclast/base/kept_sums.hpp"
#include "pyroclast/thermal/boundary_condition.hpp"

namespace pyroclast {

/// Heat by the way in which it comes in, W or J.
struct HeatByKind {
  double flux = 0.0;
  double convection = 0.0;
  double radiation = 0.0;

  double total() const { return flux + convection + radiation; }
  void add(double weight, const HeatByKind& other) {
    flux += weight * other.flux;
    convection += weight * other.convection;
    radiation += weight * other.radiation;
  }
  bool operator==(const HeatByKind&) const = default;
};

/// Part of the outline that belongs to a node.
struct BoundaryPatch {
  int node;
  double area;  ///< m²
};

/// Boundary conditions of a body. Their integrals over the faces use the values at the nodes (trapezoidal
/// rule: second order, and exact for a given flux).
class HeatBoundary {
 public:
  /// Adds a condition.
  /// \param patches  ascending by node
  /// \param nodes    chunks of all nodes
  ///
  /// Throws Error naming the quantity when its curve is not one of time, a coefficient is negative, or an
  /// emissivity not between 0 and 1.
  void add(const BoundaryCondition& condition, std::vector<BoundaryPatch> patches, const ChunkList& nodes);
  /// Takes all conditions away.
  void clear() { entries_.clear(); }

  /// Throws Error naming the curve that is not defined from `begin` to `end`, s.
  void require_defined(double begin, double end) const;

  /// Returns the range of temperatures to which the conditions can draw between two times, s: those of gases,
  /// and an infinite end where a given flux flows in or out.
  Interval reach(double begin, double end) const;
  /// Widens the range of each boundary node by the reach of its conditions at one time.
  void add_reach(double time, std::vector<Interval>& ranges) const;

  std::size_t count() const { return entries_.size(); }
  /// Writes the heat that flows into each boundary node, W; leaves the other entries as they are.
  /// \param sums  keeps the inflow by each condition, W
  void inflow(double time, const std::vector<double>& temperature, std::vector<double>& heat,
              KeptSums& sums) const;
  /// Sums inflows by kind.
  /// \param of_conditions  inflow by each condition, W
  HeatByKind by_kind(std::span<const double> of_conditions) const;

  /// Adds to each boundary node a bound of how fast its outflow grows with its temperature, W/K, between two
  /// times, s.
  /// \param hottest  bound of each node's temperature, °C
  /// \param weight   factor of the bound
  void add_slope(double begin, double end, const std::vector<double>& hottest, double weight,
                 std::vector<double>& slope) const;

 private:
  struct Entry {
    BoundaryCondition condition;
    std::vector<BoundaryPatch> patches;
    ChunkList chunks;  ///< chunks of the patches
  };
  std::vector<Entry> entries_;
};

/// Throws Error naming the quantity when a curve is not one of time.
void require_curve_of_time(const Curve& curve, const char* quantity);
/// Throws Error naming the quantity when a curve is not defined from `begin` to `end`, s.
void require_defined(const Curve& curve, const char* quantity, double begin, double end);

}  // namespace pyroclast
