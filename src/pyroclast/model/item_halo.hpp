#pragma once

#include <functional>
#include <vector>

#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Halo of a list of items of a part of a body: foreign items, whose numbers their owners send. Both know an
/// item by a number in the whole body.
class ItemHalo {
 public:
  ItemHalo() = default;
  /// Finds the owners: a collective.
  /// \param foreign   foreign items, in any order
  /// \param in_whole  returns the number in the whole of a foreign item
  /// \param own       returns the own item of a number in the whole; -1 where the item is of another rank
  ItemHalo(Ranks& ranks, const std::vector<int>& foreign, const std::function<int(int)>& in_whole,
           const std::function<int(int)>& own);

  /// Gives foreign items the numbers that their owners have: a collective.
  void spread(std::vector<double>& of_items) { spread(of_items.data(), 1); }
  /// \param of_each  numbers of each item
  void spread(double* numbers, std::size_t of_each);
  /// \tparam Numbers  a type made of nothing but doubles
  template <class Numbers>
  void spread(std::vector<Numbers>& of_items) {
    static_assert(sizeof(Numbers) % sizeof(double) == 0);
    spread(reinterpret_cast<double*>(of_items.data()), sizeof(Numbers) / sizeof(double));
  }
  /// Where the ranks ask for it, makes the numbers of foreign items NaN, see Ranks::spoil_foreign.
  void spoil(std::vector<double>& of_items) const { spoil(of_items.data(), 1); }

 private:
  void spoil(double* numbers, std::size_t of_each) const;

  /// Items whose numbers travel to and from a neighbour, in one order on both ranks.
  struct Neighbour {
    std::vector<int> sent, received;
  };

  Ranks* ranks_ = &one_rank();
  std::vector<Neighbour> neighbours_;
  std::vector<Message> messages_;  ///< messages by neighbour
  std::vector<int> spoilt_;        ///< foreign items, where tests spoil them
};

/// Returns the halo of the contacts of a model, also of those between two blocks of another rank.
ItemHalo contact_halo(const Model& model);
/// Returns the halo of the gridpoints of a model.
ItemHalo gridpoint_halo(const Model& model);

}  // namespace pyroclast
