#include "bodies.hpp"

#include <algorithm>
#include <cmath>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/place_in.hpp"
#include "pyroclast/deck/deck.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/simulation/coupling.hpp"
#include "pyroclast/specimen/laguerre.hpp"
#include "pyroclast/specimen/spaced_seeds.hpp"
#include "pyroclast/stages/compress.hpp"

namespace bench {

using pyroclast::Error;
using pyroclast::Setup;
using pyroclast::Vec;

namespace {

/// Mean of specimens of 1,000 to 100,000 blocks (docs/develop/performance.md).
constexpr double kZonesPerBlock = 5.4;
/// Axial strain that is imposed, and the steps in which.
constexpr double kIntactStrain = 1e-4, kCrackedStrain = 5e-3;
constexpr int kIntactSteps = 100, kCrackedSteps = 400;
/// Steps at the platen velocity of the deck before anything is timed.
constexpr int kStepsAtRest = 100;
constexpr double kEdgeOfCube = 0.1;  // m
constexpr double kSpreadOfRadii = 0.3;

Setup read(const std::filesystem::path& path) {
  return pyroclast::read_setup(pyroclast::Deck::open(path), path.parent_path());
}

/// Gives a sample its properties at the reference temperature.
/// \param block_size  m
template <int Dim>
void add_properties(Sample<Dim>& sample, const Setup& setup, double block_size) {
  sample.parameters = setup.moving->mechanics;
  const auto materials = pyroclast::make_concrete(setup.block_materials, setup.moving->contacts, block_size);
  const pyroclast::TemperatureField field(sample.model, pyroclast::kReferenceTemperature);
  sample.properties =
      pyroclast::properties_at(sample.model, materials, field, {sample.model, materials, field});
  for (const auto& material : materials.block_materials)
    sample.densities.push_back(material.density(pyroclast::kReferenceTemperature));
}

std::unique_ptr<Sample<2>> make_specimen(const Setup& setup, int zones) {
  auto parameters = setup.specimen;
  parameters.blocks.count = static_cast<int>(std::lround(zones / kZonesPerBlock));
  const auto made = pyroclast::specimen::make_specimen(parameters);
  const auto& box = made.outline.box();
  auto sample = std::make_unique<Sample<2>>();
  sample->model =
      pyroclast::make_model(made, setup.thickness, setup.moving->contacts.interfaces, setup.moving->bearings);
  sample->size = {{box.width(), box.height()}};
  const auto& model = sample->model;
  for (const char* const platen : {"bottom_platen", "top_platen"})
    sample->ends.insert(sample->ends.end(), model.set(platen).begin(), model.set(platen).end());
  sample->held = model.set("bottom_platen_support");
  sample->driven = model.set("top_platen_support");
  add_properties(*sample, setup, made.metrics.mean_size);
  return sample;
}

std::unique_ptr<Sample<3>> make_cube(const Setup& setup, int blocks) {
  const pyroclast::specimen::Prism body(pyroclast::specimen::Region::rectangle(kEdgeOfCube, kEdgeOfCube),
                                        pyroclast::specimen::Prism::Axis::z, kEdgeOfCube);
  pyroclast::Random random(1);
  const auto result =
      pyroclast::specimen::laguerre_cells(spaced_seeds(body, blocks, kSpreadOfRadii, random), body);
  if (!result.broken.empty()) throw Error("a cell of the cube is empty or does not match its neighbours");
  auto sample = std::make_unique<Sample<3>>();
  sample->size = {{kEdgeOfCube, kEdgeOfCube, kEdgeOfCube}};
  auto& model = sample->model;
  model.material_names = pyroclast::specimen::phases(setup.specimen);
  const pyroclast::InterfaceTable interfaces(model.material_names, setup.moving->contacts.interfaces);
  model.interface_names = interfaces.names();
  const int matrix = pyroclast::place_in(model.material_names, setup.specimen.matrix);
  add_cells(model, result.cells, std::vector<int>(blocks, matrix),
            [of_matrix = interfaces.between(matrix, matrix)](int, int) { return of_matrix; });
  for (int g = 0; g < model.gridpoint_count(); ++g) {
    if (model.position[g][1] == 0.0) sample->held.push_back(g);
    if (model.position[g][1] == kEdgeOfCube) sample->driven.push_back(g);
  }
  sample->ends = sample->held;
  sample->ends.insert(sample->ends.end(), sample->driven.begin(), sample->driven.end());
  add_properties(*sample, setup, kEdgeOfCube / std::cbrt(blocks));
  return sample;
}

/// Gives every gridpoint the velocity of a uniform compression, so that no wave has to run through the
/// sample, and lets it go, but for its ends: rate in 1/s.
template <int Dim, class Body>
void start_compression(Body& body, const Sample<Dim>& sample, double rate) {
  constexpr double kPoisson = 0.2;
  constexpr int kUp = 1;
  const auto& x = sample.model.position;
  const int gridpoints = sample.model.gridpoint_count();
  for (int g = 0; g < gridpoints; ++g)
    for (int i = 0; i < Dim; ++i)
      body.constraints().prescribe_velocity(g, i,
                                            i == kUp ? -rate * std::clamp(x[g][i], 0.0, sample.size[i])
                                                     : kPoisson * rate * (x[g][i] - 0.5 * sample.size[i]));
  for (int g : sample.ends)
    for (int i = 0; i < Dim; ++i)
      if (i != kUp) body.constraints().prescribe_velocity(g, i, 0.0);
  body.advance(1);
  for (int g = 0; g < gridpoints; ++g)
    for (int i = 0; i < Dim; ++i) body.constraints().release(g, i);
  for (int g : sample.held)
    for (int i = 0; i < Dim; ++i) body.constraints().prescribe_velocity(g, i, 0.0);
  for (int g : sample.driven)
    for (int i = 0; i < Dim; ++i)
      body.constraints().prescribe_velocity(g, i, i == kUp ? -rate * sample.size[i] : 0.0);
}

/// A fast compression to a strain, then on at the velocity of the deck.
template <int Dim, class Body>
std::unique_ptr<Body> loaded(std::unique_ptr<Body> body, const Sample<Dim>& sample, Loading loading,
                             double velocity) {
  const bool cracked = loading == Loading::cracked;
  const int steps = cracked ? kCrackedSteps : kIntactSteps;
  const double strain = cracked ? kCrackedStrain : kIntactStrain;
  start_compression(*body, sample, strain / (steps * body->time_step()));
  body->advance(steps - 1);
  start_compression(*body, sample, velocity / sample.size[1]);
  body->advance(kStepsAtRest);
  return body;
}

}  // namespace

const char* name(Loading loading) {
  return loading == Loading::intact ? "intact" : "cracked";
}

Deck::Deck(const std::filesystem::path& path) : setup_(read(path)) {
  if (!setup_.moving) throw Error("the bench needs the deck of a specimen between platens");
}

double Deck::velocity() const {
  for (const auto& stage : setup_.stages)
    if (const auto* compress = dynamic_cast<const pyroclast::Compress*>(stage.get()))
      return compress->velocity();
  throw Error("the bench needs the deck of a compression");
}

Bodies<2> Deck::specimens() const {
  return {[this](int zones) { return make_specimen(setup_, zones); }, velocity()};
}

Bodies<3> Deck::cubes() const {
  return {[this](int blocks) { return make_cube(setup_, blocks); }, velocity()};
}

template <int Dim>
const Sample<Dim>& Bodies<Dim>::sample(int size) {
  auto& kept = samples_[size];
  if (!kept) kept = make_(size);
  return *kept;
}

template <int Dim>
pyroclast::Mechanics<Dim>& Bodies<Dim>::mechanics(int size, Loading loading) {
  auto& kept = mechanics_[{size, loading}];
  if (!kept) {
    const Sample<Dim>& s = sample(size);
    kept = loaded(
        std::make_unique<pyroclast::Mechanics<Dim>>(s.model, s.densities, s.properties, s.parameters, team_),
        s, loading, velocity_);
  }
  return *kept;
}

template <int Dim>
textbook::Body<Dim>& Bodies<Dim>::textbook(int size, Loading loading) {
  auto& kept = textbook_[{size, loading}];
  if (!kept) {
    const Sample<Dim>& s = sample(size);
    kept = loaded(std::make_unique<textbook::Body<Dim>>(s.model, s.densities, s.properties, s.parameters), s,
                  loading, velocity_);
  }
  return *kept;
}

template <int Dim>
const StepCost& Bodies<Dim>::step_cost(int size, Loading loading) {
  auto& kept = costs_[{size, loading}];
  if (!kept) kept = std::make_unique<StepCost>(bench::step_cost(mechanics(size, loading)));
  return *kept;
}

template class Bodies<2>;
template class Bodies<3>;

}  // namespace bench
