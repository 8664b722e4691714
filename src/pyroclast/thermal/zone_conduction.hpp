#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pyroclast/base/team.hpp"
#include "pyroclast/thermal/heat_material.hpp"
#include "pyroclast/thermal/thermal_mesh.hpp"

namespace pyroclast {

/// Least nodes or zones of a thread: with fewer the threads would take longer to meet.
inline constexpr int fewest_for_threads = 5000;

/// Makes a maximum that threads share at least as large as a value.
inline void raise(std::atomic<double>& maximum, double value) {
  double present = maximum;
  while (present < value && !maximum.compare_exchange_weak(present, value)) {
  }
}

/// Conduction within zones (linear triangles or tetrahedra) between thermal nodes. Each zone conducts by its
/// conductivity at the mean temperature of its corners.
template <int Dim>
class ZoneConduction {
 public:
  /// \param tables  kept by reference
  /// \param team    team that shares zones and nodes; kept by reference
  ZoneConduction(const std::vector<HeatTable>& tables, Team& team) : tables_(tables), team_(team) {}

  /// Sets the zones; needed before all other calls.
  /// \param table_of_block  index into the tables of each block, -1 where it conducts no heat
  void set_blocks(const ModelOf<Dim>& model, const ZoneGeometry<Dim>& geometry,
                  const std::vector<int>& table_of_block);

  /// Sets the node at each gridpoint; needed before all other calls.
  void set_nodes(const ThermalNodes& nodes);

  std::int64_t zone_count() const { return static_cast<std::int64_t>(zones_.size()); }

  /// Computes the heat flow to the corners of every zone, for `inflow`.
  void update(const std::vector<double>& temperature);
  /// Returns the heat that flows into a node from its zones, W.
  double inflow(int node) const;

  /// Computes the same flows in two parts: flows from hot to cold, for `inflow`, and flows from cold to hot
  /// in zones with obtuse angles, for `uphill` and `add_uphill`.
  void update_apart(const std::vector<double>& temperature);
  /// Heat from cold to hot, W, that would flow into a node, and out of it.
  struct Uphill {
    double in = 0.0, out = 0.0;
  };
  Uphill uphill(int node) const;
  /// Adds the flows from cold to hot to the others, each by the smaller of the shares that the hot node may
  /// take in and that the cold node may give. Returns the greatest speed by which the flows left out would
  /// have changed a node's temperature, K/s.
  /// \param shares    shares of each node, of its flows in and of its flows out, from 0 to 1
  /// \param capacity  capacity of a node, J/K
  template <class Capacity>
  double add_uphill(const std::vector<Uphill>& shares, Capacity capacity);

  /// Returns the least and greatest temperature of the nodes with which a node shares a zone, without its
  /// own.
  Interval around(int node, const std::vector<double>& temperature) const;

  /// Returns a bound of the sum of |conductance| over a node's row of the assembled matrix, W/K, wherever the
  /// temperatures may be after changing by up to the tables' window.
  std::vector<double> row_bound(const std::vector<double>& temperature) const;
  /// Returns the same bound over the whole temperature range.
  std::vector<double> row_bound() const;

  /// Returns the volume that each node has of each material, as index of the tables: an equal share of every
  /// zone.
  std::vector<std::vector<NodeShare>> shares() const;

 private:
  static constexpr int kPairs = Dim * (Dim + 1) / 2;  ///< pairs of corners of a zone

  struct Zone {
    std::array<int, Dim + 1> node;
    int table;
    double volume;                       ///< m³
    std::array<Vec<Dim>, Dim> gradient;  ///< gradients of the first Dim shape functions, 1/m
  };

  template <class Visit>
  static constexpr void for_each_pair(Visit visit);
  /// Pair of a zone's corners, seen from one of them: 1 from the first corner, -1 from the second.
  struct SeenPair {
    int pair;
    double sign;
  };
  using PairsOfCorners = std::array<std::array<SeenPair, Dim>, Dim + 1>;
  static constexpr PairsOfCorners pairs_of_corners();
  static const PairsOfCorners kPairsOf;  ///< pairs of each corner
  /// Returns the gradients of all shape functions, 1/m.
  static std::array<Vec<Dim>, Dim + 1> gradients(const Zone& zone);
  double mean_temperature(const Zone& zone, const std::vector<double>& temperature) const;
  void list_neighbours();
  template <class Conductivity>
  std::vector<double> gather_rows(Conductivity conductivity) const;

  const std::vector<HeatTable>& tables_;
  Team& team_;
  int node_count_ = 0;
  std::vector<Zone> zones_;
  int own_begin_ = 0, own_end_ = 0;  ///< zones of own chunks; nodes of others may lack zones here
  std::vector<std::array<int, Dim + 1>> gridpoints_;  ///< gridpoints of each zone
  std::vector<std::array<double, Dim + 1>> row_;      ///< sums of |conductance| at unit conductivity, m
  std::vector<std::array<double, Dim + 1>> heat_;     ///< heat into each corner, W
  std::vector<std::array<double, kPairs>> uphill_;    ///< heat into the first corner of each pair, W
  std::vector<int> begin_;                            ///< corners at node i: [i] to [i + 1]
  std::vector<std::array<int, 2>> corners_;           ///< zone and corner
  std::vector<int> neighbours_begin_;                 ///< neighbours of node i: [i] to [i + 1]
  std::vector<int> neighbours_;                       ///< nodes with which a node shares a zone
};

template <int Dim>
template <class Visit>
constexpr void ZoneConduction<Dim>::for_each_pair(Visit visit) {
  int pair = 0;
  for (int i = 0; i < Dim; ++i)
    for (int j = i + 1; j <= Dim; ++j) visit(pair++, i, j);
}

template <int Dim>
constexpr typename ZoneConduction<Dim>::PairsOfCorners ZoneConduction<Dim>::pairs_of_corners() {
  PairsOfCorners pairs{};
  std::array<std::size_t, Dim + 1> next{};
  for_each_pair([&](int pair, int i, int j) {
    pairs[i][next[i]++] = {pair, 1.0};
    pairs[j][next[j]++] = {pair, -1.0};
  });
  return pairs;
}

template <int Dim>
constexpr typename ZoneConduction<Dim>::PairsOfCorners ZoneConduction<Dim>::kPairsOf = pairs_of_corners();

template <int Dim>
template <class Capacity>
double ZoneConduction<Dim>::add_uphill(const std::vector<Uphill>& shares, Capacity capacity) {
  std::atomic<double> fastest{0.0};
  team_.share(zone_count(), fewest_for_threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    double most = 0.0;
    for (auto z = begin; z < end; ++z) {
      for_each_pair([&](int pair, int i, int j) {
        const double flow = uphill_[z][pair];
        if (flow == 0.0) return;
        const int a = zones_[z].node[i], b = zones_[z].node[j];
        const double share =
            flow > 0.0 ? std::min(shares[a].in, shares[b].out) : std::min(shares[a].out, shares[b].in);
        heat_[z][i] += share * flow;
        heat_[z][j] -= share * flow;
        if (share < 1.0 && z >= own_begin_ && z < own_end_)
          most = std::max(most, (1.0 - share) * std::abs(flow) / std::min(capacity(a), capacity(b)));
      });
    }
    raise(fastest, most);
  });
  return fastest;
}

extern template class ZoneConduction<2>;
extern template class ZoneConduction<3>;

}  // namespace pyroclast
