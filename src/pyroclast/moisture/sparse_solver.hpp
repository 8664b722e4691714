#pragma once

#include <memory>
#include <vector>

namespace pyroclast {

/// Direct solver of sparse, unsymmetric systems with one pattern of entries: KLU of SuiteSparse (Davis and
/// Palamadai Natarajan 2010). It has no tolerance and no threads, and calls no BLAS, so the bits of a
/// solution depend on the system alone: each is factored anew, with pivots that it chose itself.
class SparseSolver {
 public:
  /// \param column_begin  entries of column i stand at [i] to [i + 1]
  /// \param rows          row of each entry, ascending in each column
  SparseSolver(std::vector<int> column_begin, std::vector<int> rows);
  ~SparseSolver();
  SparseSolver(SparseSolver&&) noexcept;

  /// Replaces a right-hand side by the solution. Returns false where the system is singular.
  /// \param entries  numbers of the matrix, as `rows` orders them
  bool solve(std::vector<double>& entries, std::vector<double>& right_hand_side);

 private:
  struct Factors;
  std::vector<int> column_begin_, rows_;
  std::unique_ptr<Factors> factors_;
};

}  // namespace pyroclast
