#pragma once

#include <string>
#include <vector>

#include "pyroclast/material/curve.hpp"

namespace pyroclast {

/// How a material conducts and stores heat, as functions of the temperature.
struct HeatMaterial {
  Curve conductivity;   ///< gamma, W/(m K)
  Curve heat_capacity;  ///< rho c per volume of the undeformed body, J/(m³ K)
};

/// Even cells that a run's temperature range is cut into; neighbouring cells meet at a knot.
struct TemperatureGrid {
  /// Cells no wider than 0.1 K, and at least a thousand.
  explicit TemperatureGrid(const Interval& range);

  double knot(int i) const { return i == cells ? range.upper : range.lower + i * width; }
  /// Cell in which a temperature of the range lies.
  int cell(double temperature) const;

  Interval range;  ///< °C
  int cells;
  double width;  ///< K
};

/// Conductivity and enthalpy of one material, tabulated so that each step reads them at a fixed small cost.
///
/// The enthalpy h(T), the integral of rho c from the lower end of the range, is exact at every knot and
/// linear between them. So h has an exact inverse, and no change of temperature, however large, can step over
/// a peak of rho c. The conductivity is linear between its values at the knots.
class HeatTable {
 public:
  /// \param name     of the material, for messages
  /// \param window   K; the change of temperature that `greatest_conductivity` and `least_capacity` allow for
  ///
  /// Throws Error naming the material and curve when a curve is not one of temperature, does not cover the
  /// range, or is not positive throughout.
  HeatTable(const HeatMaterial& material, const std::string& name, const TemperatureGrid& grid,
            double window);

  double conductivity(double temperature) const;
  double enthalpy(int knot) const { return enthalpy_[static_cast<std::size_t>(knot)]; }  ///< J/m³

  /// Bounds wherever the temperature may be after changing by up to the window.
  double greatest_conductivity(double temperature) const {
    return greatest_conductivity_[bucket(temperature)];
  }
  double least_capacity(double temperature) const { return least_capacity_[bucket(temperature)]; }
  /// Bounds over the whole range.
  double greatest_conductivity() const { return greatest_; }
  double least_capacity() const { return least_; }

 private:
  std::size_t bucket(double temperature) const;
  void find_bounds();

  TemperatureGrid grid_;
  double bucket_width_;
  std::vector<double> conductivity_;           ///< at knots
  std::vector<double> enthalpy_;               ///< at knots
  std::vector<double> greatest_conductivity_;  ///< over each bucket and its neighbours
  std::vector<double> least_capacity_;
  double greatest_ = 0.0, least_ = 0.0;
};

/// Share of a node that is of one material.
struct NodeShare {
  int material;
  double volume;  ///< m³
};

/// Enthalpy of thermal nodes, each of which may hold several materials, and its inverse.
class NodeEnthalpy {
 public:
  /// \param tables  by material; kept by reference
  /// \param shares  of each node
  NodeEnthalpy(const TemperatureGrid& grid, const std::vector<HeatTable>& tables,
               const std::vector<std::vector<NodeShare>>& shares);

  double enthalpy(int node, double temperature) const;  ///< J
  /// Inverse of `enthalpy`. An enthalpy beyond the range's ends gives the temperature of the end.
  /// \param near  where to look first, °C
  double temperature(int node, double enthalpy, double near) const;
  /// How far an enthalpy lies beyond the range's ends, at the capacity there, K: negative below, 0 within.
  double excess(int node, double enthalpy) const;

  double least_capacity(int node, double temperature) const;  ///< J/K, see HeatTable
  double least_capacity(int node) const;                      ///< J/K

 private:
  double at(int node, int knot) const;

  TemperatureGrid grid_;
  const std::vector<HeatTable>& tables_;
  std::vector<int> begin_;  ///< shares of node i: [i] to [i + 1]
  std::vector<NodeShare> shares_;
};

}  // namespace pyroclast
