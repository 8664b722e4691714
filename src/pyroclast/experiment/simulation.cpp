#include "pyroclast/experiment/simulation.hpp"

#include <algorithm>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <omp.h>
#include <sys/resource.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/experiment/coupling.hpp"

namespace pyroclast {

namespace {

/// Measured peak over the number of blocks, from 5,000 to 1,000,000 blocks (docs/performance.md), rounded up:
/// heat conduction takes half as much again.
constexpr double kBytesPerBlock = 6000.0;
constexpr double kBytesFixed = 40e6;

/// Memory that this process may still take, bytes: what the machine has free, or the process limit if
/// smaller.
double available_memory() {
  double available = std::numeric_limits<double>::infinity();
  std::ifstream file("/proc/meminfo");
  for (std::string name; file >> name;) {
    double kilobytes = 0.0;
    if (name == "MemAvailable:" && file >> kilobytes) {
      available = 1024.0 * kilobytes;
      break;
    }
    file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    available = std::min(available, static_cast<double>(limit.rlim_cur));
  return available;
}

specimen::Specimen make_checked_specimen(const specimen::SpecimenParameters& parameters) {
  const double needed = estimate_memory(parameters.blocks.count);
  const double available = available_memory();
  if (needed > available)
    throw Error(fmt::format("blocks.count = {}: needs about {:.1f} GB of memory, but only {:.1f} GB is free",
                            parameters.blocks.count, needed * 1e-9, available * 1e-9));
  return specimen::make_specimen(parameters);
}

std::unique_ptr<TemperatureField> make_field(const ConcreteModel& body, const Case& c) {
  if (c.heat.uniform) return std::make_unique<TemperatureField>(body, c.heat.initial);
  const Interval initial{c.heat.initial, c.heat.initial};  // each exposure widens it
  return std::make_unique<TemperatureField>(body, make_conduction(body, c.solids, c.heat, initial));
}

std::unique_ptr<Mechanics<2>> make_mechanics(const Model<2>& model, const ConcreteMaterials& materials,
                                             const TemperatureField& field,
                                             const MechanicsParameters<2>& parameters) {
  std::vector<double> densities;
  for (const auto& solid : materials.solids) densities.push_back(solid.density(kReferenceTemperature));
  return std::make_unique<Mechanics<2>>(model, densities, properties_at(model, materials, field), parameters,
                                        std::make_shared<Team>(omp_get_max_threads()));
}

}  // namespace

double estimate_memory(std::int64_t blocks) {
  return kBytesFixed + kBytesPerBlock * static_cast<double>(blocks);
}

HeatSimulation::HeatSimulation(const Case& c)
    : heat(c.heat),
      specimen(make_checked_specimen(c.specimen)),
      body(make_concrete_model(specimen, c.platen_thickness, c.thickness)),
      field(make_field(body, c)) {}

Simulation::Simulation(const Case& c)
    : HeatSimulation(c),
      materials(make_concrete(c.solids, c.contacts, specimen.metrics.mean_size)),
      mechanics(make_mechanics(body.model, materials, *field, c.mechanics)) {}

}  // namespace pyroclast
