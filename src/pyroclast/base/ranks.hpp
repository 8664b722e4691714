#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace pyroclast {

/// Place in the code from which a collective is called. Where ranks check their calls, all must call from the
/// same place.
struct CallPlace {
  const char* file;
  int line;

  static constexpr CallPlace here(const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
    return {file, line};
  }
  bool operator==(const CallPlace& other) const {
    return line == other.line && std::strcmp(file, other.file) == 0;
  }
};

/// Numbers that travel between a rank and a neighbour.
struct Message {
  int rank = 0;  ///< the neighbour
  std::vector<double> sent, received;
};

/// Ranks: the processes that hold the parts of one body, see PartOfBody. The functions are collectives: all
/// ranks call them in the same order. Results are the same on all ranks, and do not depend on which rank came
/// first.
class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int me() const = 0;
  virtual int count() const = 0;
  /// Tells whether this is the rank that writes files and speaks to the user.
  bool is_first() const { return me() == 0; }

  /// Returns the items of all ranks, in the order of the ranks.
  template <class T>
  std::vector<T> collect(const std::vector<T>& own, CallPlace at = CallPlace::here()) {
    static_assert(std::is_trivially_copyable_v<T>, "what travels is plain data");
    if (count() == 1) return own;
    return items_of<T>(gather(std::as_bytes(std::span(own)), Receivers::all, at));
  }
  /// Returns the same on the first rank, and nothing on the others.
  template <class T>
  std::vector<T> collect_at_first(const std::vector<T>& own, CallPlace at = CallPlace::here()) {
    static_assert(std::is_trivially_copyable_v<T>, "what travels is plain data");
    if (count() == 1) return own;
    return items_of<T>(gather(std::as_bytes(std::span(own)), Receivers::first, at));
  }
  double largest(double own, CallPlace at = CallPlace::here()) {
    return count() == 1 ? own : largest_of_all(own, at);
  }
  double least(double own, CallPlace at = CallPlace::here()) { return -largest(-own, at); }
  /// Tells whether a condition holds on any rank.
  bool any(bool own, CallPlace at = CallPlace::here()) { return largest(own ? 1.0 : 0.0, at) > 0.0; }
  std::int64_t sum(std::int64_t own, CallPlace at = CallPlace::here()) {
    std::int64_t total = 0;
    for (const std::int64_t of_rank : collect(std::vector<std::int64_t>{own}, at)) total += of_rank;
    return total;
  }
  /// Sends each neighbour its message and receives the neighbour's. Neighbours name each other, with the
  /// lengths that the other one expects.
  virtual void exchange(std::vector<Message>& messages, CallPlace at = CallPlace::here()) = 0;

 protected:
  enum class Receivers : std::uint8_t { all, first };
  /// Returns the bytes of all ranks, in the order of the ranks; nothing on a rank that does not receive.
  virtual std::vector<std::byte> gather(std::span<const std::byte> own, Receivers receivers,
                                        CallPlace at) = 0;
  virtual double largest_of_all(double own, CallPlace at) = 0;

 private:
  template <class T>
  static std::vector<T> items_of(const std::vector<std::byte>& bytes) {
    std::vector<T> items(bytes.size() / sizeof(T));
    if (!items.empty()) std::memcpy(items.data(), bytes.data(), bytes.size());
    return items;
  }
};

/// Returns the one rank of a body that no other process holds a part of.
Ranks& one_rank();

}  // namespace pyroclast
