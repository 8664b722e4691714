#include "pyroclast/model/item_halo.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "pyroclast/base/place_in.hpp"

namespace pyroclast {

ItemHalo::ItemHalo(Ranks& ranks, const std::vector<int>& foreign, const std::function<int(int)>& in_whole,
                   const std::function<int(int)>& own)
    : ranks_(&ranks) {
  struct Wanted {
    int rank, item, in_whole;  // who asks, for which of its items, and its number in the whole
  };
  std::vector<Wanted> own_wishes;
  for (const int item : foreign) own_wishes.push_back({ranks_->me(), item, in_whole(item)});
  if (ranks_->spoil_foreign()) spoilt_ = foreign;
  struct Answer {
    int owner;
    Wanted wanted;
  };
  std::vector<Answer> answers;
  std::map<int, Neighbour> of_rank;
  for (const Wanted& wanted : ranks_->collect(own_wishes)) {
    if (wanted.rank == ranks_->me()) continue;
    const int here = own(wanted.in_whole);
    if (here < 0) continue;
    of_rank[wanted.rank].sent.push_back(here);
    answers.push_back({ranks_->me(), wanted});
  }
  for (const Answer& answer : ranks_->collect(answers))
    if (answer.wanted.rank == ranks_->me()) of_rank[answer.owner].received.push_back(answer.wanted.item);
  for (auto& [rank, neighbour] : of_rank) {
    neighbours_.push_back(std::move(neighbour));
    messages_.push_back({rank, {}, {}});
  }
}

void ItemHalo::spoil(double* numbers, std::size_t of_each) const {
  for (const int item : spoilt_)
    std::fill_n(numbers + static_cast<std::size_t>(item) * of_each, of_each,
                std::numeric_limits<double>::quiet_NaN());
}

void ItemHalo::spread(double* numbers, std::size_t of_each) {
  if (neighbours_.empty()) return;
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    auto& [rank, sent, received] = messages_[n];
    sent.resize(neighbours_[n].sent.size() * of_each);
    received.resize(neighbours_[n].received.size() * of_each);
    auto next = sent.begin();
    for (const int item : neighbours_[n].sent)
      next = std::copy_n(numbers + static_cast<std::size_t>(item) * of_each, of_each, next);
  }
  spoil(numbers, of_each);
  ranks_->exchange(messages_);
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    auto next = messages_[n].received.begin();
    for (const int item : neighbours_[n].received) {
      std::copy_n(next, of_each, numbers + static_cast<std::size_t>(item) * of_each);
      next += static_cast<std::ptrdiff_t>(of_each);
    }
  }
}

namespace {

/// Returns the halo of items, of which those in the whole are known by ascending numbers.
template <class IsOwn>
ItemHalo halo_of(Ranks& ranks, const std::vector<int>& in_whole, IsOwn is_own) {
  std::vector<int> foreign;
  for (int i = 0; i < static_cast<int>(in_whole.size()); ++i)
    if (!is_own(i)) foreign.push_back(i);
  const auto own = [&](int number) {
    const int item = place_in_ascending(in_whole, number);
    return item >= 0 && is_own(item) ? item : -1;
  };
  return {ranks, foreign, [&](int item) { return in_whole[item]; }, own};
}

}  // namespace

ItemHalo contact_halo(const Model& model) {
  if (!model.part) return {};
  std::vector<bool> is_own(model.contact_count());
  const ContactsByChunk by_chunk = contacts_by_chunk(model);
  by_chunk.chunks.for_each_own([&](int first, int last) {
    for (int i = first; i < last; ++i) is_own[by_chunk.contacts[i]] = true;
  });
  return halo_of(model.ranks(), model.part->contact, [&](int contact) { return is_own[contact]; });
}

ItemHalo gridpoint_halo(const Model& model) {
  if (!model.part) return {};
  const ChunkList::Items own = model.gridpoint_chunks().own();
  return halo_of(model.ranks(), model.part->gridpoint, [&](int g) { return own.contain(g); });
}

}  // namespace pyroclast
