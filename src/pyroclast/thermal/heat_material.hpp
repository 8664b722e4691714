#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pyroclast/material/curve.hpp"

namespace pyroclast {

/// Conductivity and heat capacity of a material, as functions of the temperature.
struct HeatMaterial {
  Curve conductivity;   ///< gamma, W/(m K)
  Curve heat_capacity;  ///< rho c per volume of the undeformed body, J/(m³ K)
};

/// Grid of cells of 0.1 K whose knots lie at the multiples of 0.1 °C whatever the range, so that values
/// tabulated at the knots do not depend on how hot a run gets later; and the range of temperatures for now.
class TemperatureGrid {
 public:
  /// \param range  °C, from absolute zero on; its ends may be the same
  explicit TemperatureGrid(const Interval& range);

  /// Returns the temperature of a knot, °C. Cell i lies between the knots i and i + 1.
  static double knot(int i) { return i / cells_per_kelvin; }
  static constexpr double cells_per_kelvin = 10.0;
  static constexpr double width = 0.1;  ///< width of a cell, K

  /// Returns the cell in which a temperature of the range lies.
  int cell(double temperature) const;
  /// Returns the place in a cell, 0 at its lower knot, 1 at its upper one.
  static double fraction(double temperature, int cell) {
    return (temperature - knot(cell)) * cells_per_kelvin;
  }

  const Interval& range() const { return range_; }
  /// Returns the first cell into which the range reaches; `last_cell` returns the last.
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
/// The values at a knot follow from the material alone. The enthalpy is 0 at 20 °C, or at the last knot below
/// the end of the capacity's curve nearest to 20 °C, and is summed from there. A cell that reaches beyond the
/// end of a curve takes the value at that end.
class HeatTable {
 public:
  /// \param name     name of the material, for messages
  /// \param window   change of temperature, K, for which `greatest_conductivity` and `least_capacity` allow
  ///
  /// Throws Error naming the material and curve when a curve is not one of temperature, does not cover the
  /// range, or is not positive throughout.
  HeatTable(const HeatMaterial& material, const std::string& name, const TemperatureGrid& grid,
            double window);

  /// Extends the table to a wider range. Values at knots that are there keep their bits; the bounds are those
  /// of the new range. Throws Error as the constructor does.
  void extend(const TemperatureGrid& grid);

  double conductivity(double temperature) const;
  /// Returns the enthalpy at a knot, J/m³.
  /// \param knot  a knot of a cell of the range
  double enthalpy(int knot) const { return enthalpy_[static_cast<std::size_t>(knot - first_knot_)]; }

  /// Returns the greatest conductivity wherever the temperature may be in the range after changing by up to
  /// the window; `least_capacity` returns the least capacity.
  double greatest_conductivity(double temperature) const {
    return greatest_conductivity_[bucket(temperature)];
  }
  double least_capacity(double temperature) const { return least_capacity_[bucket(temperature)]; }
  /// Returns the greatest conductivity over the whole range; `least_capacity` returns the least capacity.
  double greatest_conductivity() const { return greatest_; }
  double least_capacity() const { return least_; }

 private:
  int bucket_number(double temperature) const;
  std::size_t bucket(double temperature) const;
  void find_bounds();

  HeatMaterial material_;
  std::string name_;
  TemperatureGrid grid_;
  double bucket_width_;                        ///< width of a bucket, K; buckets meet at its multiples
  int first_knot_;                             ///< first knot of the tables
  int first_bucket_ = 0;                       ///< first bucket into which the range reaches
  std::vector<double> conductivity_;           ///< conductivity at knots
  std::vector<double> enthalpy_;               ///< enthalpy at knots
  std::vector<double> greatest_conductivity_;  ///< bound over each bucket and its neighbours
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
  /// \param tables  tables by material; must outlive this object
  /// \param shares  shares of each node
  NodeEnthalpy(const TemperatureGrid& grid, const std::vector<HeatTable>& tables,
               const std::vector<std::vector<NodeShare>>& shares);

  /// Changes the range; the tables must have been extended to it.
  void set_grid(const TemperatureGrid& grid);

  double enthalpy(int node, double temperature) const;  ///< J
  /// Returns the inverse of `enthalpy`. An enthalpy beyond the range's ends gives the temperature of the end.
  /// \param near  temperature at which to look first, °C
  double temperature(int node, double enthalpy, double near) const;
  /// Returns how far an enthalpy lies beyond the range's ends, at the capacity there, K: negative below, 0
  /// within.
  double excess(int node, double enthalpy) const;

  double least_capacity(int node, double temperature) const;  ///< J/K, see HeatTable
  double least_capacity(int node) const;                      ///< J/K

 private:
  double at(int node, int knot) const;

  TemperatureGrid grid_;
  const std::vector<HeatTable>* tables_;
  std::vector<int> begin_;  ///< shares of node i: [i] to [i + 1]
  std::vector<NodeShare> shares_;
  std::vector<double> least_, most_;  ///< enthalpies of each node at the ends of the range, J
};

}  // namespace pyroclast
