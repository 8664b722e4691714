#pragma once

#include <vector>

#include "pyroclast/model/model.hpp"
#include "pyroclast/thermal/thermal_mesh.hpp"

namespace pyroclast {

/// Halo of the thermal nodes of a part of a body: foreign nodes, whose numbers their owners send. A node is
/// known by any of its gridpoints: the owner has them all, and the first that another part has need not be
/// the first of the whole.
class NodeHalo {
 public:
  NodeHalo() = default;
  /// Finds the owners: a collective.
  /// \param chunks  chunks of the nodes
  NodeHalo(const Model& model, const ThermalNodes& nodes, const ChunkList& chunks);

  /// Gives foreign nodes the numbers that their owners have: a collective.
  void spread(std::vector<double>& of_nodes) { exchange(of_nodes.data(), 1); }
  /// \tparam Numbers  a type made of nothing but doubles
  template <class Numbers>
  void spread(std::vector<Numbers>& of_nodes) {
    static_assert(sizeof(Numbers) % sizeof(double) == 0);
    exchange(reinterpret_cast<double*>(of_nodes.data()), sizeof(Numbers) / sizeof(double));
  }
  /// Where the ranks ask for it, makes the numbers of foreign nodes NaN, see Ranks::spoil_foreign.
  void spoil(std::vector<double>& of_nodes) const { spoil(of_nodes.data(), 1); }

 private:
  void exchange(double* numbers, std::size_t of_each);
  void spoil(double* numbers, std::size_t of_each) const;

  /// Nodes whose numbers travel to and from a neighbour, in one order on both ranks.
  struct Neighbour {
    std::vector<int> sent, received;
  };

  Ranks* ranks_ = &one_rank();
  std::vector<Neighbour> neighbours_;
  std::vector<Message> messages_;  ///< messages by neighbour
  std::vector<int> spoilt_;        ///< foreign nodes, where tests spoil them
};

}  // namespace pyroclast
