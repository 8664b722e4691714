#pragma once

#include <vector>

#include "pyroclast/base/kept_sums.hpp"
#include "pyroclast/material/curve.hpp"
#include "pyroclast/thermal/thermal_mesh.hpp"

namespace pyroclast {

/// Prescribed temperatures and the nodes that they hold. Where several hold the gridpoints of a node, the
/// latest holds the node.
class Prescriptions {
 public:
  explicit Prescriptions(std::size_t gridpoints) : of_gridpoint_(gridpoints, -1) {}

  /// Prescribes a temperature (°C, over the time in s) to gridpoints, and so to nodes once they are set.
  /// Throws Error when the curve is not one of time.
  void add(const std::vector<int>& gridpoints, const Curve& temperature);
  /// Finds the prescription of each node: a collective.
  void set_nodes(const ThermalNodes& nodes, const ChunkList& chunks);

  /// Reads the temperatures at a time, s; they miss the range by rounding at most.
  void read(double time, const Interval& range);
  /// Throws Error naming the curve that is not defined from `begin` to `end`, s, or leaves the range there.
  void require_within(const Interval& range, double begin, double end) const;
  /// Returns the range of the temperatures of all held nodes between two times, s.
  Interval reach(double begin, double end) const;

  bool hold(int node) const { return of_node_[node] >= 0; }
  /// Returns the temperature of a held node, as read last, °C.
  double temperature(int node) const { return held_at_[of_node_[node]]; }
  /// Returns the held nodes, ascending.
  const std::vector<int>& nodes() const { return nodes_; }
  /// Sums a function of the held nodes, and keeps the sum.
  template <class Function>
  void keep_sum(KeptSums& sums, Function of_node) const {
    sums.keep(chunks_, [&](int i) { return of_node(nodes_[i]); });
  }

 private:
  std::vector<Curve> curves_;
  std::vector<double> held_at_;              ///< temperatures by curve, °C
  std::vector<int> of_gridpoint_, of_node_;  ///< index of the curve, -1: free
  std::vector<int> nodes_;
  std::vector<int> acting_;  ///< indices of the curves that hold a node, on any rank
  ChunkList chunks_;
};

}  // namespace pyroclast
