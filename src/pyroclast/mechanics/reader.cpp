#include "pyroclast/mechanics/reader.hpp"

#include <algorithm>
#include <cmath>

#include "pyroclast/mechanics/cracks.hpp"
#include "pyroclast/mechanics/found/found.hpp"

namespace pyroclast {

namespace {

template <class At>
auto all(int count, At at) {
  std::vector<decltype(at(0))> values;
  values.reserve(count);
  for (int i = 0; i < count; ++i) values.push_back(at(i));
  return values;
}

}  // namespace

template <int Dim>
Vec<Dim> Reader<Dim>::displacement(int gridpoint) const {
  return body_.state.displacement[body_.layout.gridpoint_slot[gridpoint]];
}

template <int Dim>
Vec<Dim> Reader<Dim>::velocity(int gridpoint) const {
  return vector_at<Dim>(body_.state.velocity, body_.layout.gridpoint_slot[gridpoint]);
}

template <int Dim>
Vec<Dim> Reader<Dim>::force(int gridpoint) const {
  return vector_at<Dim>(body_.state.force, body_.layout.gridpoint_slot[gridpoint]);
}

template <int Dim>
Vec<Dim> Reader<Dim>::applied_force(int gridpoint) const {
  const int pack = body_.constraint_pack_of(gridpoint);
  if (pack < 0) return {};
  const int lane = body_.layout.gridpoint_slot[gridpoint] % kLanes;
  Vec<Dim> force;
  for (int i = 0; i < Dim; ++i) force[i] = body_.state.constraint_packs[pack].applied[i][lane];
  return force;
}

template <int Dim>
bool Reader<Dim>::is_prescribed(int gridpoint, int component) const {
  const int pack = body_.constraint_pack_of(gridpoint);
  if (pack < 0) return false;
  const int lane = body_.layout.gridpoint_slot[gridpoint] % kLanes;
  return (body_.state.constraint_packs[pack].prescribed[component] >> lane & 1U) != 0;
}

template <int Dim>
Vec<Dim> Reader<Dim>::displacement_of_force(int gridpoint) const {
  return displacement(gridpoint) - velocity(gridpoint) * (body_.steps > 0 ? body_.time_step() : 0.0);
}

template <int Dim>
SymmetricTensor<Dim> Reader<Dim>::stress_in_own_frame(int zone, Rotation<Dim>& rotation) const {
  const auto& gridpoints = body_.model.zones[zone];
  std::array<Vec<Dim>, Dim> u;
  for (int n = 0; n < Dim; ++n)
    u[n] = displacement_of_force(gridpoints[n]) - displacement_of_force(gridpoints[Dim]);
  const ZoneProperties p = properties_of_zone(zone);
  auto strain = mechanical_strain<Dim>(body_.geometry.gradient[zone], 1.0, u, p.thermal_strain,
                                       body_.parameters.kinematics, rotation);
  if (body_.creeps())
    for (std::size_t i = 0; i < strain.size(); ++i) strain[i] -= body_.creep_strain[zone][i];
  return zone_stress<Dim>(p, strain);
}

template <int Dim>
SymmetricTensor<Dim> Reader<Dim>::in_frame_of_model(const Rotation<Dim>& rotation,
                                                    const SymmetricTensor<Dim>& tensor) const {
  return body_.parameters.kinematics == Kinematics::finite ? rotated<Dim>(rotation, tensor) : tensor;
}

template <int Dim>
SymmetricTensor<Dim> Reader<Dim>::stress(int zone) const {
  Rotation<Dim> rotation;
  const auto stress = stress_in_own_frame(zone, rotation);
  return in_frame_of_model(rotation, stress);
}

template <int Dim>
SymmetricTensor<3> Reader<Dim>::elastic_strain(int zone) const {
  const SymmetricTensor<Dim> s = stress(zone);
  const ZoneProperties p = properties_of_zone(zone);
  double trace = s[0];
  for (std::size_t i = 1; i < Dim; ++i) trace += s[i];
  const double dilation = trace / (Dim * p.lambda + 2.0 * p.mu);
  const auto direct = [&](double stress) { return (stress - p.lambda * dilation) / (2.0 * p.mu); };
  SymmetricTensor<Dim> strain;
  for (std::size_t i = 0; i < s.size(); ++i) strain[i] = i < Dim ? direct(s[i]) : 0.5 * s[i] / p.mu;
  if constexpr (Dim == 2)
    return in_space(strain, direct(0.0));
  else
    return strain;
}

template <int Dim>
ZoneProperties Reader<Dim>::properties_of_zone(int zone) const {
  const ZoneProperties& p = body_.properties.zones[zone];
  if (body_.creep_under_way.empty()) return p;
  const CreepUnderWay<Dim>& creep = body_.creep_under_way[zone];
  return with_compliance<Dim>(p, creep.split.compliance, creep.poisson);
}

template <int Dim>
SymmetricTensor<Dim> Reader<Dim>::creep_strain(int zone) const {
  if (!body_.creeps()) return {};
  Rotation<Dim> rotation;
  stress_in_own_frame(zone, rotation);
  return in_frame_of_model(rotation, body_.creep_strain[zone]);
}

template <int Dim>
typename TurningFrame<Dim>::Columns Reader<Dim>::gradient(int face, double sign) const {
  return gradient(face, sign, [&](int g) { return displacement(g); });
}

template <int Dim>
template <class Moved>
typename TurningFrame<Dim>::Columns Reader<Dim>::gradient(int face, double sign, Moved moved) const {
  const int first = body_.model.face_contacts[face], last = body_.model.face_contacts[face + 1];
  typename TurningFrame<Dim>::Columns columns{};
  if constexpr (Dim == 2) {
    const auto &c = body_.model.contacts[first], &d = body_.model.contacts[first + 1];
    const auto at = [&](int g) { return body_.model.position[g] + moved(g); };
    columns = {((at(d.a) - at(c.a)) + (at(d.b) - at(c.b)) * sign) * 0.5};
  } else {
    const auto point = [&](int c) { return body_.layout.contact_slot[c] / kLanes; };
    const int lane = body_.layout.contact_slot[first] % kLanes;
    const auto& before = body_.arrays.face_gradient[body_.layout.face_pack_of_point[point(first)]];
    for (int t : {0, 1}) {
      for (int i = 0; sign > 0.0 && i < Dim; ++i) columns[t][i] = before.tangent[t][i][lane];
      for (int c = first; c < last; ++c) {
        const Contact<Dim>& other = body_.model.contacts[c];
        columns[t] += (moved(other.a) + moved(other.b) * sign) *
                      body_.arrays.turning_weight[2 * point(c) + t].number[lane];
      }
    }
  }
  return columns;
}

template <int Dim>
template <class Moved>
ContactFrame<Dim> Reader<Dim>::frame(int contact, Moved moved) const {
  const Contact<Dim>& of = body_.model.contacts[contact];
  if (body_.parameters.kinematics == Kinematics::small) return {of.normal, of.tangents};
  return TurningFrame<Dim>(gradient(of.face, 1.0, moved));
}

template <int Dim>
ContactFrame<Dim> Reader<Dim>::frame_of_forces(int contact) const {
  return frame(contact, [&](int g) { return displacement_of_force(g); });
}

template <int Dim>
double Reader<Dim>::slide(int face) const {
  const int first = body_.model.face_contacts[face];
  const Vec<Dim> normal = frame(first, [&](int g) { return displacement(g); }).normal;
  double most = 0.0;
  for (int c = first; c < body_.model.face_contacts[face + 1]; ++c) {
    const Contact<Dim>& contact = body_.model.contacts[c];
    const Vec<Dim> jump = displacement(contact.b) - displacement(contact.a);
    most = std::max(most, norm(jump - normal * dot(jump, normal)));
  }
  return most;
}

template <int Dim>
Vec<Dim> Reader<Dim>::jump_of_forces(int contact) const {
  const auto& c = body_.model.contacts[contact];
  return displacement_of_force(c.b) - displacement_of_force(c.a);
}

template <int Dim>
double Reader<Dim>::opening(int contact) const {
  if (body_.is_torn(body_.model.contacts[contact].face)) return norm(jump_of_forces(contact));
  return dot(jump_of_forces(contact), frame_of_forces(contact).normal);
}

template <int Dim>
double Reader<Dim>::remembered(int contact, Remembers what) const {
  const LawTable& law = body_.law_of(contact);
  const int place = place_of(law, what, Dim);
  if (place < 0) return 0.0;
  return lines_of(body_.layout, body_.state.internals, body_.state.first_internal, contact,
                  law.internals(Dim).size())[place]
      .number[body_.layout.contact_slot[contact] % kLanes];
}

template <int Dim>
double Reader<Dim>::damage(int contact) const {
  double most = 0.0;
  for (const Remembers mode : kCrackModes) most = std::max(most, remembered(contact, mode));
  return most;
}

template <int Dim>
double Reader<Dim>::crack_step(int contact) const {
  return body_.arrays.crack_step[body_.layout.contact_slot[contact]];
}

template <int Dim>
ContactState Reader<Dim>::contact(int contact) const {
  const int set = body_.properties.of_contact[contact], lane = body_.layout.contact_slot[contact] % kLanes;
  ContactState state;
  state.law = &body_.law_of(contact);
  state.dimension = Dim;
  const auto values = [&](const auto& lines, const auto& first, std::size_t count) {
    std::vector<double> numbers(count);
    const Line* line = lines_of(body_.layout, lines, first, contact, count);
    for (double& number : numbers) number = line++->number[lane];
    return numbers;
  };
  state.internals =
      values(body_.state.internals, body_.state.first_internal, state.law->internals(Dim).size());
  state.losses = values(body_.state.loss, body_.state.first_loss, state.law->losses.size());
  const Vec<Dim> u = jump_of_forces(contact);
  const int face = body_.model.contacts[contact].face;
  if (body_.is_torn(face) && body_.leaves_out(face)) {
    state.opening = norm(u);
    return state;
  }
  const auto frame = frame_of_forces(contact);
  state.opening = dot(u, frame.normal);
  for (int i = 0; i + 1 < Dim; ++i) state.tangential_jump[i] = dot(u, frame.tangents[i]);
  if (body_.leaves_out(face)) return state;
  // the law, taken to the same jump once more, gives the same tractions
  std::array<double, Dim> jump{state.opening};
  for (int i = 0; i + 1 < Dim; ++i) jump[i + 1] = state.tangential_jump[i];
  auto internals = state.internals, losses = state.losses;
  const PointResponse response = state.law->update(Dim)(body_.properties.contacts[set].constants().data(),
                                                        jump.data(), internals.data(), losses.data());
  state.normal_traction = response.normal_traction;
  for (int i = 0; i + 1 < Dim; ++i) state.shear_traction[i] = response.shear_traction[i];
  state.stored = response.stored;
  return state;
}

double ContactState::remembered(Remembers what) const {
  const int place = place_of(*law, what, dimension);
  return place < 0 ? 0.0 : internals[place];
}

double ContactState::remembered(std::string_view name) const {
  const auto infos = law->internals(dimension);
  for (std::size_t i = 0; i < infos.size(); ++i)
    if (infos[i].name == name) return internals[i];
  return 0.0;
}

double ContactState::lost(std::string_view name) const {
  for (std::size_t i = 0; i < losses.size(); ++i)
    if (law->losses[i].name == name) return losses[i];
  return 0.0;
}

template <int Dim>
std::vector<Vec<Dim>> Reader<Dim>::displacements() const {
  return all(body_.model.gridpoint_count(), [&](int g) { return displacement(g); });
}

template <int Dim>
std::vector<Vec<Dim>> Reader<Dim>::velocities() const {
  return all(body_.model.gridpoint_count(), [&](int g) { return velocity(g); });
}

template <int Dim>
std::vector<Vec<Dim>> Reader<Dim>::forces() const {
  return all(body_.model.gridpoint_count(), [&](int g) { return force(g); });
}

template <int Dim>
std::vector<SymmetricTensor<Dim>> Reader<Dim>::stresses() const {
  return all(body_.model.zone_count(), [&](int z) { return stress(z); });
}

template <int Dim>
std::vector<ContactState> Reader<Dim>::contacts() const {
  return all(body_.model.contact_count(), [&](int c) { return contact(c); });
}

template class Reader<2>;
template class Reader<3>;

}  // namespace pyroclast
