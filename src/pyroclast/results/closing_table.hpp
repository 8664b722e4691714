#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include "pyroclast/results/file.hpp"

namespace pyroclast {

/// Table at the end of a file, behind which stand its place, its size, its hash and a mark of the file's
/// form.
struct ClosingTable {
  using Mark = std::array<char, 8>;

  std::uint64_t begin = 0;  ///< place in the file
  std::string text;
  std::uint64_t hash = 0;

  /// Returns the bytes that close a file.
  static std::string bytes(std::uint64_t begin, std::string text, const Mark& mark);
  /// Reads the table of a file.
  /// \param fail  called with what is wrong with the file; must throw
  static ClosingTable read(const File& file, const Mark& mark,
                           const std::function<void(const std::string& what)>& fail);
  /// Returns the mark of a file, which may be any eight bytes; zeros where the file is shorter.
  static Mark mark_of(const File& file);
};

}  // namespace pyroclast
