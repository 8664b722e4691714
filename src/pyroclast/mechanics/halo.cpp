#include "pyroclast/mechanics/halo.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

namespace pyroclast {

namespace {

/// Returns a component of a gridpoint's vector in an array by slot or by pack.
template <int Dim, class Array>
double& component(Array& array, int slot, int i) {
  if constexpr (std::is_same_v<std::decay_t<decltype(*array.data())>, VectorPack<Dim>>)
    return array[slot / kLanes].c[i][slot % kLanes];
  else
    return array[slot][i];
}

/// Calls `f(array)` for the arrays that travel at a moment.
template <int Dim, class F>
void for_each_that_travels(StateArrays<Dim, FlatArray>& arrays, Travels travels, F f) {
  for_each_array(
      [&](const ArrayInfo& info, auto& array) {
        using T = std::decay_t<decltype(*array.data())>;
        if constexpr (std::is_same_v<T, VectorPack<Dim>> || std::is_same_v<T, Vec<Dim>>)
          if (info.travels == travels) f(array);
      },
      arrays);
}

}  // namespace

template <int Dim>
Halo<Dim>::Halo(const ModelOf<Dim>& model, const Layout<Dim>& layout)
    : layout_(layout), ranks_(model.ranks()) {
  if (ranks_.count() == 1) return;
  of_faces_ = shared_gridpoints(model);
  join({});
  if (!ranks_.spoil_foreign()) return;
  const ChunkList::Items own = model.gridpoint_chunks().own();
  for (int g = 0; g < model.gridpoint_count(); ++g)
    if (!own.contain(g)) spoilt_.push_back(layout.gridpoint_slot[g]);
}

template <int Dim>
void Halo<Dim>::join(std::map<int, SharedGridpoints> found) {
  for (const auto& [rank, gridpoints] : of_faces_) {
    found[rank].own.insert(gridpoints.own.begin(), gridpoints.own.end());
    found[rank].foreign.insert(gridpoints.foreign.begin(), gridpoints.foreign.end());
  }
  neighbours_.clear();
  messages_.clear();
  bundles_sent_.clear();
  for (const auto& [rank, gridpoints] : found) {
    Neighbour& neighbour = neighbours_.emplace_back();
    for (const int g : gridpoints.own) neighbour.sent.push_back(layout_.gridpoint_slot[g]);
    for (const int g : gridpoints.foreign) neighbour.received.push_back(layout_.gridpoint_slot[g]);
    messages_.push_back({rank, {}, {}});
  }
  for (const Neighbour& neighbour : neighbours_)
    for (const int slot : neighbour.sent) bundles_sent_.push_back(layout_.bundle_of_pack[slot / kLanes]);
  std::ranges::sort(bundles_sent_);
  bundles_sent_.erase(std::unique(bundles_sent_.begin(), bundles_sent_.end()), bundles_sent_.end());
}

template <int Dim>
void Halo<Dim>::spoil(StateArrays<Dim, FlatArray>& arrays, Travels travels) {
  if (spoilt_.empty()) return;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  // after a step the velocities of the last call are out of date
  const auto is_spoilt = [&](Travels of_array) {
    return of_array == Travels::never || of_array == travels ||
           (of_array == Travels::each_call && travels == Travels::each_step);
  };
  for_each_array(
      [&](const ArrayInfo& info, auto& array) {
        using T = std::decay_t<decltype(*array.data())>;
        const bool is_of_gridpoints = info.per == Per::gridpoint_pack || info.per == Per::gridpoint_slot;
        if (!is_of_gridpoints || array.empty() || !is_spoilt(info.travels)) return;
        if constexpr (std::is_same_v<T, double>) {
          for (const int slot : spoilt_) array[slot] = nan;
        } else if constexpr (std::is_same_v<T, VectorPack<Dim>> || std::is_same_v<T, Vec<Dim>>) {
          if (info.lasts == Lasts::made) return;  // a position
          for (const int slot : spoilt_)
            for (int i = 0; i < Dim; ++i) component<Dim>(array, slot, i) = nan;
        }
      },
      arrays);
}

template <int Dim>
void Halo<Dim>::begin_exchange(StateArrays<Dim, FlatArray>& arrays, Travels travels) {
  std::size_t count = 0;
  for_each_that_travels<Dim>(arrays, travels, [&](auto& /*array*/) { ++count; });
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    auto& [rank, sent, received] = messages_[n];
    sent.resize(neighbours_[n].sent.size() * Dim * count);
    received.resize(neighbours_[n].received.size() * Dim * count);
    auto next = sent.begin();
    for_each_that_travels<Dim>(arrays, travels, [&](auto& array) {
      for (const int slot : neighbours_[n].sent)
        for (int i = 0; i < Dim; ++i) *next++ = component<Dim>(array, slot, i);
    });
  }
  spoil(arrays, travels);
  ranks_.begin_exchange(messages_);
}

template <int Dim>
void Halo<Dim>::end_exchange(StateArrays<Dim, FlatArray>& arrays, Travels travels) {
  ranks_.end_exchange(messages_);
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    auto next = messages_[n].received.begin();
    for_each_that_travels<Dim>(arrays, travels, [&](auto& array) {
      for (const int slot : neighbours_[n].received)
        for (int i = 0; i < Dim; ++i) component<Dim>(array, slot, i) = *next++;
    });
  }
}

template class Halo<2>;
template class Halo<3>;

}  // namespace pyroclast
