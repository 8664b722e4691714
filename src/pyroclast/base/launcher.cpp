#include "pyroclast/base/launcher.hpp"

#include <charconv>
#include <optional>

#include "pyroclast/base/environment.hpp"

namespace pyroclast {

namespace {

/// Variables with the number of copies and the number of the own one: of Open MPI, MPICH's Hydra and Slurm.
constexpr const char* kLaunchers[][2] = {{"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"},
                                         {"PMI_SIZE", "PMI_RANK"},
                                         {"SLURM_STEP_NUM_TASKS", "SLURM_PROCID"}};

std::optional<int> number_in(const char* variable) {
  const std::string text = environment(variable);
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

LaunchedCopies launched_copies() {
  for (const auto& [of_count, of_copy] : kLaunchers)
    if (const auto count = number_in(of_count); count && *count > 1)
      return {*count, number_in(of_copy).value_or(0), of_count};
  return {};
}

}  // namespace pyroclast
