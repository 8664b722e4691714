#include "pyroclast/mechanics/torn.hpp"

#include <algorithm>

#include "pyroclast/mechanics/properties.hpp"
#include "pyroclast/mechanics/reader.hpp"
#include "pyroclast/model/visit_contacts.hpp"

namespace pyroclast {

namespace {

/// Tells whether two gradients of one face have turned against each other by more than 90 degrees. The frame
/// of a gradient has columns of length 1 but for strains, so the trace of the turn is the sum of products.
bool turned_apart(const TurningFrame<2>::Columns& a, const TurningFrame<2>::Columns& b) {
  return dot(a[0], b[0]) < 0.0;
}
bool turned_apart(const TurningFrame<3>::Columns& a, const TurningFrame<3>::Columns& b) {
  // of a turn by an angle phi it is 1 + 2 cos phi
  return dot(a[0], b[0]) + dot(a[1], b[1]) + dot(cross(a[0], a[1]), cross(b[0], b[1])) < 1.0;
}

/// Returns the place of the first energy that a law loses; -1 where it loses none.
int first_energy(const LawTable& law) {
  const auto first = std::ranges::find_if(law.losses, &LossInfo::is_energy);
  return first == law.losses.end() ? -1 : static_cast<int>(first - law.losses.begin());
}

}  // namespace

/// Returns the gradients of both sides of a face at the present displacements, see TurningFrame: those of
/// side a, then of side b. Their mean is that of the face.
template <int Dim>
std::array<typename TornFaces<Dim>::Columns, 2> TornFaces<Dim>::sides(int face) const {
  const Model& model = body_.model;
  const auto& layout = body_.layout;
  const int begin = model.face_contacts[face], points = model.face_contacts[face + 1] - begin;
  const int slot = layout.contact_slot[begin], lane = slot % kLanes, first = slot / kLanes;
  const auto moved = [&](int point, int side) -> const Vec<Dim>& {
    const PointPack& pack = layout.points[first + point];
    return body_.state.displacement[(side == 0 ? pack.a : pack.b)[lane] / offset_of<Dim>(1)];
  };
  std::array<Columns, 2> columns;
  if constexpr (Dim == 2) {
    const auto &c = body_.model.contacts[begin], &d = body_.model.contacts[begin + 1];
    const Vec<2> before = body_.model.position[d.a] - body_.model.position[c.a];
    for (int side : {0, 1}) columns[side] = {before + (moved(1, side) - moved(0, side))};
  } else {
    const auto& before = body_.arrays.face_gradient[layout.face_pack_of_point[first]];
    for (int t : {0, 1}) {
      for (int i = 0; i < Dim; ++i) columns[0][t][i] = before.tangent[t][i][lane];
      columns[1][t] = columns[0][t];
      for (int point = 0; point < points; ++point) {
        const double weight = 2.0 * body_.arrays.turning_weight[2 * (first + point) + t].number[lane];
        for (int side : {0, 1}) columns[side][t] += moved(point, side) * weight;
      }
    }
  }
  return columns;
}

template <int Dim>
std::vector<int> TornFaces<Dim>::turned() const {
  std::vector<bool> can_tear;
  for (const LawTable* law : body_.laws) can_tear.push_back(first_energy(*law) >= 0);
  std::vector<int> faces;
  const ChunkList::Items own = body_.model.gridpoint_chunks().own();
  for (int face = 0; face < body_.model.face_count(); ++face) {
    const int contact = body_.model.face_contacts[face];
    const Joint& first = body_.model.contacts[contact];
    if (!own.contain(first.a) && !own.contain(first.b)) continue;  // its owners tear it
    const int pack = body_.layout.face_pack_of_point[body_.layout.contact_slot[contact] / kLanes];
    if (!can_tear[body_.arrays.law_of_faces[pack]] || body_.is_torn(face)) continue;
    const auto [a, b] = sides(face);
    if (turned_apart(a, b) && !body_.has_left(body_.model.contacts[contact])) faces.push_back(face);
  }
  return faces;
}

template <int Dim>
void TornFaces<Dim>::tear(const std::vector<int>& faces) {
  for (const int face : faces) {
    if (!body_.leaves_out(face)) break_points(face);
    mark(face);
  }
  if (!faces.empty() && body_.has_pore_pressure()) {
    drain(body_.properties);
    Properties<Dim>(body_).place_pore_pressure();
  }
}

/// Takes the points of a face through their law as broken ones. The ledger counts the work of forces by the
/// trapezoidal rule: the face has done the half step that has begun with its forces of before.
template <int Dim>
void TornFaces<Dim>::break_points(int face) {
  const Reader<Dim> read(body_);
  Columns mean;
  const auto both = sides(face);
  for (int t = 0; t + 1 < Dim; ++t) mean[t] = (both[0][t] + both[1][t]) * 0.5;
  const TurningFrame<Dim> frame(mean);
  const bool bears_on = body_.found != nullptr;
  for (int c = body_.model.face_contacts[face]; c < body_.model.face_contacts[face + 1]; ++c) {
    const ContactState before = read.contact(c);
    static_cast<void>(Properties<Dim>(body_).break_contact(c));  // a law without damage has nothing to break
    auto losses = before.losses, internals = read.contact(c).internals;
    std::array<double, Dim> jump{before.opening};
    for (int t = 0; t + 1 < Dim; ++t) jump[t + 1] = before.tangential_jump[t];
    const LawTable& law = *before.law;
    const ContactProperties properties = body_.properties.contacts[body_.properties.of_contact[c]];
    PointResponse after =
        law.update(Dim)(properties.constants().data(), jump.data(), internals.data(), losses.data());
    if (!bears_on) after = {};

    const Joint& contact = body_.model.contacts[c];
    const Vec<Dim> next = read.displacement(contact.b) - read.displacement(contact.a);
    double lost =
        before.stored - after.stored +
        0.5 * (before.normal_traction - after.normal_traction) * (dot(next, frame.normal) - before.opening);
    for (int t = 0; t + 1 < Dim; ++t)
      lost += 0.5 * (before.shear_traction[t] - after.shear_traction[t]) *
              (dot(next, frame.tangents[t]) - before.tangential_jump[t]);
    for (std::size_t i = 0; i < losses.size(); ++i)
      if (law.losses[i].is_energy()) lost -= losses[i] - before.losses[i];
    losses[static_cast<std::size_t>(first_energy(law))] += lost;
    const auto put = [&](auto& lines, const auto& first, const std::vector<double>& numbers) {
      Line* line = lines_of(body_.layout, lines, first, c, numbers.size());
      for (const double number : numbers) line++->number[body_.layout.contact_slot[c] % kLanes] = number;
    };
    put(body_.arrays.internals, body_.arrays.first_internal, internals);
    put(body_.arrays.loss, body_.arrays.first_loss, losses);
  }
}

template <int Dim>
void TornFaces<Dim>::mark(int face) {
  body_.torn.resize(static_cast<std::size_t>(body_.model.face_count()));
  body_.torn[face] = true;
  if (!body_.found) body_.leave_out(face);
}

template <int Dim>
void TornFaces<Dim>::drain(BodyProperties& properties) const {
  for (std::size_t c = 0; c < properties.pore_pressure.size(); ++c)
    if (body_.is_torn(body_.model.contacts[c].face)) properties.pore_pressure[c] = 0.0;
}

template <int Dim>
void TornFaces<Dim>::visit_state(StateVisitor& visitor) {
  std::vector<double> torn(static_cast<std::size_t>(body_.model.contact_count()));
  for (std::size_t c = 0; c < torn.size(); ++c)
    torn[c] = body_.is_torn(body_.model.contacts[c].face) ? 1.0 : 0.0;
  visit_contacts(visitor, "torn", body_.model, torn, state::within(0, 1));
  if (!visitor.replaces()) return;
  body_.torn.clear();
  for (std::size_t c = 0; c < torn.size(); ++c)
    if (torn[c] != 0.0) mark(body_.model.contacts[c].face);
}

template class TornFaces<2>;
template class TornFaces<3>;

}  // namespace pyroclast
