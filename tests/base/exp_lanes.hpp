#pragma once

#include "pyroclast/base/exp.hpp"

namespace pyroclast {

/// e^x of eight numbers; x and result are aligned to 64 bytes.
template <class Set>
void exp_of_lanes(const double* x, double* result) {
  exp(Lanes<Set>::load(x)).store(result);
}
void exp_avx2(const double* x, double* result);
void exp_avx512(const double* x, double* result);

}  // namespace pyroclast
