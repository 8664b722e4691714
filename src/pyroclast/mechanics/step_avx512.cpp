// The step for processors with AVX512; compiled with that set's options, so nothing else may stand here.
#include "pyroclast/mechanics/step/step.hpp"

namespace pyroclast {

template <int Dim>
StepFunctions<Dim> avx512_step(RowFunctions<Dim> (*rows_of)(const LawTable&)) {
  return Step<Dim, Avx512>::functions(rows_of);
}

template StepFunctions<2> avx512_step(RowFunctions<2> (*)(const LawTable&));
template StepFunctions<3> avx512_step(RowFunctions<3> (*)(const LawTable&));

}  // namespace pyroclast
