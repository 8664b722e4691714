#include "pyroclast/thermal/zone_conduction.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "pyroclast/base/sort_unique.hpp"

namespace pyroclast {

template <int Dim>
void ZoneConduction<Dim>::set_blocks(const ModelOf<Dim>& model, const ZoneGeometry<Dim>& geometry,
                                     const std::vector<int>& table_of_block) {
  zones_.clear();
  gridpoints_.clear();
  row_.clear();
  const auto [first_own, last_own] = model.chunks().own();
  for (int b = 0; b < model.block_count(); ++b) {
    if (b == first_own) own_begin_ = zone_count();
    if (b == last_own) own_end_ = zone_count();
    const int table = table_of_block[b];
    if (table < 0) continue;
    for (int z = model.block_zones[b]; z < model.block_zones[b + 1]; ++z) {
      Zone zone{{}, table, geometry.volume[z], geometry.gradient[z]};
      const auto gradient = gradients(zone);
      std::array<double, Dim + 1> row{};
      for (int i = 0; i <= Dim; ++i)
        for (int j = 0; j <= Dim; ++j) row[i] += std::abs(dot(gradient[i], gradient[j])) * zone.volume;
      zones_.push_back(zone);
      gridpoints_.push_back(model.zones[z]);
      row_.push_back(row);
    }
  }
  if (last_own == model.block_count()) own_end_ = zone_count();
  heat_.resize(zones_.size());
  uphill_.resize(zones_.size());
}

template <int Dim>
std::array<Vec<Dim>, Dim + 1> ZoneConduction<Dim>::gradients(const Zone& zone) {
  std::array<Vec<Dim>, Dim + 1> gradient{};
  for (int i = 0; i < Dim; ++i) {
    gradient[i] = zone.gradient[i];
    gradient[Dim] -= zone.gradient[i];
  }
  return gradient;
}

template <int Dim>
void ZoneConduction<Dim>::set_nodes(const ThermalNodes& nodes) {
  node_count_ = nodes.count();
  begin_.assign(static_cast<std::size_t>(node_count_) + 1, 0);
  for (std::size_t z = 0; z < zones_.size(); ++z)
    for (int i = 0; i <= Dim; ++i) {
      zones_[z].node[i] = nodes.of_gridpoint[gridpoints_[z][i]];
      ++begin_[zones_[z].node[i] + 1];
    }
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  corners_.resize(static_cast<std::size_t>(begin_.back()));
  auto next = begin_;
  for (std::size_t z = 0; z < zones_.size(); ++z)
    for (int i = 0; i <= Dim; ++i) corners_[next[zones_[z].node[i]]++] = {static_cast<int>(z), i};
  list_neighbours();
}

template <int Dim>
void ZoneConduction<Dim>::list_neighbours() {
  neighbours_.clear();
  neighbours_begin_.assign(1, 0);
  std::vector<int> its;
  for (int node = 0; node < node_count_; ++node) {
    its.clear();
    for (int c = begin_[node]; c < begin_[node + 1]; ++c)
      for (const int other : zones_[corners_[c][0]].node)
        if (other != node) its.push_back(other);
    sort_unique(its);
    neighbours_.insert(neighbours_.end(), its.begin(), its.end());
    neighbours_begin_.push_back(static_cast<int>(neighbours_.size()));
  }
}

template <int Dim>
double ZoneConduction<Dim>::mean_temperature(const Zone& zone, const std::vector<double>& temperature) const {
  double sum = 0.0;
  for (int node : zone.node) sum += temperature[node];
  return sum / (Dim + 1);
}

/// Computes the flux gamma grad T of Eq. (1), weighted by the gradients of the shape functions.
template <int Dim>
void ZoneConduction<Dim>::update(const std::vector<double>& temperature) {
  team_.share(zone_count(), fewest_for_threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto z = begin; z < end; ++z) {
      const Zone& zone = zones_[z];
      const double last = temperature[zone.node[Dim]];
      Vec<Dim> gradient{};
      for (int i = 0; i < Dim; ++i) gradient += zone.gradient[i] * (temperature[zone.node[i]] - last);
      const double conductivity = tables_[zone.table].conductivity(mean_temperature(zone, temperature));
      const Vec<Dim> flow = gradient * (conductivity * zone.volume);
      double others = 0.0;
      for (int i = 0; i < Dim; ++i) {
        heat_[z][i] = -dot(zone.gradient[i], flow);
        others += heat_[z][i];
      }
      heat_[z][Dim] = -others;
    }
  });
}

template <int Dim>
void ZoneConduction<Dim>::update_apart(const std::vector<double>& temperature) {
  team_.share(zone_count(), fewest_for_threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto z = begin; z < end; ++z) {
      const Zone& zone = zones_[z];
      const auto gradient = gradients(zone);
      const double conductivity = tables_[zone.table].conductivity(mean_temperature(zone, temperature));
      heat_[z] = {};
      for_each_pair([&](int pair, int i, int j) {
        const double conductance = -dot(gradient[i], gradient[j]) * (conductivity * zone.volume);
        const double flow = conductance * (temperature[zone.node[j]] - temperature[zone.node[i]]);
        uphill_[z][pair] = conductance < 0.0 ? flow : 0.0;
        if (conductance < 0.0) return;
        heat_[z][i] += flow;
        heat_[z][j] -= flow;
      });
    }
  });
}

template <int Dim>
typename ZoneConduction<Dim>::Uphill ZoneConduction<Dim>::uphill(int node) const {
  Uphill sum;
  for (int c = begin_[node]; c < begin_[node + 1]; ++c) {
    const auto [zone, corner] = corners_[c];
    const auto& flows = uphill_[zone];
    for (const auto [pair, sign] : kPairsOf[corner]) {
      const double in = sign * flows[pair];
      sum.in += std::max(in, 0.0);
      sum.out += std::max(-in, 0.0);
    }
  }
  return sum;
}

template <int Dim>
Interval ZoneConduction<Dim>::around(int node, const std::vector<double>& temperature) const {
  Interval range = nothing();
  for (int i = neighbours_begin_[node]; i < neighbours_begin_[node + 1]; ++i)
    include(range, temperature[neighbours_[i]]);
  return range;
}

template <int Dim>
double ZoneConduction<Dim>::inflow(int node) const {
  double sum = 0.0;
  for (int i = begin_[node]; i < begin_[node + 1]; ++i) sum += heat_[corners_[i][0]][corners_[i][1]];
  return sum;
}

template <int Dim>
template <class Conductivity>
std::vector<double> ZoneConduction<Dim>::gather_rows(Conductivity conductivity) const {
  std::vector<double> rows(static_cast<std::size_t>(node_count_));
  team_.share(node_count_, fewest_for_threads, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto node = begin; node < end; ++node)
      for (int i = begin_[node]; i < begin_[node + 1]; ++i) {
        const auto [zone, corner] = corners_[i];
        rows[node] += row_[zone][corner] * conductivity(zones_[zone]);
      }
  });
  return rows;
}

template <int Dim>
std::vector<double> ZoneConduction<Dim>::row_bound(const std::vector<double>& temperature) const {
  return gather_rows([&](const Zone& zone) {
    return tables_[zone.table].greatest_conductivity(mean_temperature(zone, temperature));
  });
}

template <int Dim>
std::vector<double> ZoneConduction<Dim>::row_bound() const {
  return gather_rows([&](const Zone& zone) { return tables_[zone.table].greatest_conductivity(); });
}

template <int Dim>
std::vector<std::vector<NodeShare>> ZoneConduction<Dim>::shares() const {
  std::vector<std::vector<NodeShare>> shares(static_cast<std::size_t>(node_count_));
  for (const auto& zone : zones_)
    for (int node : zone.node) {
      auto& of_node = shares[node];
      auto share = std::find_if(of_node.begin(), of_node.end(),
                                [&](const NodeShare& s) { return s.material == zone.table; });
      if (share == of_node.end()) share = of_node.insert(share, {zone.table, 0.0});
      share->volume += zone.volume / (Dim + 1);
    }
  return shares;
}

template class ZoneConduction<2>;
template class ZoneConduction<3>;

}  // namespace pyroclast
