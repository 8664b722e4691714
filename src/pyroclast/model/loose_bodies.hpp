#pragma once

#include <string>
#include <vector>

#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Body that was not made with the specimen: one convex block, which meets others through contacts that are
/// found.
struct LooseBody {
  std::string name;                     ///< name of the body, of its interface and of its sets
  std::vector<Vec<3>> corners;          ///< corners, m; in the plane around the body in either sense, z = 0
  std::vector<std::vector<int>> faces;  ///< in space corners of each, counter-clockwise seen from outside
  double edge = 0.0;                    ///< length of the edges of its zones, about, m
  std::string material;                 ///< name in [materials]
  std::string deck_place;               ///< place in the deck that asks for it, for messages
};

/// Tells whether the corners of a body in the plane go round a convex area, in either sense.
bool goes_round_convex_area(const LooseBody& body);

/// Adds bodies to a model, each with an interface of its name, and the sets `<name>` of all its gridpoints
/// and `<name>_outline` of those on its outline, in the plane in their order around it. See zones_of. Throws
/// Error, naming the body and its place in the deck, where its name is that of a set, or where it lies in
/// another block.
template <int Dim>
void add_loose_bodies(ModelOf<Dim>& model, const std::vector<LooseBody>& bodies);

/// Returns for each block the interface of its name where it is a loose body; else -1.
std::vector<int> interfaces_of_loose_bodies(const Model& model);

}  // namespace pyroclast
