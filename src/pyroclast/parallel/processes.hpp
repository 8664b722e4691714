#pragma once

#include <memory>

#include "pyroclast/base/ranks.hpp"

namespace pyroclast {

/// Ranks that are processes of one MPI job. The destructor ends MPI: a process joins a job once.
class Processes : public Ranks {
 public:
  /// Returns the number of ranks, this one among them, that may run on the very processors of this rank.
  virtual int sharing_processors() const = 0;
  /// Waits until all ranks have come here, without taking their processors.
  virtual void wait_for_all() = 0;
  /// Ends all ranks at once.
  [[noreturn]] virtual void end_all(int exit_code) = 0;
};

/// Content of pyroclast_mpi.so, which alone knows MPI: the program loads it where a user asks for ranks.
struct MpiObject {
  const char* version;                   ///< version and commit of the program for which it was built
  std::unique_ptr<Processes> (*join)();  ///< Joins the job that a launcher started.
};

/// Name of the function without arguments that returns `const MpiObject*`.
inline constexpr const char* kMpiSymbol = "pyroclast_mpi";

}  // namespace pyroclast
