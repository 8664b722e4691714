#pragma once

#include <optional>
#include <vector>

#include "pyroclast/mechanics/body.hpp"
#include "pyroclast/mechanics/found/pair_facts.hpp"

namespace pyroclast {

/// Search for pairs: lists those that are far, and among them those that are near.
template <int Dim>
class PairSearch {
 public:
  explicit PairSearch(Body<Dim>& body) : body_(body), found_(*body.found), facts_(body) {}

  /// Finds the near pairs, and first the far ones where they are not known any more. Returns whether there
  /// are near ones that stand in no row: a collective. All pairs have the numbers of their rows, and all
  /// gridpoints are where their owners have them.
  bool find();
  /// Adds the facets of faces that have just become free to the lists of far pairs that hold.
  void add_to_far(const std::vector<int>& faces);
  /// Leaves out the present overlap of near pairs that lie in each other as they begin.
  ///
  /// \param fresh      true for facets that begin
  /// \param tolerance  depth over the length of an edge that is none
  void leave_out_overlaps(const std::vector<bool>& fresh, double tolerance);

 private:
  static constexpr double kMargin = PairFacts<Dim>::kMargin;

  struct Box {
    Vec<Dim> low, high;
  };
  std::vector<double> ways(double steps, double least, double most) const;
  std::optional<Box> box_of(int facet) const;
  void list_if_far(int a, const Box& box_a, int b, const Box& box_b);
  void find_far();
  double wakes(const PairKey& key, const FoundPair<Dim>* handed_over) const;
  bool find_near();
  void watch();

  Body<Dim>& body_;
  FoundData<Dim>& found_;
  PairFacts<Dim> facts_;
};

extern template class PairSearch<2>;
extern template class PairSearch<3>;

}  // namespace pyroclast
