#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pyroclast/material/curve.hpp"

namespace pyroclast {

/// How a material conducts and stores heat, as functions of the temperature.
struct HeatMaterial {
  Curve conductivity;   ///< gamma, W/(m K)
  Curve heat_capacity;  ///< rho c per volume of the undeformed body, J/(m³ K)
};

/// Cells of 0.1 K whose knots lie at the multiples of 0.1 °C whatever the range, so that what is tabulated at
/// them does not depend on how hot a run gets later; and the range that temperatures stay within for now.
class TemperatureGrid {
 public:
  /// \param range  °C, from absolute zero on; its ends may be the same
  explicit TemperatureGrid(const Interval& range);

  /// Temperature of a knot, °C. Cell i lies between the knots i and i + 1.
  static double knot(int i) { return i / cells_per_kelvin; }
  static constexpr double cells_per_kelvin = 10.0;
  static constexpr double width = 0.1;  ///< of a cell, K

  /// Cell in which a temperature of the range lies.
  int cell(double temperature) const;
  /// Place in a cell, 0 at its lower knot, 1 at its upper one.
  static double fraction(double temperature, int cell) {
    return (temperature - knot(cell)) * cells_per_kelvin;
  }

  const Interval& range() const { return range_; }
  /// First and last cell that the range reaches into.
  int first_cell() const { return first_cell_; }
  int last_cell() const { return last_cell_; }

 private:
  Interval range_;
  int first_cell_, last_cell_;
};

/// Conductivity and enthalpy of one material, tabulated so that each step reads them at a fixed small cost.
///
/// The enthalpy h(T) is the integral of rho c, exact at every knot and linear between them. So h has an exact
/// inverse, and no change of temperature, however large, can step over a peak of rho c. The conductivity is
/// linear between its values at the knots.
///
/// What stands at a knot follows from the material alone. The enthalpy is 0 at 20 °C, or at the last knot
/// below the end of the capacity's curve nearest to it, and is summed from there. A cell that reaches beyond
/// the end of a curve takes the value at that end.
class HeatTable {
 public:
  /// \param name     of the material, for messages
  /// \param window   K; the change of temperature that `greatest_conductivity` and `least_capacity` allow for
  ///
  /// Throws Error naming the material and curve when a curve is not one of temperature, does not cover the
  /// range, or is not positive throughout.
  HeatTable(const HeatMaterial& material, const std::string& name, const TemperatureGrid& grid,
            double window);

  /// Extends the table to a wider range. What stands at a knot already keeps its bits; the bounds are of the
  /// new range. Throws Error as the constructor does.
  void extend(const TemperatureGrid& grid);

  double conductivity(double temperature) const;
  /// J/m³. \param knot  of a cell of the range
  double enthalpy(int knot) const { return enthalpy_[static_cast<std::size_t>(knot - first_knot_)]; }

  /// Bounds wherever the temperature may be in the range after changing by up to the window.
  double greatest_conductivity(double temperature) const {
    return greatest_conductivity_[bucket(temperature)];
  }
  double least_capacity(double temperature) const { return least_capacity_[bucket(temperature)]; }
  /// Bounds over the whole range.
  double greatest_conductivity() const { return greatest_; }
  double least_capacity() const { return least_; }

 private:
  int bucket_number(double temperature) const;
  std::size_t bucket(double temperature) const;
  void find_bounds();

  HeatMaterial material_;
  std::string name_;
  TemperatureGrid grid_;
  double bucket_width_;                        ///< K; buckets meet at its multiples
  int first_knot_;                             ///< of those tabulated
  int first_bucket_ = 0;                       ///< of those that the range reaches into
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
  /// \param tables  by material; must outlive this
  /// \param shares  of each node
  NodeEnthalpy(const TemperatureGrid& grid, const std::vector<HeatTable>& tables,
               const std::vector<std::vector<NodeShare>>& shares);

  /// Changes the range; the tables must have been extended to it.
  void set_grid(const TemperatureGrid& grid);

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
  const std::vector<HeatTable>* tables_;
  std::vector<int> begin_;  ///< shares of node i: [i] to [i + 1]
  std::vector<NodeShare> shares_;
  std::vector<double> least_, most_;  ///< of each node, at the ends of the range, J
};

}  // namespace pyroclast
