#pragma once

#include <cstdint>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/base/team.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/thermal/gap_heat.hpp"
#include "pyroclast/thermal/heat_material.hpp"
#include "pyroclast/thermal/thermal_mesh.hpp"

namespace pyroclast {

/// Conduction through contacts with a resistance. Gridpoints share a node as long as contacts that conduct
/// well join them; between nodes heat flows through the contacts that conduct badly. At the tip of a crack
/// both faces meet in one node, for intact contacts lead around the tip.
template <int Dim>
class GapConduction {
 public:
  /// \param model     model, kept by reference, as is the team
  /// \param conducts  true where a block takes part; contacts with another block, such as a bearing's, are
  ///                  closed to heat
  ///
  /// Throws Error naming the number of `law` that is out of range, and as set_grid does.
  GapConduction(const ModelOf<Dim>& model, const std::vector<bool>& conducts, const GapHeat& law,
                const TemperatureGrid& grid, Team& team);

  const GapHeat& law() const { return law_; }
  /// Closes the contacts of blocks that take part no more.
  void set_blocks(const std::vector<bool>& conducts);
  /// Changes the range of temperatures. Throws Error when the conductivity of the gas is not known or not
  /// positive somewhere in the range.
  void set_grid(const TemperatureGrid& grid);

  /// Sets the gap of each contact. Returns whether contacts came to part or to join their sides.
  /// \param temperature  temperature of each gridpoint, °C
  ///
  /// Throws Error when the numbers of gaps and contacts differ, for a damage not between 0 and 1, and for a
  /// negative opening.
  bool set_gaps(std::vector<ContactGap> gaps, const std::vector<double>& temperature);
  /// Tells of each contact whether it parts its sides.
  const std::vector<std::uint8_t>& parts() const { return parts_; }
  /// Lists the contacts that lie between two nodes.
  void set_nodes(const ThermalNodes& nodes);

  /// Computes the heat flow through every contact between two nodes, for `inflow`.
  void update(const std::vector<double>& temperature);
  /// Returns the heat that flows into a node from others through contacts, W.
  double inflow(int node) const;

  /// Widens a range by the temperatures from which heat flows into a node through contacts.
  void add_around(int node, const std::vector<double>& temperature, Interval& range) const;

  /// Adds to each node a bound of the sum of |conductance| over its row of the assembled matrix, W/K.
  /// \param temperatures  bounds of all temperatures, °C
  /// \param hottest       bound of each node's temperature, °C
  void add_row_bound(const Interval& temperatures, const std::vector<double>& hottest,
                     std::vector<double>& rows) const;

  /// Returns the conductance of each contact, W/(m² K), at temperatures of the gridpoints, °C; 0 where the
  /// contact is closed to heat.
  std::vector<double> conductances(const std::vector<double>& temperature) const;
  /// Returns the area of the contacts between two nodes, m².
  double area() const;

  void visit_state(StateVisitor& visitor);

 private:
  struct Crossing {
    int contact;
    int a, b;  ///< nodes
  };

  double gas(double temperature) const;
  double greatest_gas(double coldest, double hottest) const;
  double conductance(int contact, double a, double b) const {
    return law_.conductance(gaps_[contact], gas(0.5 * (a + b)), a, b);
  }

  const ModelOf<Dim>& model_;
  GapHeat law_;
  TemperatureGrid grid_;
  std::vector<double> gas_;  ///< conductivity at the knots of the range, W/(m K); linear between them
  Team& team_;
  std::vector<bool> open_to_heat_;   ///< true for a contact whose two sides conduct
  std::vector<ContactGap> gaps_;     ///< gap of each contact
  std::vector<std::uint8_t> parts_;  ///< true for a contact that parts its sides
  std::vector<Crossing> crossings_;  ///< contacts between two nodes, in the order of the contacts
  ContactsByChunk by_chunk_;         ///< contacts of the body
  ContactsByChunk crossing_;         ///< contacts of the crossings
  std::vector<double> heat_;         ///< heat flow of each crossing, from a to b, W
  std::vector<int> begin_;           ///< crossings at node i: [i] to [i + 1]
  std::vector<int> sides_;           ///< twice the crossing's index, plus one on side b
};

extern template class GapConduction<2>;
extern template class GapConduction<3>;

}  // namespace pyroclast
