#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/flat_array.hpp"

namespace pyroclast {

/// Values that the numbers of a state may have. NaN is never allowed.
struct StateRule {
  double least = -std::numeric_limits<double>::max(), most = std::numeric_limits<double>::max();
  std::optional<std::size_t> size = std::nullopt;  ///< number of values, where it is known

  StateRule of(std::size_t count) const { return {least, most, count}; }
};

namespace state {

inline constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Bound above every count; sums of two counts are still whole numbers.
inline constexpr double kMostCounted = 1e15;

constexpr StateRule finite() {
  return {};
}
/// Allows any number, also an infinite one.
constexpr StateRule number() {
  return {-kInfinite, kInfinite};
}
constexpr StateRule within(double least, double most) {
  return {least, most};
}
constexpr StateRule at_least(double least) {
  return {least, std::numeric_limits<double>::max()};
}
/// Allows counts of things.
constexpr StateRule count() {
  return {0.0, kMostCounted};
}
/// Allows indices into a list of this size.
constexpr StateRule index(std::size_t size) {
  return {0.0, static_cast<double>(size) - 1.0};
}

}  // namespace state

/// Entries by chunk that are not as many for another state: those of own chunks, one chunk after the other.
template <class T>
struct ListByChunk {
  std::vector<T> entries;
  std::vector<std::uint64_t> counts;  ///< number of entries of each own chunk

  /// Makes the list of a body: `add(chunk, entries)` appends the entries of an own chunk.
  template <class Add>
  static ListByChunk of(const ChunkList& chunks, Add add) {
    ListByChunk list;
    for (int chunk = 0; chunk < chunks.count(); ++chunk) {
      if (chunks.is_foreign(chunk)) continue;
      const std::size_t before = list.entries.size();
      add(chunk, list.entries);
      list.counts.push_back(list.entries.size() - before);
    }
    return list;
  }
  /// Calls `f(chunk, entries)` for each own chunk.
  template <class F>
  void for_each(const ChunkList& chunks, F f) const {
    std::span<const T> rest(entries);
    auto count = counts.begin();
    for (int chunk = 0; chunk < chunks.count(); ++chunk) {
      if (chunks.is_foreign(chunk)) continue;
      f(chunk, rest.first(*count));
      rest = rest.subspan(*count++);
    }
  }
};

/// Returns the number of entries of all own chunks.
inline std::uint64_t total(const std::vector<std::uint64_t>& counts) {
  std::uint64_t sum = 0;
  for (const std::uint64_t count : counts) sum += count;
  return sum;
}

/// Visitor to which a moving thing shows, under its name, everything that the thing keeps from one batch of
/// steps to the next. The visitor reads each value, or replaces it by the value that an equal thing kept
/// elsewhere. The thing then computes whatever depends on the values.
class StateVisitor {
 public:
  StateVisitor() = default;
  StateVisitor(const StateVisitor&) = delete;
  StateVisitor& operator=(const StateVisitor&) = delete;
  virtual ~StateVisitor() = default;

  /// Tells whether the visitor replaces the values that it is shown.
  virtual bool replaces() const = 0;

  /// Tells whether the new values come from outside the program; they are then checked before they are used.
  virtual bool checks() const { return false; }

  /// Visits a number, by default a finite one; whole numbers need a rule.
  template <class T>
  requires std::is_same_v<T, double>
  void visit(std::string_view name, T& value) { visit(name, value, state::finite()); }
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void visit(std::string_view name, T& value, const StateRule& rule) {
    const std::string full = scope_ + std::string(name);
    visit_piece(full, {sizeof(T), 1, reinterpret_cast<std::byte*>(&value), {}});
    if (checks()) check(full, &value, 1, rule);
  }
  void visit(std::string_view name, bool& value) {
    std::uint8_t byte = value ? 1 : 0;
    visit(name, byte, state::within(0, 1));
    value = byte != 0;
  }
  /// Visits a list of numbers.
  template <class Array>
  requires std::is_same_v < std::decay_t<decltype(*std::declval<Array&>().data())>,
  double > void visit(std::string_view name, Array& values) { visit(name, values, state::finite()); }
  template <class Array>
  requires std::is_arithmetic_v<std::decay_t<decltype(*std::declval<Array&>().data())>>
  void visit(std::string_view name, Array& values, const StateRule& rule) {
    const std::string full = scope_ + std::string(name);
    visit_array(full, values);
    if (checks()) check(full, values.data(), values.size(), rule);
  }
  /// Visits a plain object, or a list of them, made of nothing but `double`; a rule counts objects, not
  /// numbers.
  template <class T>
  void visit_numbers(std::string_view name, T& value, const StateRule& rule = {}) {
    const std::string full = scope_ + std::string(name);
    if constexpr (requires { value.resize(1); }) {
      visit_array(full, value);
      if (checks()) check_numbers(full, value.data(), value.size(), rule);
    } else {
      visit_piece(full, {sizeof(T), 1, reinterpret_cast<std::byte*>(&value), {}});
      if (checks()) check_numbers(full, &value, 1, rule);
    }
  }
  // Where several ranks hold a body, the state has each chunk once, as its owner shows it: collectives.
  // Nothing is done to foreign entries, of which the owner can tell.

  /// Visits an array of numbers that has one entry for each item of a list, or of plain objects made of
  /// nothing but `double`. \param chunks  chunks of the list
  template <class Array>
  void visit_by_chunk(std::string_view name, Array& values, const ChunkList& chunks,
                      const StateRule& rule = state::finite()) {
    using T = std::decay_t<decltype(*values.data())>;
    const auto [first, last] = chunks.own();
    std::vector<std::uint64_t> counts;
    chunks.for_each_own(
        [&](int begin, int end) { counts.push_back(static_cast<std::uint64_t>(end - begin)); });
    const std::string full = scope_ + std::string(name);
    T* const own = values.data() + first;
    const auto count = static_cast<std::size_t>(last - first);
    visit_chunks(full, {sizeof(T), counts, reinterpret_cast<std::byte*>(own), {}}, chunks.ranks());
    if (!checks()) return;
    if constexpr (std::is_arithmetic_v<T>)
      check(full, own, count, rule.of(count));
    else
      check_numbers(full, own, count, rule.of(count));
  }
  /// Visits a list whose numbers of entries may be others in another state; the caller checks its values with
  /// `require`.
  template <class T>
  void visit_by_chunk(std::string_view name, ListByChunk<T>& list, const ChunkList& chunks) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto resize = [&] {
      list.entries.resize(total(list.counts));
      return reinterpret_cast<std::byte*>(list.entries.data());
    };
    visit_chunks(scope_ + std::string(name),
                 {sizeof(T), list.counts, reinterpret_cast<std::byte*>(list.entries.data()), resize},
                 chunks.ranks());
  }
  /// Refuses a value from outside where a promise about the value does not hold.
  void require(bool holds, std::string_view name, std::string_view what) const {
    if (!holds && checks()) refuse(scope_ + std::string(name), std::string(what));
  }

  void visit(std::string_view name, std::string& text) { visit_array(scope_ + std::string(name), text); }
  /// Visits a list of words, none of which may hold a line's end.
  void visit(std::string_view name, std::vector<std::string>& words) {
    std::string lines;
    for (const std::string& word : words) lines += word + '\n';
    visit(name, lines);
    if (!replaces()) return;
    require(lines.empty() || lines.back() == '\n', name, "does not end with a line's end");
    words.clear();
    for (std::size_t begin = 0; begin < lines.size();) {
      const auto end = lines.find('\n', begin);
      words.push_back(lines.substr(begin, end - begin));
      begin = end + 1;
    }
  }

  /// Prefix "name." of all names while the object lives.
  class Scope {
   public:
    Scope(StateVisitor& visitor, std::string_view name) : visitor_(visitor), outer_(visitor.scope_) {
      visitor_.scope_ += name;
      visitor_.scope_ += '.';
    }
    ~Scope() { visitor_.scope_ = outer_; }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    StateVisitor& visitor_;
    std::string outer_;
  };

 protected:
  /// Consecutive plain data of one kind.
  struct Piece {
    std::size_t item;  ///< bytes of one item
    std::size_t count;
    std::byte* data;
    /// Function that makes room for another number of items and returns their new place; empty where the
    /// number is fixed.
    std::function<std::byte*(std::size_t)> resize;
  };
  virtual void visit_piece(const std::string& name, const Piece& piece) = 0;
  /// Plain data of own chunks, one chunk after the other.
  struct ChunksPiece {
    std::size_t item;                    ///< bytes of one item
    std::vector<std::uint64_t>& counts;  ///< number of items of each own chunk
    std::byte* data;
    /// Function that makes room for other `counts` and returns its place; empty where they are fixed.
    std::function<std::byte*()> resize;

    std::uint64_t count() const { return total(counts); }
  };
  /// By default what this rank holds is visited as pieces.
  virtual void visit_chunks(const std::string& name, const ChunksPiece& piece, Ranks& ranks);
  /// Throws an Error that says what is wrong with the value of a name.
  virtual void refuse(const std::string& name, const std::string& what) const;

 private:
  template <class T>
  void check(const std::string& name, const T* values, std::size_t count, const StateRule& rule) const {
    check_size(name, count, rule.size);
    for (std::size_t i = 0; i < count; ++i)
      check_number(name, static_cast<double>(values[i]), count == 1 && !rule.size ? -1 : std::int64_t(i),
                   rule);
  }
  template <class T>
  void check_numbers(const std::string& name, const T* values, std::size_t count,
                     const StateRule& rule) const {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0);
    check_size(name, count, rule.size);
    constexpr std::size_t kOfOne = sizeof(T) / sizeof(double);
    for (std::size_t i = 0; i < count; ++i) {
      double numbers[kOfOne];
      std::memcpy(numbers, values + i, sizeof(T));
      for (const double number : numbers) check_number(name, number, static_cast<std::int64_t>(i), rule);
    }
  }
  void check_size(const std::string& name, std::size_t count, const std::optional<std::size_t>& wanted) const;
  /// \param place  index in the list; -1 for a single number
  void check_number(const std::string& name, double value, std::int64_t place, const StateRule& rule) const {
    if (!(value >= rule.least && value <= rule.most)) refuse_number(name, value, place, rule);
  }
  void refuse_number(const std::string& name, double value, std::int64_t place, const StateRule& rule) const;

  template <class Array>
  void visit_array(const std::string& name, Array& values) {
    using T = std::decay_t<decltype(*values.data())>;
    static_assert(std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool>);
    visit_piece(
        name, {sizeof(T), values.size(), reinterpret_cast<std::byte*>(values.data()), [&](std::size_t count) {
                 values.resize(count);
                 return reinterpret_cast<std::byte*>(values.data());
               }});
  }

  std::string scope_;
};

}  // namespace pyroclast
