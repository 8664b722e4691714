// The step for processors with AVX2; compiled with that set's options, so nothing else may stand here.
#include "pyroclast/mechanics/step/step.hpp"

namespace pyroclast {

template <int Dim>
StepFunctions<Dim> avx2_step() {
  using S = Step<Dim, Avx2>;
  return {S::update_faces, S::move_bundles, S::sum_stiffness};
}

template StepFunctions<2> avx2_step<2>();
template StepFunctions<3> avx2_step<3>();

}  // namespace pyroclast
