#include "pyroclast/simulation/moisture_field.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

/// Halvings of the range in which a humidity is searched for.
constexpr int kHalvings = 60;

constexpr StateRule kAmounts = state::within(0.0, 1e12);  // kg/m3, Pa

/// Applies the boundaries of a deck. Throws Error where two act on one face.
template <int Dim>
void apply_water(const ModelOf<Dim>& model, const std::vector<OutlineFace<Dim>>& outline,
                 const std::vector<MoistureBoundaryCondition>& boundaries, Moisture& moisture) {
  std::vector<bool> meets_bearing(model.gridpoint_count());
  for (int c = 0; c < model.contact_count(); ++c)
    if (const Joint& joint = model.joint(c); model.is_of_bearing(joint))
      meets_bearing[joint.a] = meets_bearing[joint.b] = true;
  std::vector<const MoistureBoundaryCondition*> on_face(outline.size());
  for (const MoistureBoundaryCondition& boundary : boundaries) {
    try {
      std::vector<int> faces = faces_of(model, outline, boundary.faces);
      std::erase_if(faces, [&](int face) {
        return std::ranges::all_of(outline[face].gridpoints, [&](int g) { return meets_bearing[g]; });
      });
      if (faces.empty()) throw Error("has no effect: bearings lie on all of these faces and seal them");
      for (const int face : faces) {
        if (on_face[face])
          throw Error(fmt::format("acts on faces that have {} already", on_face[face]->place));
        on_face[face] = &boundary;
      }
      if (boundary.condition) moisture.apply(faces, *boundary.condition);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", boundary.place, error.what()));
    }
  }
}

}  // namespace

PoreMaterial pores_of_matrix(PoreMaterial concrete, double inclusions, int dimension) {
  const double matrix = 1.0 - inclusions;
  concrete.porosity /= matrix;
  concrete.cement /= matrix;
  concrete.permeability *= dimension == 2 ? (1.0 + inclusions) / matrix : (2.0 + inclusions) / (2.0 * matrix);
  return concrete;
}

void require_one_process(int ranks) {
  if (ranks > 1)
    throw Error("[moisture]: one process alone lets water flow: leave --mpi out, and give it more --threads");
}

MoistureField::MoistureField(const Model& model, const std::vector<BlockMaterial>& block_materials,
                             const SpecimenNumbers& numbers, const MoistureConditions& conditions,
                             double temperature)
    : model_(model), zone_volumes_(model.zone_volumes()) {
  require_one_process(model.ranks().count());
  std::vector<std::optional<PoreMaterial>> pores(block_materials.size());
  std::vector<bool> takes_part(block_materials.size());
  for (std::size_t m = 0; m < conditions.pores.size(); ++m) {
    const StatedPores& stated = conditions.pores[m];
    pores[m] = stated.of_concrete
                   ? pores_of_matrix(stated.material, 1.0 - numbers.fraction[m], model.dimension())
                   : stated.material;
    takes_part[m] = true;
    if (!(pores[m]->porosity < 1.0))
      throw Error(
          fmt::format("materials.{}.moisture.porosity: the concrete's cannot all be in {:.3g} of its "
                      "volume",
                      block_materials[m].name, numbers.fraction[m]));
  }
  with_dimension(model, [&]<int Dim>(const ModelOf<Dim>& of_dimension) {
    const ZoneGeometry<Dim> geometry = zone_geometry(of_dimension);
    const auto faces = outline(of_dimension, geometry, takes_part);
    moisture_.emplace(moisture_mesh(of_dimension, geometry, takes_part, faces), pores, conditions.parameters);
    apply_water(of_dimension, faces, conditions.boundaries, *moisture_);
  });
  start(conditions, block_materials, numbers.fraction, temperature);
  saturation_ = moisture_->saturation();
}

void MoistureField::start(const MoistureConditions& conditions,
                          const std::vector<BlockMaterial>& block_materials,
                          const std::vector<double>& fraction, double temperature) {
  if (conditions.first == FirstWater::saturation)
    return moisture_->start_with_saturation(conditions.first_amount, temperature);
  const double saturated = water::saturation_pressure(temperature);
  if (conditions.first == FirstWater::humidity)
    return moisture_->start_with_pressure(conditions.first_amount * saturated, temperature);
  double dry = 0.0;  // density of the concrete, kg/m3
  for (std::size_t m = 0; m < fraction.size(); ++m)
    dry += fraction[m] * block_materials[m].density(kReferenceTemperature);
  const double wanted = conditions.first_amount * dry;
  double volume = 0.0;
  for (const double of_cell : moisture_->mesh().volume) volume += of_cell;
  const auto held = [&](double humidity) {
    moisture_->start_with_pressure(humidity * saturated, temperature);
    return moisture_->stored() / volume;
  };
  if (const double most = held(1.0); wanted > most)
    throw Error(fmt::format("moisture.initial.content: the pores hold {:.3g} % of the dry mass at most",
                            100.0 * most / dry));
  double low = 0.0, high = 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (held(middle) < wanted ? low : high) = middle;
  }
  held(high);
}

std::vector<double> MoistureField::temperatures_of_cells(const TemperatureField& temperatures) const {
  std::vector<double> means;
  means.reserve(moisture_->mesh().block.size());
  for (const int block : moisture_->mesh().block) {
    double sum = 0.0, volume = 0.0;
    for (int z = model_.block_zones[block]; z < model_.block_zones[block + 1]; ++z) {
      sum += zone_volumes_[z] * temperatures.zones()[z];
      volume += zone_volumes_[z];
    }
    means.push_back(sum / volume);
  }
  return means;
}

void MoistureField::follow(const TemperatureField& temperatures) {
  const double duration = temperatures.time() - moisture_->state().time;
  if (!(duration > 0.0)) return;
  moisture_->advance(duration, temperatures_of_cells(temperatures));
  saturation_ = moisture_->saturation();
}

double MoistureField::pore_pressure(int block) const {
  return std::max(0.0, of_block(water().state().pressure, block) - water::kAtmosphere);
}

double MoistureField::largest_pore_pressure() const {
  return std::max(0.0, std::ranges::max(water().state().pressure) - water::kAtmosphere);
}

double MoistureField::largest_pressure_ratio() const {
  return std::ranges::max(water().pressure_ratio());
}

void MoistureField::visit_state(StateVisitor& visitor) {
  MoistureState s = water().state();
  const auto cells = s.content.size();
  visitor.visit("time", s.time);
  visitor.visit("next_step", s.next_step);
  visitor.visit("content", s.content, kAmounts.of(cells));
  visitor.visit("pressure", s.pressure, kAmounts.of(cells));
  visitor.visit("temperature", s.temperature, kTemperatures.of(cells));
  visitor.visit("highest_temperature", s.highest_temperature, kTemperatures.of(cells));
  visitor.visit("at_start", s.ledger.at_start);
  visitor.visit("released", s.ledger.released);
  visitor.visit("left", s.ledger.left);
  visitor.visit("steps", s.steps, state::count());
  visitor.visit("retries", s.retries, state::count());
  visitor.visit("iterations", s.iterations, state::count());
  if (!visitor.replaces()) return;
  moisture_->go_on_from(std::move(s));
  saturation_ = moisture_->saturation();
}

}  // namespace pyroclast
