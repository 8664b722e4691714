#include "pyroclast/simulation/moisture_field.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/simulation/contact_gaps.hpp"

namespace pyroclast {

namespace {

/// Halvings of the range in which a humidity is searched for.
constexpr int kHalvings = 60;

/// Largest factor by which a crack widens or narrows at once for the water.
constexpr double kWiderAtOnce = 2.0;
/// Width beyond which a crack passes no more, m: its pressure is that of the outside long before.
constexpr double kWidest = 1e-3;
/// Factor from one interval between exchanges to the next, and the shortest interval, s.
constexpr double kLonger = 2.0, kShortest = 0.05;

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
    : model_(model), coupling_(conditions.coupling), zone_volumes_(model.zone_volumes()) {
  require_one_process(model.ranks().count());
  std::vector<std::optional<PoreMaterial>> pores(block_materials.size());
  std::vector<bool> has_pores(block_materials.size());
  for (std::size_t m = 0; m < conditions.pores.size(); ++m) {
    const StatedPores& stated = conditions.pores[m];
    pores[m] = stated.of_concrete
                   ? pores_of_matrix(stated.material, 1.0 - numbers.fraction[m], model.dimension())
                   : stated.material;
    has_pores[m] = true;
    is_matrix_.push_back(stated.of_concrete);
    if (!(pores[m]->porosity < 1.0))
      throw Error(
          fmt::format("materials.{}.moisture.porosity: the concrete's cannot all be in {:.3g} of its "
                      "volume",
                      block_materials[m].name, numbers.fraction[m]));
  }
  takes_part_ = blocks_of(model, has_pores);
  with_dimension(model, [&]<int Dim>(const ModelOf<Dim>& of_dimension) {
    const ZoneGeometry<Dim> geometry = zone_geometry(of_dimension);
    const auto faces = outline(of_dimension, geometry, takes_part_);
    moisture_.emplace(moisture_mesh(of_dimension, geometry, takes_part_, faces), pores,
                      conditions.parameters);
    face_contacts_.assign(of_dimension.face_contacts.begin(), of_dimension.face_contacts.end());
    apply_water(of_dimension, faces, conditions.boundaries, *moisture_);
  });
  list_faces();
  seen_opening_.resize(face_of_.size());
  start(conditions, block_materials, numbers.fraction, temperature);
  see_state();
}

void MoistureField::list_faces() {
  face_of_.clear();
  for (std::size_t f = 0; f < mesh().cell_face.size(); ++f)
    if (mesh().cell_face[f] >= 0) face_of_.push_back(static_cast<int>(f));
}

void MoistureField::remove(const std::vector<int>& blocks) {
  std::vector<double> opening_of_face(mesh().cell_face.size());
  for (std::size_t f = 0; f < face_of_.size(); ++f) opening_of_face[face_of_[f]] = seen_opening_[f];
  with_dimension(model_, [&]<int Dim>(const ModelOf<Dim>& of_dimension) {
    const ZoneGeometry<Dim> geometry = zone_geometry(of_dimension);
    const auto earlier = outline(of_dimension, geometry, takes_part_);
    for (const int block : blocks) takes_part_[block] = false;
    const auto now = outline(of_dimension, geometry, takes_part_);
    moisture_->reduce_to(moisture_mesh(of_dimension, geometry, takes_part_, now),
                         earlier_faces(earlier, now));
  });
  list_faces();
  seen_opening_.clear();
  for (const int face : face_of_) seen_opening_.push_back(opening_of_face[face]);
  see_state();
}

/// Takes over what follows from the state of the water.
void MoistureField::see_state() {
  face_pressure_.clear();
  for (int f = 0; f < std::ssize(face_of_); ++f) face_pressure_.push_back(gauge(moisture_->face_pressure(f)));
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
  const std::vector<double> before = water().state().pressure;
  moisture_->advance(duration, temperatures_of_cells(temperatures));
  see_state();
  if (coupling_.acts == PressureActs::no) return;
  double change = 0.0;
  for (std::size_t c = 0; c < before.size(); ++c)
    change = std::max(change, std::abs(gauge(water().state().pressure[c]) - gauge(before[c])));
  interval_ *= kLonger;
  if (change > 0.0) interval_ = std::min(interval_, duration * coupling_.exchange_pressure / change);
  interval_ = std::max(interval_, kShortest);
}

void MoistureField::hurry() {
  interval_ = kShortest;
}

/// Returns the mean opening of a face of the mesh, m, where points that press count as closed.
/// \param of_contacts  openings of its contacts, out
double MoistureField::opening(const Motion& motion, int face, std::vector<double>* of_contacts) const {
  double area = 0.0, sum = 0.0;
  if (of_contacts) of_contacts->clear();
  for (int c = face_contacts_[face_of_[face]]; c < face_contacts_[face_of_[face] + 1]; ++c) {
    const double open = std::max(0.0, motion.read().opening(c)), of_contact = model_.joint(c).area;
    if (of_contacts) of_contacts->push_back(open);
    area += of_contact;
    sum += of_contact * open;
  }
  return sum / area;
}

void MoistureField::show_cracks(const Motion& motion) {
  std::vector<double> before(face_of_.size()), openings;
  for (const OpenFace& crack : water().state().cracks) before[crack.face] = crack.width;
  std::vector<OpenFace> cracks;
  for (int f = 0; f < std::ssize(face_of_); ++f) {
    const double opens = seen_opening_[f] = opening(motion, f, &openings);
    const double last = std::max(before[f], coupling_.crack_width);
    const double width = std::clamp(std::min(opens, kWidest), last / kWiderAtOnce, last * kWiderAtOnce);
    if (width < coupling_.crack_width || (before[f] == 0.0 && opens < coupling_.crack_width)) continue;
    OpenFace crack{f, width, {}};
    const CellFace& face = mesh().faces[f];
    const int first = face_contacts_[face_of_[f]];
    for (int e = face.first_end; e < face.first_end + face.end_count; ++e) {
      const auto [a, b] = mesh().ends[e].contacts;
      const double there = 0.5 * (openings[a - first] + openings[b - first]);
      crack.at_ends.push_back(opens > 0.0 ? there * (width / opens) : 0.0);
    }
    cracks.push_back(std::move(crack));
  }
  if (cracks.empty() && water().state().cracks.empty()) return;
  moisture_->set_cracks(std::move(cracks));
  see_state();
}

bool MoistureField::is_outrun_by_cracks(const Motion& motion) const {
  if (coupling_.acts != PressureActs::all) return false;
  for (int f = 0; f < std::ssize(face_of_); ++f)
    if (face_pressure_[f] > 0.0 &&
        opening(motion, f) > kWiderAtOnce * std::max(seen_opening_[f], coupling_.crack_width))
      return true;
  return false;
}

std::optional<PorePressures> MoistureField::pressures(const Motion* motion) const {
  if (coupling_.acts == PressureActs::no) return std::nullopt;
  PorePressures found;
  for (int b = 0; b < model_.block_count(); ++b) found.of_blocks.push_back(coupling_.biot * pore_pressure(b));
  if (coupling_.acts == PressureActs::zones) return found;
  found.of_contacts.resize(model_.contact_count());
  if (std::isfinite(coupling_.reserve)) {
    found.reserve = coupling_.reserve;
    found.at_openings.resize(model_.contact_count());
    for (int c = 0; motion && c < model_.contact_count(); ++c)
      found.at_openings[c] = motion->read().opening(c);
  }
  for (int c = 0; c < model_.contact_count(); ++c) found.of_contacts[c] = borne_pressure(motion, c);
  return found;
}

int MoistureField::pocket_blocks() const {
  const auto is_matrix = [&](int cell) { return is_matrix_[mesh().material[cell]]; };
  std::vector<bool> drains(mesh().volume.size());
  for (std::size_t f = 0; f < mesh().outer_faces.size(); ++f)
    if (water().opens(static_cast<int>(f))) drains[mesh().outer_faces[f].cell] = true;
  for (bool grows = true; grows;) {
    grows = false;
    for (const CellFace& face : mesh().faces) {
      const auto [a, b] = face.cells;
      if (drains[a] == drains[b] || !is_matrix(a) || !is_matrix(b)) continue;
      drains[a] = drains[b] = grows = true;
    }
  }
  int pockets = 0;
  for (int c = 0; c < mesh().cell_count(); ++c) pockets += is_matrix(c) && !drains[c] ? 1 : 0;
  return pockets;
}

double MoistureField::pore_pressure(int block) const {
  return gauge(of_block(water().state().pressure, block));
}

double MoistureField::contact_pressure(int contact) const {
  const int face = mesh().cell_face[model_.joint(contact).face];
  return face < 0 ? 0.0 : face_pressure_[face];
}

double MoistureField::borne_pressure(const Motion* motion, int contact) const {
  const double pressure = contact_pressure(contact);
  if (pressure == 0.0) return 0.0;
  const double damage = motion ? damage_in_tension(*motion, contact) : 0.0;
  return (coupling_.biot + (1.0 - coupling_.biot) * damage) * pressure;
}

double MoistureField::largest_pore_pressure() const {
  return gauge(std::ranges::max(water().state().pressure));
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
  visitor.visit("removed", s.ledger.removed);
  visitor.visit("steps", s.steps, state::count());
  visitor.visit("retries", s.retries, state::count());
  visitor.visit("iterations", s.iterations, state::count());
  visit_cracks(visitor, s);
  visitor.visit("seen_opening", seen_opening_, state::at_least(0.0).of(seen_opening_.size()));
  visitor.visit("interval", interval_, state::number());
  if (!visitor.replaces()) return;
  moisture_->go_on_from(std::move(s));
  see_state();
}

void MoistureField::visit_cracks(StateVisitor& visitor, MoistureState& s) const {
  std::vector<int> faces;
  std::vector<double> widths, at_ends;
  for (const OpenFace& crack : s.cracks) {
    faces.push_back(crack.face);
    widths.push_back(crack.width);
    at_ends.insert(at_ends.end(), crack.at_ends.begin(), crack.at_ends.end());
  }
  visitor.visit("cracks", faces, state::index(face_of_.size()));
  visitor.visit("crack_widths", widths, state::within(0.0, 1.0).of(faces.size()));
  std::size_t ends = 0;
  for (const int face : faces) ends += mesh().faces[face].end_count;
  visitor.visit("crack_ends", at_ends, state::within(0.0, 1e6).of(ends));
  visitor.visit("crack_water", s.crack_water, kAmounts.of(faces.size()));
  visitor.visit("crack_pressure", s.crack_pressure, kAmounts.of(faces.size()));
  if (!visitor.replaces()) return;
  s.cracks.clear();
  auto end = at_ends.begin();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    visitor.require(widths[i] > 0.0 && (i == 0 || faces[i] > faces[i - 1]), "cracks",
                    "must come by ascending face, and stand open");
    const int count = mesh().faces[faces[i]].end_count;
    s.cracks.push_back({faces[i], widths[i], {end, end + count}});
    end += count;
  }
}

}  // namespace pyroclast
