#pragma once

#include <map>
#include <vector>

#include "pyroclast/base/ranks.hpp"
#include "pyroclast/mechanics/state.hpp"
#include "pyroclast/model/part.hpp"

namespace pyroclast {

/// Halo of a part of a body: the gridpoints that faces, and found pairs, join to gridpoints of other ranks.
/// What contacts read of them travels: each rank sends its own, and receives those of its neighbours.
template <int Dim>
class Halo {
 public:
  Halo(const ModelOf<Dim>& model, const Layout<Dim>& layout);

  /// Takes the gridpoints that found pairs join in, in the place of those before.
  void join(std::map<int, SharedGridpoints> found);

  /// Tells whether nothing joins the part to another rank.
  bool is_empty() const { return neighbours_.empty(); }
  /// Gives foreign gridpoints the numbers that their owners have.
  /// \param travels  kind of the arrays that travel now
  void exchange(StateArrays<Dim, FlatArray>& arrays, Travels travels) {
    begin_exchange(arrays, travels);
    end_exchange(arrays, travels);
  }
  /// Sends what neighbours read; until the end, only own numbers may be read or changed.
  void begin_exchange(StateArrays<Dim, FlatArray>& arrays, Travels travels);
  void go_on() { ranks_.go_on(); }
  void end_exchange(StateArrays<Dim, FlatArray>& arrays, Travels travels);
  /// Returns the bundles whose gridpoints neighbours read, in order.
  const std::vector<int>& bundles_sent() const { return bundles_sent_; }
  /// Where the ranks ask for it, makes numbers of foreign gridpoints NaN, see Ranks::spoil_foreign: those
  /// that owners alone have, and those that travel now or later. Positions stay.
  void spoil(StateArrays<Dim, FlatArray>& arrays, Travels travels = Travels::never);

 private:
  /// Slots of gridpoints whose numbers travel to and from a neighbour, in one order on both ranks.
  struct Neighbour {
    std::vector<int> sent, received;
  };

  const Layout<Dim>& layout_;
  Ranks& ranks_;
  std::map<int, SharedGridpoints> of_faces_;
  std::vector<Neighbour> neighbours_;
  std::vector<Message> messages_;  ///< messages by neighbour
  std::vector<int> bundles_sent_;
  std::vector<int> spoilt_;  ///< slots of foreign gridpoints, where tests spoil them
};

extern template class Halo<2>;
extern template class Halo<3>;

}  // namespace pyroclast
