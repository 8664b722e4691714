#include "pyroclast/mechanics/mover.hpp"

#include <algorithm>
#include <utility>

namespace pyroclast {

namespace {

/// Strides between two looks at what travels: messages go on only within calls.
constexpr std::size_t kStridesPerLook = 64;

}  // namespace

template <int Dim>
void Mover<Dim>::sweep(int steps, Pass pass) {
  Body<Dim>& body = *body_;
  const StepPasses<Dim>& passes = body.step.passes;
  const bool measure = pass != Pass::move;
  const bool moves_with_others = pass != Pass::measure && !halo_.is_empty();
  const auto update_faces = [](State<Dim>& s, int first, int last, bool measured) {
    for_each_law(s, first, last, [&](const PackFunctions<Dim>& law, int begin, int end) {
      law.update(s, begin, end, measured);
    });
  };
  const auto sweep_through = [&](State<Dim>& s, Worker& worker, const Share::Stride& stride) {
    update_faces(s, stride.faces.first, stride.faces.last, measure);
    passes.move_bundles(s, stride.bundles.first, stride.bundles.last, pass, worker.scratch.data());
  };
  halo_.spoil(body.arrays);
  // A call ends before its last step where other work took the cores, and fewer threads go on.
  for (int left = steps, moved = 0; left > 0; left -= moved) {
    const int threads =
        std::clamp(body.model.zone_count() / body.parameters.zones_for_a_thread, 1, body.team->offered());
    if (static_cast<int>(workers_.size()) != threads) {
      workers_.clear();
      for (Share& share : share_out(body.layout, threads, halo_.bundles_sent()))
        workers_.push_back({std::move(share), body.make_scratch()});
    }
    const bool ties_join_parts = body.ties_join_parts();
    body.team->run(threads, [&](int thread) {
      Worker& worker = workers_[static_cast<std::size_t>(thread)];
      State<Dim> s = body.state;
      int taken = 0;
      for (bool is_crowded = false; taken < left && !is_crowded; ++taken) {
        const Share& share = worker.share;
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
        if (exchanges) halo_.end_exchange(body.arrays, Travels::each_step);
        // ranks take as many steps as the others
        is_crowded = body.team->barrier() && !moves_with_others;
      }
      if (thread == 0) moved = taken;
    });
  }
  if (moves_with_others && measure) halo_.exchange(body.arrays, Travels::each_call);
}

template class Mover<2>;
template class Mover<3>;

}  // namespace pyroclast
