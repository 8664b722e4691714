#include "pyroclast/base/launcher.hpp"

#include "pyroclast/base/environment.hpp"

namespace pyroclast {

namespace {

/// Variables with the number of copies and the number of the own one: of Open MPI, MPICH's Hydra and Slurm.
constexpr const char* kLaunchers[][2] = {{"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"},
                                         {"PMI_SIZE", "PMI_RANK"},
                                         {"SLURM_STEP_NUM_TASKS", "SLURM_PROCID"}};

}  // namespace

LaunchedCopies launched_copies() {
  for (const auto& [of_count, of_copy] : kLaunchers)
    if (const auto count = number_in_environment(of_count); count && *count > 1)
      return {*count, number_in_environment(of_copy).value_or(0), of_count};
  return {};
}

}  // namespace pyroclast
