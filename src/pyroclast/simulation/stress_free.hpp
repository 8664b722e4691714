#pragma once

#include <string>
#include <vector>

#include "pyroclast/base/vec.hpp"
#include "pyroclast/material/curve.hpp"
#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Temperature at which nothing is strained: one for the whole specimen, or a field that another run left.
struct StressFree {
  std::vector<Vec<3>> places;        ///< gridpoints of the other run, m; none for one temperature
  std::vector<double> temperatures;  ///< temperature of each place, or the one temperature, °C
  std::string place;                 ///< place in the deck, for messages

  bool is_field() const { return !places.empty(); }
  Interval range() const;
};

/// Returns the temperature of each gridpoint: that of the nearest place, at the bearings the reference
/// temperature. Throws Error where no place is near enough.
///
/// \param reach  largest distance of the nearest place, m
std::vector<double> stress_free_gridpoints(const StressFree& field, const Model& model, double reach);

}  // namespace pyroclast
