#include "pyroclast/base/state_visitor.hpp"

#include <cmath>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

std::string describe(const StateRule& rule) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  const bool has_least = rule.least > -kLargest, has_most = rule.most < kLargest;
  if (rule.least == -state::kInfinite && rule.most == state::kInfinite) return "a number";
  if (!has_least && !has_most) return "a finite number";
  if (!has_most) return fmt::format("{:g} or greater", rule.least);
  if (!has_least) return fmt::format("{:g} or less", rule.most);
  if (rule.least > rule.most) return "left out, as it could name nothing";
  return fmt::format("{:g} to {:g}", rule.least, rule.most);
}

}  // namespace

void StateVisitor::refuse(const std::string& name, const std::string& what) const {
  throw Error(fmt::format("the state is not sound: \"{}\" {}", name, what));
}

void StateVisitor::visit_chunks(const std::string& name, const ChunksPiece& piece, Ranks& /*ranks*/) {
  std::byte* data = piece.data;
  if (piece.resize) {
    auto* const counts = reinterpret_cast<std::byte*>(piece.counts.data());
    visit_piece(name + ".counts", {sizeof(std::uint64_t), piece.counts.size(), counts, {}});
    if (replaces()) data = piece.resize();
  }
  visit_piece(name, {piece.item, piece.count(), data, {}});
}

void StateVisitor::check_size(const std::string& name, std::size_t count,
                              const std::optional<std::size_t>& wanted) const {
  if (wanted && count != *wanted)
    refuse(name, fmt::format("has {} entries, but must have {}", count, *wanted));
}

void StateVisitor::refuse_number(const std::string& name, double value, std::int64_t place,
                                 const StateRule& rule) const {
  const std::string at = place < 0 ? "" : fmt::format(" at entry {}", place);
  refuse(name, fmt::format("is {:g}{}, but must be {}", value, at, describe(rule)));
}

}  // namespace pyroclast
