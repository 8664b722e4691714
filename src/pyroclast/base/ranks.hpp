#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
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
  /// Returns "file:line".
  std::string text() const { return std::string(file) + ":" + std::to_string(line); }
  /// Returns a number for the place (FNV-1a), the same in all processes of a program.
  std::uint64_t hash() const {
    std::uint64_t hash = 14695981039346656037U;
    for (const char c : text()) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
    return hash;
  }
};

/// Numbers that travel between a rank and a neighbour.
struct Message {
  int rank = 0;  ///< the neighbour
  std::vector<double> sent, received;
};

/// Collectives of a call of Ranks::together, in their order.
struct Gathering {
  struct OfCollective {
    CallPlace at;
    std::vector<std::byte> bytes;  ///< bytes of this rank, then those of all ranks
  };
  std::vector<OfCollective> collectives;
  bool has_travelled = false;
  std::size_t taken = 0;  ///< collectives that have their results
};
/// Ends a gathering, also where its function throws.
struct GatheringEnd {
  std::optional<Gathering>& gathering;
  ~GatheringEnd() { gathering.reset(); }
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
    return collect_made<T>([&] { return own; }, at);
  }
  /// Returns the items of all ranks, in the order of the ranks.
  /// \param make  returns the items of this rank; not called where they have travelled, see together
  template <class T, class Make>
  std::vector<T> collect_made(Make make, CallPlace at) {
    static_assert(std::is_trivially_copyable_v<T>, "what travels is plain data");
    if (count() == 1) return make();
    if (gathering_ && gathering_->has_travelled) return items_of<T>(take(at));
    std::vector<T> own = make();
    if (!gathering_) return items_of<T>(gather(std::as_bytes(std::span(own)), Receivers::all, at));
    put(std::as_bytes(std::span(own)), at);
    return own;
  }
  /// Returns the items of all ranks on the first, and nothing on the others. Not within `together`.
  template <class T>
  std::vector<T> collect_at_first(const std::vector<T>& own, CallPlace at = CallPlace::here()) {
    static_assert(std::is_trivially_copyable_v<T>, "what travels is plain data");
    if (count() == 1) return own;
    return items_of<T>(gather(std::as_bytes(std::span(own)), Receivers::first, at));
  }
  /// Returns the number that a rank has.
  double of(int rank, double own, CallPlace at = CallPlace::here()) {
    if (count() == 1) return own;
    const std::vector<double> all = collect(rank == me() ? std::vector{own} : std::vector<double>(), at);
    return all.empty() ? own : all.front();
  }
  double largest(double own, CallPlace at = CallPlace::here()) {
    if (count() == 1) return own;
    const std::vector<double> all = collect(std::vector{own}, at);
    return *std::max_element(all.begin(), all.end());  // in one order, so that NaN is the same on all ranks
  }
  double least(double own, CallPlace at = CallPlace::here()) { return -largest(-own, at); }
  /// Tells whether a condition holds on any rank.
  bool any(bool own, CallPlace at = CallPlace::here()) { return largest(own ? 1.0 : 0.0, at) > 0.0; }
  std::int64_t sum(std::int64_t own, CallPlace at = CallPlace::here()) {
    std::int64_t total = 0;
    for (const std::int64_t of_rank : collect(std::vector<std::int64_t>{own}, at)) total += of_rank;
    return total;
  }
  /// Calls `f` and returns its result, with all collectives of `f` in one message. Where there are several
  /// ranks, `f` is called twice. First each collective puts down what this rank gives, and returns that
  /// alone. Then all of it travels, and at the second call each collective returns what all ranks gave. So
  /// what `f` gives to a collective, and to which, must not depend on the result of another one. What `f`
  /// changes, it changes at one of the calls alone, see `gives` and `has_all`. Calls within `f` take part in
  /// its message.
  template <class F>
  auto together(F f, CallPlace at = CallPlace::here()) {
    if (count() == 1 || gathering_) return f();
    const GatheringEnd end{gathering_};
    gathering_.emplace();
    f();
    send(at);
    if constexpr (std::is_void_v<decltype(f())>) {
      f();
      require_all_taken();
    } else {
      auto result = f();
      require_all_taken();
      return result;
    }
  }
  /// Tells whether collectives take what this rank gives: not at the second call of `together`.
  bool gives() const { return !gathering_ || !gathering_->has_travelled; }
  /// Tells whether collectives return what all ranks gave: not at the first call of `together`.
  bool has_all() const { return !gathering_ || gathering_->has_travelled; }

  /// Tells whether numbers of foreign items are to be NaN wherever their owner has not sent them. Tests ask
  /// for it: whatever reads a number that is not there shows.
  virtual bool spoil_foreign() const { return false; }

  /// Sends each neighbour its message and receives the neighbour's. Neighbours name each other, with the
  /// lengths that the other one expects.
  void exchange(std::vector<Message>& messages, CallPlace at = CallPlace::here()) {
    begin_exchange(messages, at);
    end_exchange(messages, at);
  }
  /// Begins an exchange: messages stay as they are until its end, and no other exchange begins before.
  virtual void begin_exchange(std::vector<Message>& messages, CallPlace at = CallPlace::here()) = 0;
  /// Lets messages that travel go on: with MPI, long ones do so within calls alone.
  virtual void go_on() {}
  /// Waits until all messages of the exchange have come, and those sent may change.
  virtual void end_exchange(std::vector<Message>& messages, CallPlace at = CallPlace::here()) = 0;

 protected:
  enum class Receivers : std::uint8_t { all, first };
  /// Returns the bytes of all ranks, in the order of the ranks; nothing on a rank that does not receive.
  virtual std::vector<std::byte> gather(std::span<const std::byte> own, Receivers receivers,
                                        CallPlace at) = 0;

 private:
  template <class T>
  static std::vector<T> items_of(const std::vector<std::byte>& bytes) {
    std::vector<T> items(bytes.size() / sizeof(T));
    if (!items.empty()) std::memcpy(items.data(), bytes.data(), bytes.size());
    return items;
  }

  void put(std::span<const std::byte> own, CallPlace at);
  std::vector<std::byte> take(CallPlace at);
  void send(CallPlace at);
  void require_all_taken() const;

  std::optional<Gathering> gathering_;
};

/// Returns the one rank of a body that no other process holds a part of.
Ranks& one_rank();

}  // namespace pyroclast
