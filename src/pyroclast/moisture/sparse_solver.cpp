#include "pyroclast/moisture/sparse_solver.hpp"

#include <new>
#include <utility>

#include <klu.h>

namespace pyroclast {

struct SparseSolver::Factors {
  klu_common common;
  klu_symbolic* symbolic = nullptr;

  Factors(int size, int* column_begin, int* rows) {
    klu_defaults(&common);
    common.btf = 0;  // water reaches every cell from every other: there are no blocks to look for
    symbolic = klu_analyze(size, column_begin, rows, &common);
    if (symbolic == nullptr) throw std::bad_alloc();
  }
  ~Factors() { klu_free_symbolic(&symbolic, &common); }
  Factors(const Factors&) = delete;
  Factors& operator=(const Factors&) = delete;
};

SparseSolver::SparseSolver(std::vector<int> column_begin, std::vector<int> rows)
    : column_begin_(std::move(column_begin)),
      rows_(std::move(rows)),
      factors_(std::make_unique<Factors>(static_cast<int>(column_begin_.size()) - 1, column_begin_.data(),
                                         rows_.data())) {}
SparseSolver::~SparseSolver() = default;
SparseSolver::SparseSolver(SparseSolver&&) noexcept = default;

bool SparseSolver::solve(std::vector<double>& entries, std::vector<double>& right_hand_side) {
  klu_common& common = factors_->common;
  klu_numeric* numeric =
      klu_factor(column_begin_.data(), rows_.data(), entries.data(), factors_->symbolic, &common);
  const bool is_regular = numeric != nullptr && common.status == KLU_OK;
  if (is_regular)
    klu_solve(factors_->symbolic, numeric, static_cast<int>(column_begin_.size()) - 1, 1,
              right_hand_side.data(), &common);
  klu_free_numeric(&numeric, &common);
  return is_regular;
}

}  // namespace pyroclast
