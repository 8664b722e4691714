#pragma once

#include <string>
#include <vector>

#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Body in the plane that was not made with the specimen: one block, which meets others through contacts that
/// are found.
struct LooseBody {
  std::string name;             ///< name of the body, of its interface and of its sets
  std::vector<Vec<2>> corners;  ///< corners of a convex outline, in either sense, m
  double edge = 0.0;            ///< length of its edges, about, m
  std::string material;         ///< name in [materials]
  std::string deck_place;       ///< place in the deck that asks for it, for messages
};

/// Tells whether corners go round a convex area, in either sense.
bool is_convex(const std::vector<Vec<2>>& corners);

/// Adds bodies to a model, each with an interface of its name, and the sets `<name>` of all its gridpoints
/// and `<name>_outline` of those on its outline, in their order. A body with four corners has a grid of
/// zones; another one has rings around its centroid. Throws Error, naming the body and its place in the deck,
/// where its name is that of a set, or where it lies in another block.
void add_loose_bodies(ModelOf<2>& model, const std::vector<LooseBody>& bodies);

/// Returns for each block the interface of its name where it is a loose body; else -1.
std::vector<int> interfaces_of_loose_bodies(const Model& model);

}  // namespace pyroclast
