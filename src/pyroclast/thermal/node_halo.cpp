#include "pyroclast/thermal/node_halo.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace pyroclast {

NodeHalo::NodeHalo(const Model& model, const ThermalNodes& nodes, const ChunkList& chunks)
    : ranks_(&model.ranks()) {
  if (ranks_->count() == 1) return;
  const std::vector<int>& in_whole = model.part->gridpoint;  // ascending
  const auto own = chunks.own();
  struct Wanted {
    int rank, node, gridpoint;  // who asks, which of its nodes, and a gridpoint of the whole there
  };
  std::vector<Wanted> own_wishes;
  for (int node = 0; node < nodes.count(); ++node)
    if (!own.contain(node)) own_wishes.push_back({ranks_->me(), node, in_whole[nodes.gridpoint[node]]});
  if (ranks_->spoil_foreign())
    for (const Wanted& wanted : own_wishes) spoilt_.push_back(wanted.node);
  struct Answer {
    int owner;
    Wanted wanted;
  };
  std::vector<Answer> answers;
  std::map<int, Neighbour> of_rank;
  for (const Wanted& wanted : ranks_->collect(own_wishes)) {
    if (wanted.rank == ranks_->me()) continue;
    const auto here = std::ranges::lower_bound(in_whole, wanted.gridpoint);
    if (here == in_whole.end() || *here != wanted.gridpoint) continue;
    const int node = nodes.of_gridpoint[here - in_whole.begin()];
    if (!own.contain(node)) continue;
    of_rank[wanted.rank].sent.push_back(node);
    answers.push_back({ranks_->me(), wanted});
  }
  for (const Answer& answer : ranks_->collect(answers))
    if (answer.wanted.rank == ranks_->me()) of_rank[answer.owner].received.push_back(answer.wanted.node);
  for (auto& [rank, neighbour] : of_rank) {
    neighbours_.push_back(std::move(neighbour));
    messages_.push_back({rank, {}, {}});
  }
}

void NodeHalo::spoil(double* numbers, std::size_t of_each) const {
  for (const int node : spoilt_)
    std::fill_n(numbers + static_cast<std::size_t>(node) * of_each, of_each,
                std::numeric_limits<double>::quiet_NaN());
}

void NodeHalo::exchange(double* numbers, std::size_t of_each) {
  if (neighbours_.empty()) return;
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    auto& [rank, sent, received] = messages_[n];
    sent.resize(neighbours_[n].sent.size() * of_each);
    received.resize(neighbours_[n].received.size() * of_each);
    auto next = sent.begin();
    for (const int node : neighbours_[n].sent)
      next = std::copy_n(numbers + static_cast<std::size_t>(node) * of_each, of_each, next);
  }
  spoil(numbers, of_each);
  ranks_->exchange(messages_);
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    auto next = messages_[n].received.begin();
    for (const int node : neighbours_[n].received) {
      std::copy_n(next, of_each, numbers + static_cast<std::size_t>(node) * of_each);
      next += static_cast<std::ptrdiff_t>(of_each);
    }
  }
}

}  // namespace pyroclast
