// The step for processors with AVX2; compiled with that set's options, so nothing else may stand here.
#include "pyroclast/mechanics/step/step.hpp"

namespace pyroclast {

template <int Dim>
StepFunctions<Dim> avx2_step() {
  return Step<Dim, Avx2>::functions();
}

template StepFunctions<2> avx2_step<2>();
template StepFunctions<3> avx2_step<3>();

}  // namespace pyroclast
