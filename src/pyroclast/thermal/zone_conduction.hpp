#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pyroclast/base/team.hpp"
#include "pyroclast/thermal/heat_material.hpp"
#include "pyroclast/thermal/thermal_mesh.hpp"

namespace pyroclast {

/// Nodes or zones that a thread gets at least: for fewer the threads would take longer to meet.
inline constexpr int fewest_for_threads = 5000;

/// Conduction within zones (linear triangles or tetrahedra) between thermal nodes. Each zone conducts by its
/// conductivity at the mean temperature of its corners.
template <int Dim>
class ZoneConduction {
 public:
  /// \param table_of_material  index into the tables of each material of the model, -1 where none conducts
  /// \param tables             kept by reference
  /// \param team               shares zones and nodes; kept by reference
  ZoneConduction(const Model<Dim>& model, const ZoneGeometry<Dim>& geometry,
                 const std::vector<int>& table_of_material, const std::vector<HeatTable>& tables, Team& team);

  /// Says which node stands at each gridpoint; needed before all that follows.
  void set_nodes(const ThermalNodes& nodes);

  std::int64_t zone_count() const { return static_cast<std::int64_t>(zones_.size()); }

  /// Computes the heat flow to the corners of every zone, for `inflow`.
  void update(const std::vector<double>& temperature);
  /// Heat that flows into a node from its zones, W.
  double inflow(int node) const;

  /// Bound of the sum of |conductance| over a node's row of the assembled matrix, W/K, wherever the
  /// temperatures may be after changing by up to the tables' window.
  std::vector<double> row_bound(const std::vector<double>& temperature) const;
  /// The same over the whole temperature range.
  std::vector<double> row_bound() const;

  /// Volume that each node has of each material, as index of the tables: an equal share of every zone.
  std::vector<std::vector<NodeShare>> shares() const;

 private:
  struct Zone {
    std::array<int, Dim + 1> node;
    int table;
    double volume;                       ///< m³
    std::array<Vec<Dim>, Dim> gradient;  ///< of the first Dim shape functions, 1/m
  };

  double mean_temperature(const Zone& zone, const std::vector<double>& temperature) const;
  template <class Conductivity>
  std::vector<double> gather_rows(Conductivity conductivity) const;

  const std::vector<HeatTable>& tables_;
  Team& team_;
  int node_count_ = 0;
  std::vector<Zone> zones_;
  std::vector<std::array<int, Dim + 1>> gridpoints_;  ///< of each zone
  std::vector<std::array<double, Dim + 1>> row_;      ///< sums of |conductance| at unit conductivity, m
  std::vector<std::array<double, Dim + 1>> heat_;     ///< into each corner, W
  std::vector<int> begin_;                            ///< corners at node i: [i] to [i + 1]
  std::vector<std::array<int, 2>> corners_;           ///< zone and its corner
};

extern template class ZoneConduction<2>;
extern template class ZoneConduction<3>;

}  // namespace pyroclast
