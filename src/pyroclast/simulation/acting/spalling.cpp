#include "pyroclast/simulation/acting/spalling.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/disjoint_sets.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/model/outline.hpp"
#include "pyroclast/model/sets.hpp"
#include "pyroclast/simulation/contact_gaps.hpp"
#include "pyroclast/simulation/moisture_field.hpp"

namespace pyroclast {

namespace {

/// Opening up to which a point under compression is pressed, m.
constexpr double kPressed = 1e-6;
/// Share of the rim's edges that counts as `rim_opening` does.
constexpr double kShareOfEdge = 0.05;

/// Returns the length of the edge of a contact's face, m: in the plane a face has two points, in space the
/// extent of a point is about the square of an edge.
double edge_of(const Model& model, int contact) {
  return model.dimension() == 2 ? 2.0 * model.extent(contact) : std::sqrt(model.extent(contact));
}

bool holds(const Motion& motion, int contact, double bond) {
  const double lost = largest_damage(motion, contact);
  if (lost >= 0.0 && lost < 1.0 - bond) return true;
  const ContactState state = motion.read().contact(contact);
  if (lost < 0.0) return state.normal_traction != 0.0 || norm(state.shear_traction) != 0.0;
  // sides that have slid past each other press only because contacts are those of the start
  return state.normal_traction < 0.0 && state.opening < kPressed &&
         norm(state.tangential_jump) < edge_of(motion.model(), contact);
}

/// Sums over the contacts between a part of a body and the others.
struct Rim {
  double area = 0.0, opening = 0.0, way = 0.0, edge = 0.0;
};

}  // namespace

std::string name_of_bar(double depth) {
  return fmt::format("{:.6g}mm", depth * 1e3);
}

Spalling::Spalling(const Model& model, const std::vector<BlockMaterial>& block_materials,
                   const HeatConditions& heat, const SpallingRule& rule)
    : model_(model), rule_(rule), block_of_(gridpoint_blocks(model)) {
  if (model.ranks().count() > 1)
    throw Error("[spalling]: one process alone lets pieces go: leave --mpi out, and give it more --threads");
  const std::vector<double> volumes = model.zone_volumes();
  std::vector<bool> takes_part;
  for (int b = 0; b < model.block_count(); ++b) {
    takes_part.push_back(!model.is_of_bearing(b));
    double volume = 0.0;
    if (takes_part[b])
      for (int z = model.block_zones[b]; z < model.block_zones[b + 1]; ++z) volume += volumes[z];
    block_volume_.push_back(volume);
    volume_ += volume;
    block_density_.push_back(block_materials[model.block_material[b]].density(kReferenceTemperature));
  }
  is_gone_.resize(block_volume_.size());
  is_outside_.resize(block_volume_.size());
  with_dimension(model, [&]<int Dim>(const ModelOf<Dim>& of_dimension) {
    const auto faces = outline(of_dimension, zone_geometry(of_dimension), takes_part);
    std::vector<bool> is_hot(faces.size());
    bool any = false;
    const std::vector<bool> is_fire = are_fires(heat);
    for (std::size_t i = 0; i < is_fire.size(); ++i) {
      if (!is_fire[i]) continue;
      for (const int face : faces_of(of_dimension, faces, heat.boundaries[i].faces))
        is_hot[face] = any = true;
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto lies_in = [&](const PlaneOfSymmetry& plane) {
        return std::ranges::all_of(faces[f].gridpoints,
                                   [&](int g) { return is_mirrored(g, plane.component); });
      };
      if (std::ranges::any_of(model_.symmetry, lies_in)) continue;
      is_outside_[block_of_[faces[f].gridpoints[0]]] = true;
      if (!is_hot[f] && any) continue;
      hot_faces_.push_back({resized<3>(faces[f].centre), resized<3>(faces[f].normal), faces[f].area});
      hot_area_ += faces[f].area;
    }
  });
  const auto specimen_blocks = static_cast<double>(std::ranges::count(takes_part, true));
  const double of_a_block = volume_ / model.thickness / specimen_blocks;
  const double size = model.dimension() == 2 ? std::sqrt(of_a_block) : std::cbrt(of_a_block);
  at_bar_.resize(rule_.bars.size());
  for (int g = 0; g < model.gridpoint_count() && !at_bar_.empty(); ++g) {
    if (!takes_part[block_of_[g]]) continue;
    const double d = depth(model.place(g));
    for (std::size_t bar = 0; bar < at_bar_.size(); ++bar)
      if (std::abs(d - rule_.bars[bar]) < 0.5 * size) at_bar_[bar].push_back(g);
  }
  for (std::size_t bar = 0; bar < at_bar_.size(); ++bar)
    if (at_bar_[bar].empty())
      throw Error(fmt::format("{}: no block lies {:.6g} mm below the faces that fire acts on",
                              rule_.bars_place, 1e3 * rule_.bars[bar]));
}

double Spalling::temperature_at(std::size_t bar, const TemperatureField& field) const {
  double sum = 0.0, count = 0.0;
  for (const int g : at_bar_[bar]) {
    if (std::isnan(field.gridpoints()[g])) continue;  // of a block that has left
    sum += field.gridpoints()[g];
    count += 1.0;
  }
  return sum / count;
}

std::optional<double> Spalling::bare_from(std::size_t bar) const {
  for (const Spall& spall : spalls_)
    if (spall.largest_depth >= rule_.bars[bar]) return spall.heating_time;
  return std::nullopt;
}

const Spalling::HotFace& Spalling::nearest(const Vec<3>& place) const {
  return *std::ranges::min_element(hot_faces_, {}, [&](const HotFace& f) { return norm(f.centre - place); });
}

double Spalling::depth(const Vec<3>& place) const {
  const HotFace& face = nearest(place);
  return std::max(0.0, dot(face.normal, face.centre - place));
}

/// Tells whether a bearing, or a gridpoint that is held or driven, belongs to a block. A plane of symmetry
/// holds none: a piece leaves together with its image behind it.
bool Spalling::is_held(const Motion& motion, int block) const {
  if (model_.is_of_bearing(block)) return true;
  for (int g = model_.block_gridpoints[block]; g < model_.block_gridpoints[block + 1]; ++g)
    for (int i = 0; i < model_.dimension(); ++i)
      if (motion.read().is_prescribed(g, i) && !is_mirrored(g, i)) return true;
  return false;
}

bool Spalling::is_mirrored(int gridpoint, int component) const {
  return std::ranges::any_of(model_.symmetry, [&](const PlaneOfSymmetry& plane) {
    return plane.component == component && std::ranges::binary_search(model_.set(plane.set()), gridpoint);
  });
}

std::vector<Spalling::Leaving> Spalling::leaving(const Motion& motion) const {
  const int blocks = model_.block_count();
  DisjointSets parts(blocks);
  const auto sides = [&](int contact) {
    const Joint& joint = model_.joint(contact);
    return std::pair(block_of_[joint.a], block_of_[joint.b]);
  };
  for (int c = 0; c < model_.contact_count(); ++c) {
    const auto [a, b] = sides(c);
    if (is_gone_[a] || is_gone_[b] || parts.first_of(a) == parts.first_of(b)) continue;
    if (holds(motion, c, rule_.bond)) parts.join(a, b);
  }
  for (const FoundPoint& point : motion.found_points())
    if (point.normal_traction < 0.0) parts.join(point.blocks[0], point.blocks[1]);
  std::vector<bool> stays(blocks), is_outside(blocks);
  std::vector<double> volume(blocks);
  for (int b = 0; b < blocks; ++b) {
    if (is_gone_[b]) continue;
    const int part = parts.first_of(b);
    volume[part] += block_volume_[b];
    is_outside[part] = is_outside[part] || is_outside_[b];
    stays[part] = stays[part] || is_held(motion, b);
  }
  // a body without load may hover between its platens
  stays[std::ranges::max_element(volume) - volume.begin()] = true;
  const auto is_loose = [&](int block) { return !is_gone_[block] && !stays[parts.first_of(block)]; };
  std::map<int, Rim> rims;
  for (int c = 0; c < model_.contact_count(); ++c) {
    const auto [a, b] = sides(c);
    if (is_gone_[a] || is_gone_[b] || parts.first_of(a) == parts.first_of(b)) continue;
    if (!is_loose(a) && !is_loose(b)) continue;
    const Joint& joint = model_.joint(c);
    const double way = norm(motion.read().displacement(joint.b) - motion.read().displacement(joint.a));
    const double edge = edge_of(model_, c);
    for (const int block : {a, b}) {
      if (!is_loose(block)) continue;
      Rim& rim = rims[parts.first_of(block)];
      rim.area += joint.area;
      rim.opening += joint.area * motion.read().opening(c);
      rim.way += joint.area * way;
      rim.edge += joint.area * edge;
    }
  }
  std::vector<Leaving> found;
  std::map<int, std::size_t> place;
  for (const auto& [part, rim] : rims) {
    const double far = std::min(rule_.rim_opening * rim.area, kShareOfEdge * rim.edge);
    if (!(rim.way > (is_outside[part] ? far : rim.edge))) continue;
    place[part] = found.size();
    found.push_back({{}, rim.opening > far ? SpallSign::opening : SpallSign::flight});
  }
  if (found.empty()) return found;
  for (int b = 0; b < blocks; ++b)
    if (const auto at = place.find(parts.first_of(b)); at != place.end() && !is_gone_[b])
      found[at->second].blocks.push_back(b);
  return found;
}

std::vector<Spall> Spalling::find(const Motion& motion, const TemperatureField& field,
                                  const MoistureField* moisture) const {
  std::vector<Spall> spalls;
  for (Leaving& piece : leaving(motion)) spalls.push_back(describe(std::move(piece), field, moisture));
  return spalls;
}

Spall Spalling::describe(Leaving piece, const TemperatureField& field, const MoistureField* moisture) const {
  Spall spall;
  spall.blocks = std::move(piece.blocks);
  spall.sign = piece.sign;
  std::vector<bool> is_of_piece(is_gone_.size());
  for (const int block : spall.blocks) {
    is_of_piece[block] = true;
    spall.volume += block_volume_[block];
    spall.mass += block_volume_[block] * block_density_[block];
    for (int g = model_.block_gridpoints[block]; g < model_.block_gridpoints[block + 1]; ++g)
      spall.largest_depth = std::max(spall.largest_depth, depth(model_.place(g)));
  }
  double rim = 0.0;
  for (int c = 0; c < model_.contact_count(); ++c) {
    const Joint& joint = model_.joint(c);
    const int a = block_of_[joint.a], b = block_of_[joint.b];
    if (is_of_piece[a] == is_of_piece[b] || is_gone_[a] || is_gone_[b]) continue;
    const Vec<3> place = model_.place(joint.a), out = model_.normal(c) * (is_of_piece[a] ? 1.0 : -1.0);
    const double seen = std::max(0.0, -dot(out, nearest(place).normal)) * joint.area;
    spall.area += seen;
    spall.mean_depth += seen * depth(place);
    spall.temperature += joint.area * field.contacts()[c];
    rim += joint.area;
    if (moisture) spall.pressure = std::max(spall.pressure, moisture->pore_pressure(is_of_piece[a] ? b : a));
  }
  if (spall.area > 0.0) spall.mean_depth /= spall.area;
  if (rim > 0.0) spall.temperature /= rim;
  return spall;
}

void Spalling::note(Spall spall) {
  for (const int block : spall.blocks) is_gone_[block] = true;
  for (int c = 0; c < model_.contact_count(); ++c) {
    const int a = block_of_[model_.joint(c).a], b = block_of_[model_.joint(c).b];
    if (is_gone_[a] != is_gone_[b]) is_outside_[is_gone_[a] ? b : a] = true;
  }
  spalls_.push_back(std::move(spall));
}

std::int64_t Spalling::blocks_gone() const {
  return std::ranges::count(is_gone_, true);
}

double Spalling::mass_gone() const {
  double mass = 0.0;
  for (const Spall& spall : spalls_) mass += spall.mass;
  return mass;
}

double Spalling::lost_section() const {
  double volume = 0.0;
  for (const Spall& spall : spalls_) volume += spall.volume;
  return volume / volume_;
}

double Spalling::mean_depth() const {
  return lost_section() * volume_ / hot_area_;
}

double Spalling::largest_depth() const {
  double depth = 0.0;
  for (const Spall& spall : spalls_) depth = std::max(depth, spall.largest_depth);
  return depth;
}

void Spalling::visit_state(StateVisitor& visitor) {
  std::vector<int> counts, blocks, signs;
  std::vector<double> numbers;
  const auto each_number = [](Spall& s, auto f) {
    for (double* number : {&s.heating_time, &s.area, &s.volume, &s.mass, &s.mean_depth, &s.largest_depth,
                           &s.pressure, &s.temperature})
      f(*number);
  };
  constexpr std::size_t kNumbers = 8;
  for (Spall& spall : spalls_) {
    counts.push_back(static_cast<int>(spall.blocks.size()));
    blocks.insert(blocks.end(), spall.blocks.begin(), spall.blocks.end());
    signs.push_back(static_cast<int>(spall.sign));
    each_number(spall, [&](double number) { numbers.push_back(number); });
  }
  const auto most = static_cast<std::size_t>(model_.block_count());
  visitor.visit("counts", counts, state::within(1.0, static_cast<double>(most)));
  visitor.visit("blocks", blocks, state::index(most));
  visitor.visit("signs", signs, state::index(2).of(counts.size()));
  visitor.visit("numbers", numbers, state::number().of(kNumbers * counts.size()));
  if (!visitor.replaces()) return;
  visitor.require(spalls_.empty(), "blocks", "cannot come back to a body that has lost some already");
  auto next = blocks.begin();
  auto number = numbers.begin();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    visitor.require(counts[i] <= blocks.end() - next, "counts", "are more than there are blocks");
    Spall spall;
    spall.blocks.assign(next, next + counts[i]);
    for (const int block : spall.blocks) visitor.require(!is_gone_[block], "blocks", "leave twice");
    visitor.require(std::ranges::is_sorted(spall.blocks, std::ranges::less_equal()), "blocks",
                    "must come in order");
    next += counts[i];
    spall.sign = static_cast<SpallSign>(signs[i]);
    each_number(spall, [&](double& to) { to = *number++; });
    note(std::move(spall));
  }
  visitor.require(next == blocks.end(), "blocks", "are more than the pieces have");
}

}  // namespace pyroclast
