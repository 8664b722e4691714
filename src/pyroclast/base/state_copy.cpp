#include "pyroclast/base/state_copy.hpp"

#include <cstring>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

class StateCopy::Taker : public StateVisitor {
 public:
  explicit Taker(StateCopy& copy) : copy_(copy) {}
  bool replaces() const override { return false; }

 private:
  void visit_piece(const std::string& name, const Piece& piece) override {
    copy_.pieces_[name] = {piece.item, piece.count, {piece.data, piece.data + piece.item * piece.count}};
  }

  StateCopy& copy_;
};

class StateCopy::Putter : public StateVisitor {
 public:
  explicit Putter(const StateCopy& copy) : copy_(copy) {}
  bool replaces() const override { return true; }
  std::size_t count() const { return count_; }

 private:
  void visit_piece(const std::string& name, const Piece& piece) override {
    const auto found = copy_.pieces_.find(name);
    if (found == copy_.pieces_.end())
      throw Error(fmt::format("the state that is copied has no \"{}\"", name));
    const auto& [item, count, bytes] = found->second;
    if (item != piece.item || (!piece.resize && count != piece.count))
      throw Error(fmt::format("the state that is copied has another size of \"{}\"", name));
    std::byte* const to = piece.resize ? piece.resize(count) : piece.data;
    if (!bytes.empty()) std::memcpy(to, bytes.data(), bytes.size());
    ++count_;
  }

  const StateCopy& copy_;
  std::size_t count_ = 0;
};

void StateCopy::take(const Visit& visit) {
  pieces_.clear();
  Taker taker(*this);
  visit(taker);
}

void StateCopy::put(const Visit& visit) const {
  Putter putter(*this);
  visit(putter);
  if (putter.count() != pieces_.size())
    throw Error("the state that is copied holds more than there is a place for");
}

}  // namespace pyroclast
