// The step for processors with AVX512; compiled with that set's options, so nothing else may stand here.
#include "pyroclast/mechanics/step/step.hpp"

namespace pyroclast {

template <int Dim>
StepFunctions<Dim> avx512_step() {
  return Step<Dim, Avx512>::functions();
}

template StepFunctions<2> avx512_step<2>();
template StepFunctions<3> avx512_step<3>();

}  // namespace pyroclast
