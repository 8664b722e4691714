#include "bodies.hpp"

#include <algorithm>
#include <cmath>

#include "pyroclast/base/error.hpp"
#include "pyroclast/deck/deck.hpp"
#include "pyroclast/simulation/coupling.hpp"
#include "pyroclast/stages/compress.hpp"

namespace bench {

using pyroclast::Error;
using pyroclast::Setup;

namespace {

/// Mean of specimens of 1,000 to 100,000 blocks (docs/performance.md).
constexpr double kZonesPerBlock = 5.4;
/// Axial strain that is imposed, and the steps in which.
constexpr double kIntactStrain = 1e-4, kCrackedStrain = 5e-3;
constexpr int kIntactSteps = 100, kCrackedSteps = 400;
/// Steps at the platen velocity of the deck before anything is timed.
constexpr int kStepsAtRest = 100;

Setup read(const std::filesystem::path& deck) {
  return pyroclast::read_setup(pyroclast::Deck::open(deck), deck.parent_path());
}

pyroclast::specimen::Specimen make(pyroclast::specimen::SpecimenParameters parameters, int blocks) {
  parameters.blocks.count = blocks;
  return pyroclast::make_checked_specimen(parameters);
}

double platen_velocity(const Setup& setup) {
  for (const auto& stage : setup.stages)
    if (const auto* compress = dynamic_cast<const pyroclast::Compress*>(stage.get()))
      return compress->velocity();
  throw Error("the bench needs the deck of a compression");
}

/// Gives every gridpoint the velocity of a uniform compression, so that no wave has to run through the
/// specimen, and lets it go, but for the supports: rate in 1/s.
template <class Body>
void start_compression(Body& body, const Specimen& specimen, double rate) {
  constexpr double kPoisson = 0.2;
  const auto& model = specimen.model;
  const auto& x = model.position;
  const int gridpoints = model.gridpoint_count();
  for (int g = 0; g < gridpoints; ++g) {
    const bool platen = x[g][1] < 0.0 || x[g][1] > specimen.height;
    body.constraints().prescribe_velocity(g, 0,
                                          platen ? 0.0 : kPoisson * rate * (x[g][0] - 0.5 * specimen.width));
    body.constraints().prescribe_velocity(g, 1, -rate * std::clamp(x[g][1], 0.0, specimen.height));
  }
  for (int g : model.set("bottom_platen_face")) body.constraints().prescribe_velocity(g, 0, 0.0);
  for (int g : model.set("top_platen_face")) body.constraints().prescribe_velocity(g, 0, 0.0);
  body.advance(1);
  for (int g = 0; g < gridpoints; ++g)
    for (int i : {0, 1}) body.constraints().release(g, i);
  for (int g : model.set("bottom_platen_support"))
    for (int i : {0, 1}) body.constraints().prescribe_velocity(g, i, 0.0);
  for (int g : model.set("top_platen_support")) {
    body.constraints().prescribe_velocity(g, 0, 0.0);
    body.constraints().prescribe_velocity(g, 1, -rate * specimen.height);
  }
}

/// A fast compression to a strain, then on at the velocity of the deck.
template <class Body>
std::unique_ptr<Body> loaded(std::unique_ptr<Body> body, const Specimen& specimen, Loading loading,
                             double velocity) {
  const bool cracked = loading == Loading::cracked;
  const int steps = cracked ? kCrackedSteps : kIntactSteps;
  const double strain = cracked ? kCrackedStrain : kIntactStrain;
  start_compression(*body, specimen, strain / (steps * body->time_step()));
  body->advance(steps - 1);
  start_compression(*body, specimen, velocity / specimen.height);
  body->advance(kStepsAtRest);
  return body;
}

}  // namespace

const char* name(Loading loading) {
  return loading == Loading::intact ? "intact" : "cracked";
}

Specimen::Specimen(const Setup& setup, int blocks)
    : made(make(setup.specimen, blocks)),
      model(pyroclast::make_concrete_model(made, setup.thickness, setup.motion->contacts.interfaces,
                                           setup.motion->bearings)),
      width(made.region.box().width()),
      height(made.region.box().height()),
      parameters(setup.motion->mechanics) {
  const auto materials =
      pyroclast::make_concrete(setup.solids, setup.motion->contacts, made.metrics.mean_size);
  const pyroclast::TemperatureField field(model, pyroclast::kReferenceTemperature);
  properties = pyroclast::properties_at(model, materials, field, {model, materials, field});
  for (const auto& solid : materials.solids)
    densities.push_back(solid.density(pyroclast::kReferenceTemperature));
}

Bodies::Bodies(const std::filesystem::path& deck) : setup_(read(deck)), velocity_(platen_velocity(setup_)) {
  if (!setup_.motion) throw Error("the bench needs the deck of a specimen between platens");
}

const Specimen& Bodies::specimen(int zones) {
  auto& kept = specimens_[zones];
  if (!kept) kept = std::make_unique<Specimen>(setup_, static_cast<int>(std::lround(zones / kZonesPerBlock)));
  return *kept;
}

pyroclast::Mechanics<2>& Bodies::mechanics(int zones, Loading loading) {
  auto& kept = mechanics_[{zones, loading}];
  if (!kept) {
    const Specimen& s = specimen(zones);
    kept = loaded(
        std::make_unique<pyroclast::Mechanics<2>>(s.model, s.densities, s.properties, s.parameters, team_), s,
        loading, velocity_);
  }
  return *kept;
}

textbook::Body& Bodies::textbook(int zones, Loading loading) {
  auto& kept = textbook_[{zones, loading}];
  if (!kept) {
    const Specimen& s = specimen(zones);
    kept = loaded(std::make_unique<textbook::Body>(s.model, s.densities, s.properties, s.parameters), s,
                  loading, velocity_);
  }
  return *kept;
}

const StepCost& Bodies::step_cost(int zones, Loading loading) {
  auto& kept = costs_[{zones, loading}];
  if (!kept) kept = std::make_unique<StepCost>(bench::step_cost(mechanics(zones, loading)));
  return *kept;
}

}  // namespace bench
