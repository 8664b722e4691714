#pragma once

#include <string>

namespace pyroclast {

/// Copies of a program that a launcher started together, mpirun or srun.
struct LaunchedCopies {
  int count = 1;
  int number = 0;        ///< number of this copy, from 0
  std::string variable;  ///< variable of the environment that tells the count
};

/// Returns the copies of which this process is one, by the variables that launchers set: those of the step at
/// hand, not of the whole allocation. One copy where no launcher tells of more.
LaunchedCopies launched_copies();

}  // namespace pyroclast
