#pragma once

#include "pyroclast/mechanics/body.hpp"
#include "pyroclast/mechanics/found/pair_facts.hpp"

namespace pyroclast {

/// Rows of pairs: puts the near pairs side by side for the step, and gives them back their numbers.
template <int Dim>
class PairRows {
 public:
  explicit PairRows(Body<Dim>& body) : body_(body), found_(*body.found), facts_(body) {}

  /// Puts near pairs into rows: those of one law and its choices side by side, and among them those for which
  /// a step does as much: that bear, touch, are asked, or sleep. Rows of few such pairs take as long as full
  /// ones.
  void make();
  /// Lets rows and gridpoints sleep while no pair of theirs can press.
  void let_sleep();
  /// Gives pairs the numbers that they have in rows.
  void take_back();

 private:
  const ConstantsOfSet& constants_of(int set);
  void put(const FoundPair<Dim>& pair, int index, int lane);
  void list_loads();

  Body<Dim>& body_;
  FoundData<Dim>& found_;
  PairFacts<Dim> facts_;
};

/// Gives a pair the numbers that it has in its row; does nothing where it stands in none.
template <int Dim>
void take_from_row(const FoundData<Dim>& found, FoundPair<Dim>& pair);

extern template class PairRows<2>;
extern template class PairRows<3>;

}  // namespace pyroclast
