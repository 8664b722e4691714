#include "pyroclast/base/ranks.hpp"

namespace pyroclast {

namespace {

class OneRank final : public Ranks {
 public:
  int me() const override { return 0; }
  int count() const override { return 1; }
  void exchange(std::vector<Message>& /*messages*/, CallPlace /*at*/) override {}

 protected:
  std::vector<std::byte> gather(std::span<const std::byte> own, Receivers /*receivers*/,
                                CallPlace /*at*/) override {
    return {own.begin(), own.end()};
  }
  double largest_of_all(double own, CallPlace /*at*/) override { return own; }
};

}  // namespace

Ranks& one_rank() {
  static OneRank ranks;
  return ranks;
}

}  // namespace pyroclast
