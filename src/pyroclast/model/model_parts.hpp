#pragma once

#include <string>
#include <vector>

#include "pyroclast/model/concrete_model.hpp"

/// Parts that the making of models in the plane and in space share.
namespace pyroclast {

/// Returns the numbers from `first` up to `last`, excluded.
std::vector<int> all_from(int first, int last);

/// Returns the heights between the rows of a bearing's zones over its thickness, from 0 to 1. Contact forces
/// vary along the face much faster than into the depth, and even out away from the seat: zones at the seat
/// are about twice as high as wide, and each row is twice as high as the one before.
/// \param thickness  of the bearing, m
/// \param width      mean width of the zones at the seat, m
std::vector<double> bearing_rows(double thickness, double width);

/// Names the blocks from a number on: adds their gridpoints to the set `specimen`, and to those of their
/// materials.
void name_blocks(Model& model, int first_block);

/// Names the contacts from a number on: adds them to the set of contacts of a body, and to those of their
/// interfaces.
void name_contacts(Model& model, const std::string& body, int first_contact);

/// Returns the interface that joins two cells of a specimen, in the plane or in space.
template <class Specimen>
int interface_of(const InterfaceTable& table, const Specimen& specimen, int cell, int other) {
  const int phase = specimen.phase[cell];
  const auto stone = [&](int c) { return specimen.grain.empty() ? -1 : specimen.grain[c]; };
  const bool are_stones = stone(cell) >= 0 && stone(other) >= 0;
  const bool of_two_stones = phase == specimen.phase[other] && are_stones && stone(cell) != stone(other);
  return of_two_stones ? table.between_stones(phase) : table.between(phase, specimen.phase[other]);
}

/// Adds the materials and interfaces of bearings, each once, behind those of the specimen.
void add_bearing_names(Model& model, const std::vector<Bearing>& bearings);

}  // namespace pyroclast
