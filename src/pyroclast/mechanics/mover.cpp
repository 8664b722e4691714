#include "pyroclast/mechanics/mover.hpp"

#include <algorithm>
#include <utility>

namespace pyroclast {

template <int Dim>
void Mover<Dim>::sweep(int steps, Pass pass) {
  Body<Dim>& body = *body_;
  const bool measure = pass != Pass::move;
  const auto update_faces = [](State<Dim>& s, int first, int last, bool measured) {
    for_each_law(s, first, last, [&](const PackFunctions<Dim>& law, int begin, int end) {
      law.update(s, begin, end, measured);
    });
  };
  // A call ends before its last step where other work took the cores, and fewer threads go on.
  for (int left = steps, moved = 0; left > 0; left -= moved) {
    const int threads =
        std::clamp(body.model.zone_count() / body.parameters.zones_for_a_thread, 1, body.team->offered());
    if (static_cast<int>(workers_.size()) != threads) {
      workers_.clear();
      for (Share& share : share_out(body.layout, threads))
        workers_.push_back({std::move(share), body.make_scratch()});
    }
    body.team->run(threads, [&](int thread) {
      Worker& worker = workers_[static_cast<std::size_t>(thread)];
      State<Dim> s = body.state;
      int taken = 0;
      for (bool is_crowded = false; taken < left && !is_crowded; ++taken) {
        for (const auto& faces : worker.share.crossing) update_faces(s, faces.first, faces.last, measure);
        body.team->barrier();
        for (const auto& stride : worker.share.strides) {
          update_faces(s, stride.faces.first, stride.faces.last, measure);
          body.step.passes.move_bundles(s, stride.bundles.first, stride.bundles.last, pass,
                                        worker.scratch.data());
        }
        is_crowded = body.team->barrier();
      }
      if (thread == 0) moved = taken;
    });
  }
}

template class Mover<2>;
template class Mover<3>;

}  // namespace pyroclast
