#include "pyroclast/mechanics/mover.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "pyroclast/mechanics/found/found_contacts.hpp"

namespace pyroclast {

namespace {

/// Strides between two looks at what travels: messages go on only within calls.
constexpr std::size_t kStridesPerLook = 64;

/// Share of a thread in found contacts: rows, and of its own bundles the packs whose way is watched.
struct ShareOfFound {
  IndexRange rows, watched;
};

template <int Dim>
ShareOfFound share_of_found(const State<Dim>& s, const Layout<Dim>& layout, const IndexRange& bundles,
                            int thread, int threads) {
  ShareOfFound share;
  if (!s.found) return share;
  const auto rows = static_cast<std::int64_t>(s.found->rows.size());
  share.rows = {static_cast<int>(rows * thread / threads), static_cast<int>(rows * (thread + 1) / threads)};
  const auto before = [&](int bundle) {
    const auto& watched = s.found->watched;
    const int end = layout.first_pack_of(bundle);
    return static_cast<int>(std::ranges::lower_bound(watched, end, {}, &WatchedPack::pack) - watched.begin());
  };
  share.watched = {before(bundles.first), before(bundles.last)};
  return share;
}

}  // namespace

template <int Dim>
void Mover<Dim>::take_from_owners() {
  if (body_->found) return FoundContacts<Dim>(*body_).take_from_owners();
  if (halo_.is_empty()) return;
  halo_.exchange(body_->arrays, Travels::each_step);
  halo_.exchange(body_->arrays, Travels::each_call);
}

/// Lets found contacts search where they need to, and the halo follow their rows.
template <int Dim>
void Mover<Dim>::follow_found() {
  FoundContacts<Dim> found(*body_);
  found.search_where_needed();
  if (body_->model.ranks().count() == 1 || !std::exchange(body_->found->has_new_rows, false)) return;
  halo_.join(found.shared_gridpoints());
  workers_.clear();  // other bundles lead
}

template <int Dim>
void Mover<Dim>::sweep(int steps, Pass pass) {
  Body<Dim>& body = *body_;
  const StepPasses<Dim>& passes = body.step.passes;
  const bool measure = pass != Pass::move;
  Ranks& ranks = body.model.ranks();
  const bool finds_with_others = body.found && ranks.count() > 1;
  const bool moves_with_others = pass != Pass::measure && (finds_with_others || !halo_.is_empty());
  const auto update_faces = [&](State<Dim>& s, int first, int last, bool measured) {
    for_each_law(s, first, last, [&](const PackFunctions<Dim>& law, int begin, int end) {
      law.update(s, begin, end, measured);
    });
    if (!s.pore_pressure.empty()) passes.add_pore_pressure(s, first, last);
  };
  const auto sweep_through = [&](State<Dim>& s, Worker& worker, const Share::Stride& stride) {
    update_faces(s, stride.faces.first, stride.faces.last, measure);
    passes.move_bundles(s, stride.bundles.first, stride.bundles.last, pass, worker.scratch.data());
  };
  if (body.found) body.found->seen.moves = pass != Pass::measure;
  const auto way_of_found = [&] {
    double longest = 0.0;
    for (const Worker& worker : workers_) longest = larger(longest, worker.way_of_found);
    return longest;
  };
  halo_.spoil(body.arrays);
  // A call ends before its last step where other work took the cores, and fewer threads go on; and where
  // found contacts need a search.
  for (int left = steps, moved = 0; left > 0; left -= moved) {
    if (body.found) follow_found();
    const int threads =
        std::clamp(body.model.zone_count() / body.parameters.zones_for_a_thread, 1, body.team->offered());
    if (static_cast<int>(workers_.size()) != threads) {
      workers_.clear();
      for (Share& share : share_out(body.layout, threads, halo_.bundles_sent()))
        workers_.push_back({std::move(share), body.make_scratch(), 0.0});
    }
    const bool ties_join_parts = body.ties_join_parts();
    body.team->run(threads, [&](int thread) {
      Worker& worker = workers_[static_cast<std::size_t>(thread)];
      State<Dim> s = body.state;
      FoundRows<Dim> rows;  // those of this thread: the way changes from step to step
      if (s.found) {
        rows = *s.found;
        s.found = &rows;
      }
      const Share& share = worker.share;
      const ShareOfFound found = share_of_found(s, body.layout, share.bundles, thread, threads);
      int taken = 0;
      for (bool ends = false; taken < left && !ends; ++taken) {
        if (s.found) passes.update_found(s, found.rows.first, found.rows.last);
        for (const auto& faces : share.crossing) update_faces(s, faces.first, faces.last, measure);
        passes.place_corner_forces(s, share.corner_parts.first, share.corner_parts.last, pass);
        body.team->barrier();
        for (const auto& stride : share.leading) sweep_through(s, worker, stride);
        if (ties_join_parts) {
          body.team->barrier();
          passes.move_tied_parts(s, share.moved_parts.first, share.moved_parts.last, pass,
                                 worker.scratch.data());
        }
        // What leads has moved and travels, while the other bundles, next to no other rank, move.
        if (moves_with_others) body.team->barrier();
        const bool exchanges = moves_with_others && thread == 0;
        if (exchanges) halo_.begin_exchange(body.arrays, Travels::each_step);
        for (std::size_t i = 0; i < share.strides.size(); ++i) {
          sweep_through(s, worker, share.strides[i]);
          if (exchanges && i % kStridesPerLook == 0) halo_.go_on();
        }
        if (exchanges) {
          halo_.end_exchange(body.arrays, Travels::each_step);
          // the damping of found contacts reads velocities
          if (s.found && s.found->is_damped) halo_.exchange(body.arrays, Travels::each_call);
        }
        if (s.found) worker.way_of_found = passes.way_of_found(s, found.watched.first, found.watched.last);
        // ranks take as many steps as the others
        ends = body.team->barrier() && !moves_with_others;
        if (s.found) {
          rows.way = way_of_found();
          if (finds_with_others && moves_with_others) {
            if (thread == 0) way_of_all_ = ranks.largest(rows.way);
            body.team->barrier();
            rows.way = way_of_all_;
          }
          ends = ends || !(rows.way <= 1.0);
        }
      }
      if (thread == 0) moved = taken;
    });
    if (finds_with_others && moves_with_others) body.found->knows_all = false;
  }
  if (moves_with_others && measure) halo_.exchange(body.arrays, Travels::each_call);
}

template class Mover<2>;
template class Mover<3>;

}  // namespace pyroclast
