#include "pyroclast/mechanics/torn.hpp"

#include <algorithm>

#include "pyroclast/mechanics/properties.hpp"
#include "pyroclast/mechanics/reader.hpp"
#include "pyroclast/model/visit_contacts.hpp"

namespace pyroclast {

namespace {

/// Returns the place of the first energy that a law loses; -1 where it loses none.
int first_energy(const LawTable& law) {
  const auto first = std::ranges::find_if(law.losses, &LossInfo::is_energy);
  return first == law.losses.end() ? -1 : static_cast<int>(first - law.losses.begin());
}

}  // namespace

/// Tells whether the sides of a face have turned against each other by more than 90 degrees. The gradient of
/// a side has columns of length 1 but for strains, so the trace of the turn is the sum of products.
template <int Dim>
bool TornFaces<Dim>::have_turned_apart(int face) const {
  const Reader<Dim> read(body_);
  const auto half = read.gradient(face, -1.0);
  if constexpr (Dim == 2) {
    const auto mean = read.gradient(face, 1.0);
    return dot(mean[0], mean[0]) < dot(half[0], half[0]);
  } else {
    // a turn by 90 degrees makes at least one column of both differ by the root of 2, and halves by 0.7
    if (dot(half[0], half[0]) + dot(half[1], half[1]) < 0.25) return false;
    const auto mean = read.gradient(face, 1.0);
    const Vec<3> a0 = mean[0] + half[0], a1 = mean[1] + half[1], b0 = mean[0] - half[0],
                 b1 = mean[1] - half[1];
    // of a turn by an angle phi the trace is 1 + 2 cos phi
    return dot(a0, b0) + dot(a1, b1) + dot(cross(a0, a1), cross(b0, b1)) < 1.0;
  }
}

/// Tells whether all points of a face are broken and its sides have slid past each other: their middles lie
/// further apart along the face than the face is wide, so that none of one side lies over the other.
template <int Dim>
bool TornFaces<Dim>::have_slid_past(int face) const {
  const auto& model = body_.model;
  const int begin = model.face_contacts[face], end = model.face_contacts[face + 1];
  const Reader<Dim> read(body_);
  Vec<Dim> jump{};
  for (int c = begin; c < end; ++c) {
    if (read.damage(c) < 1.0) return false;
    jump += read.displacement(model.contacts[c].b) - read.displacement(model.contacts[c].a);
  }
  jump *= 1.0 / (end - begin);
  const Vec<Dim> normal = TurningFrame<Dim>(read.gradient(face, 1.0)).normal;
  const double slid = norm(jump - normal * dot(jump, normal));
  const auto place = [&](int c) { return model.position[model.contacts[c].a]; };
  for (int c = begin; c < end; ++c)
    for (int d = begin; d < c; ++d)
      if (slid <= norm(place(c) - place(d))) return false;
  return true;
}

template <int Dim>
std::vector<int> TornFaces<Dim>::faces_to_tear() const {
  std::vector<bool> can_tear;
  for (const LawTable* law : body_.laws) can_tear.push_back(first_energy(*law) >= 0);
  std::vector<int> faces;
  const ChunkList::Items own = body_.model.gridpoint_chunks().own();
  for (int face = 0; face < body_.model.face_count(); ++face) {
    const int contact = body_.model.face_contacts[face];
    const Contact<Dim>& first = body_.model.contacts[contact];
    if (!own.contain(first.a) && !own.contain(first.b)) continue;  // its owners tear it
    const int pack = body_.layout.face_pack_of_point[body_.layout.contact_slot[contact] / kLanes];
    if (!can_tear[body_.arrays.law_of_faces[pack]] || body_.is_torn(face) || body_.has_left(first)) continue;
    // found contacts take over what is broken before its sides have slid so far
    if (have_turned_apart(face) || (!body_.found && have_slid_past(face))) faces.push_back(face);
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
  const TurningFrame<Dim> frame(read.gradient(face, 1.0));
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
    if (!body_.found) after = {};

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
