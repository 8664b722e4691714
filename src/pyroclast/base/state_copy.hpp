#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"

namespace pyroclast {

/// All that is shown to a visitor, kept in memory: takes it from one thing and puts it into another that was
/// made alike.
class StateCopy {
 public:
  using Visit = std::function<void(StateVisitor&)>;

  void take(const Visit& visit);
  /// Throws Error when what is shown has other names or sizes than what was taken.
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
