#pragma once

#include <array>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "pyroclast/mechanics/body.hpp"
#include "pyroclast/mechanics/found/edge_pair.hpp"
#include "pyroclast/mechanics/found/found.hpp"

namespace pyroclast {

/// Pair of facets at some places of its corners.
template <int Dim>
struct PairShape {
  /// Numbers of both facets, see EdgePair and TrianglePair; in space none where there is no point.
  std::conditional_t<Dim == 2, EdgePair<double>, TrianglePair<double>> p;
  int points = 0;  ///< number of points; 0 where the facets do not face each other or do not overlap
};

/// Facts about a pair of facets, whether it is listed or not: where it lies and how far it is from pressing,
/// and which law and parameters it has. Changes nothing.
template <int Dim>
class PairFacts {
 public:
  /// Places of the corners of a pair: those of a, then of b, m.
  using Corners = std::array<Vec<Dim>, 2 * Dim>;
  /// Bound of a change of gaps, overlaps and cosines over the reach, while gridpoints go that far.
  static constexpr double kMargin = 5.0;

  explicit PairFacts(const Body<Dim>& body) : body_(body), found_(*body.found) {}

  /// \param displacement  by slot, m
  Corners places(const PairKey& key, const FlatArray<Vec<Dim>>& displacement) const;
  /// Returns the places at which the last forces acted.
  Corners places_of_forces(const PairKey& key) const;
  PairShape<Dim> shape(const PairKey& key, const Corners& at) const;
  /// Returns how far the corners of a pair that does not press must go at least until it may, m, but for
  /// kMargin; 0 or less where it may at once.
  ///
  /// \param within  largest way that is asked for, times kMargin, m
  double way_to_press(const PairKey& key, const Corners& at, double within) const;
  /// Returns the same of a pair that is handed over and rests: until a point goes through the law, or until
  /// its facets may leave each other.
  double way_to_change(const FoundPair<Dim>& pair, const Corners& at, double within) const;
  /// Returns the bits of the corners of a pair that a contact still joins to a corner across, at the mouth of
  /// a notch or the root of a crack: the contact presses there alone.
  std::uint32_t joined_corners(const PairKey& key) const;

  /// Returns a pair that was never touched.
  FoundPair<Dim> new_pair(const PairKey& key) const;
  /// Returns the sets of parameters of a pair: of a face that is handed over those of its contacts, in space
  /// the one at the second corner of the first facet; else that of the nearest contact of the interface, so
  /// that the pair has the temperature of its place.
  std::array<int, kSetsOfPair<Dim>> sets_of(const FoundPair<Dim>& pair) const;
  /// Returns the set of an interface at no special place; -1 where the body has none.
  int set_of_interface(int interface) const;
  /// Returns the coefficient of damping of a pair, Pa s/m: the share of 2 sqrt(K_n m / A) that the parameters
  /// ask for, with the mass of the smaller block over its longest facet.
  ///
  /// \param stiffness  K_n, Pa/m
  double damping_of(const PairKey& key, double stiffness) const;
  /// Adds the stiffness that free facets may meet to that of their gridpoints, and that of faces beyond their
  /// own contacts', N/m.
  void add_stiffness(std::vector<double>& of_gridpoints) const;

 private:
  int interface_of(const PairKey& key) const;

  const Body<Dim>& body_;
  const FoundData<Dim>& found_;
};

extern template class PairFacts<2>;
extern template class PairFacts<3>;

}  // namespace pyroclast
