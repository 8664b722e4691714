#include "pyroclast/base/ranks.hpp"

#include <stdexcept>

namespace pyroclast {

namespace {

class OneRank final : public Ranks {
 public:
  int me() const override { return 0; }
  int count() const override { return 1; }
  void begin_exchange(std::vector<Message>& /*messages*/, CallPlace /*at*/) override {}
  void end_exchange(std::vector<Message>& /*messages*/, CallPlace /*at*/) override {}

 protected:
  std::vector<std::byte> gather(std::span<const std::byte> own, Receivers /*receivers*/,
                                CallPlace /*at*/) override {
    return {own.begin(), own.end()};
  }
};

/// Number of a collective in a message: what it is, and how many bytes a rank gives.
struct Head {
  std::uint64_t place, bytes;
};

void append(std::vector<std::byte>& to, std::span<const std::byte> bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

/// Takes a number or a struct off the front of bytes.
template <class T>
T take_off(std::span<const std::byte>& bytes) {
  T taken;
  std::memcpy(&taken, bytes.data(), sizeof(T));
  bytes = bytes.subspan(sizeof(T));
  return taken;
}

[[noreturn]] void fail(CallPlace at) {
  throw std::logic_error(at.text() +
                         ": a collective was called that other ranks did not call, or not the first time");
}

}  // namespace

void Ranks::put(std::span<const std::byte> own, CallPlace at) {
  gathering_->collectives.push_back({at, {own.begin(), own.end()}});
}

/// Lets what all collectives gave travel: from each rank their count, then a head and bytes of each.
void Ranks::send(CallPlace at) {
  auto& collectives = gathering_->collectives;
  gathering_->has_travelled = true;
  const std::uint64_t count = collectives.size();
  if (count == 0) return;
  std::vector<std::byte> own;
  append(own, std::as_bytes(std::span(&count, 1)));
  for (auto& [place, bytes] : collectives) {
    const Head head{place.hash(), bytes.size()};
    append(own, std::as_bytes(std::span(&head, 1)));
    append(own, bytes);
    bytes.clear();
  }
  const std::vector<std::byte> all = gather(own, Receivers::all, at);
  for (std::span<const std::byte> left(all); !left.empty();) {
    if (take_off<std::uint64_t>(left) != count) fail(at);
    for (auto& [place, bytes] : collectives) {
      const Head head = take_off<Head>(left);
      if (head.place != place.hash()) fail(place);
      append(bytes, left.first(head.bytes));
      left = left.subspan(head.bytes);
    }
  }
}

std::vector<std::byte> Ranks::take(CallPlace at) {
  auto& [collectives, has_travelled, taken] = *gathering_;
  if (taken == collectives.size() || !(collectives[taken].at == at)) fail(at);
  return std::move(collectives[taken++].bytes);
}

void Ranks::require_all_taken() const {
  if (gathering_->taken != gathering_->collectives.size())
    fail(gathering_->collectives[gathering_->taken].at);
}

Ranks& one_rank() {
  static OneRank ranks;
  return ranks;
}

}  // namespace pyroclast
