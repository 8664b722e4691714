// Compiled with the options of AVX2, so nothing else may stand here.
#include "exp_lanes.hpp"

void pyroclast::exp_avx2(const double* x, double* result) {
  exp_of_lanes<Avx2>(x, result);
}
