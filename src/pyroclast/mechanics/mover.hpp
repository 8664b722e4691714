#pragma once

#include <vector>

#include "pyroclast/mechanics/body.hpp"
#include "pyroclast/mechanics/halo.hpp"
#include "pyroclast/mechanics/sweep.hpp"

namespace pyroclast {

/// Mover of a body: takes its steps, shared out to threads, and lets displacements travel between ranks. No
/// other part of mechanics knows of threads.
template <int Dim>
class Mover {
 public:
  explicit Mover(Body<Dim>& body) : body_(&body), halo_(body.model, body.layout) {}

  /// Takes a number of sweeps over faces and bundles, of one kind.
  void sweep(int steps, Pass pass);
  /// Gives foreign gridpoints the displacements and velocities that their owners have.
  void take_from_owners();

 private:
  /// Share and memory of a thread in a step.
  struct Worker {
    Share share;
    FlatArray<double> scratch;
    double way_of_found = 0.0;  ///< see StepPasses
  };

  void follow_found();

  Body<Dim>* body_;
  Halo<Dim> halo_;
  std::vector<Worker> workers_;  ///< workers by thread
  double way_of_all_ = 0.0;      ///< longest way of found contacts on all ranks
};

extern template class Mover<2>;
extern template class Mover<3>;

}  // namespace pyroclast
