#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "pyroclast/base/flat_array.hpp"

namespace pyroclast {

/// What numbers of a state can be. NaN is never one.
struct StateRule {
  double least = -std::numeric_limits<double>::max(), most = std::numeric_limits<double>::max();
  std::optional<std::size_t> size = std::nullopt;  ///< how many there are, where that is known

  StateRule of(std::size_t count) const { return {least, most, count}; }
};

namespace state {

inline constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// More than anything is counted to; sums of two counts are still whole numbers.
inline constexpr double kMostCounted = 1e15;

constexpr StateRule finite() {
  return {};
}
/// A number that may be infinite.
constexpr StateRule number() {
  return {-kInfinite, kInfinite};
}
constexpr StateRule within(double least, double most) {
  return {least, most};
}
constexpr StateRule at_least(double least) {
  return {least, std::numeric_limits<double>::max()};
}
/// Of things that are counted.
constexpr StateRule count() {
  return {0.0, kMostCounted};
}
/// Of a list of so many.
constexpr StateRule index(std::size_t size) {
  return {0.0, static_cast<double>(size) - 1.0};
}

}  // namespace state

/// Is shown, under its name, all that a moving thing keeps from one batch of steps to the next. It reads it,
/// or replaces it by what the same thing kept elsewhere; the thing then works out what follows.
class StateVisitor {
 public:
  StateVisitor() = default;
  StateVisitor(const StateVisitor&) = delete;
  StateVisitor& operator=(const StateVisitor&) = delete;
  virtual ~StateVisitor() = default;

  /// Whether what is shown is replaced.
  virtual bool replaces() const = 0;

  /// Whether what replaces it comes from outside: it is then looked at before anything is made of it.
  virtual bool checks() const { return false; }

  /// A number, by default a finite one; whole numbers need a rule.
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
  /// A list.
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
  /// A plain thing, or a list of them, that is made of nothing but `double`; a rule counts things, not
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
  /// Plain things that whoever shows them looks at, see `require`.
  template <class Array>
  void visit_plain(std::string_view name, Array& values, std::optional<std::size_t> size = std::nullopt) {
    const std::string full = scope_ + std::string(name);
    visit_array(full, values);
    if (checks()) check_size(full, values.size(), size);
  }
  /// Refuses what came from outside where a promise about it does not hold.
  void require(bool holds, std::string_view name, std::string_view what) const {
    if (!holds && checks()) refuse(scope_ + std::string(name), std::string(what));
  }

  void visit(std::string_view name, std::string& text) { visit_array(scope_ + std::string(name), text); }
  /// A list of words, none of which may hold a line's end.
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

  /// Puts "name." before all names while it is there.
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
  /// Plain data of one kind, side by side.
  struct Piece {
    std::size_t item;  ///< bytes of one
    std::size_t count;
    std::byte* data;
    /// Makes room for another number of them and returns where they stand; empty where the number is fixed.
    std::function<std::byte*(std::size_t)> resize;
  };
  virtual void visit_piece(const std::string& name, const Piece& piece) = 0;
  /// Throws an Error that says what is wrong of what stands under a name.
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
  /// \param place  in its list; -1 for a number of its own
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
