// Compiled with the options of AVX-512, so nothing else may stand here.
#include "exp_lanes.hpp"

void pyroclast::exp_avx512(const double* x, double* result) {
  exp_of_lanes<Avx512>(x, result);
}
