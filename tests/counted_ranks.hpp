#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "pyroclast/base/ranks.hpp"

namespace pyroclast {

/// Rank that counts what it sends, for tests and benches.
class CountedRanks final : public Ranks {
 public:
  /// Messages to a neighbour, and their numbers.
  struct Sent {
    int messages = 0;
    std::size_t numbers = 0, fewest = SIZE_MAX;  ///< of all messages, and of the shortest
  };

  explicit CountedRanks(std::shared_ptr<Ranks> inner) : inner_(std::move(inner)) {}

  int me() const override { return inner_->me(); }
  int count() const override { return inner_->count(); }
  void begin_exchange(std::vector<Message>& messages, CallPlace at) override {
    for (const Message& message : messages) {
      Sent& to = sent[message.rank];
      ++to.messages;
      to.numbers += message.sent.size();
      to.fewest = std::min(to.fewest, message.sent.size());
    }
    if (!is_alone) inner_->begin_exchange(messages, at);
  }
  void end_exchange(std::vector<Message>& messages, CallPlace at) override {
    if (!is_alone) inner_->end_exchange(messages, at);
  }
  void forget() {
    sent.clear();
    collectives = 0;
  }

  std::map<int, Sent> sent;      ///< by neighbour
  std::int64_t collectives = 0;  ///< calls but exchanges
  /// True where nothing travels: what comes is what came last.
  bool is_alone = false;

 protected:
  std::vector<std::byte> gather(std::span<const std::byte> own, Receivers receivers, CallPlace at) override {
    ++collectives;
    const std::vector<std::byte> bytes(own.begin(), own.end());
    return receivers == Receivers::all ? inner_->collect(bytes, at) : inner_->collect_at_first(bytes, at);
  }

 private:
  std::shared_ptr<Ranks> inner_;
};

}  // namespace pyroclast
