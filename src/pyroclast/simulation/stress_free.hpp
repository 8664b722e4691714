#pragma once

#include <string>
#include <vector>

#include "pyroclast/base/vec.hpp"
#include "pyroclast/material/curve.hpp"
#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// At which temperature nothing is strained: one for the whole specimen, or a field that another run left.
struct StressFree {
  std::vector<Vec<2>> places;        ///< gridpoints of the other run, m; none for one temperature
  std::vector<double> temperatures;  ///< of each place, or the one, °C
  std::string place;                 ///< in the deck, for messages

  bool is_field() const { return !places.empty(); }
  Interval range() const;
};

/// Temperature of each gridpoint: that of the nearest place, at the bearings the reference temperature.
/// \param reach  within which a place must be, m
///
/// Throws Error where none is so near.
std::vector<double> stress_free_gridpoints(const StressFree& field, const Model<2>& model, double reach);

}  // namespace pyroclast
