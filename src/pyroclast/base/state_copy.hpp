#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"

namespace pyroclast {

/// Copy in memory of everything that a thing shows to a visitor. It takes the state of one thing and puts it
/// into another that was made alike.
class StateCopy {
 public:
  using Visit = std::function<void(StateVisitor&)>;

  void take(const Visit& visit);
  /// Writes the copy back. Throws Error when the names or sizes that are shown differ from those taken.
  void put(const Visit& visit) const;

 private:
  struct Piece {
    std::size_t item = 0, count = 0;
    std::vector<std::byte> bytes;
  };
  class Taker;
  class Putter;

  std::map<std::string, Piece> pieces_;
};

}  // namespace pyroclast
