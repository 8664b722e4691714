#include "pyroclast/mechanics/found/handed_faces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pyroclast/base/sort_unique.hpp"
#include "pyroclast/mechanics/cracks.hpp"
#include "pyroclast/mechanics/reader.hpp"

namespace pyroclast {

namespace {

/// Cosine between the facets of a torn face below which its pairs begin anew: it leans, and does not spin on
/// its other side.
constexpr double kLeans = 0.5;
/// Way that the sides of a bearing slide on each other until it is handed over, over the size of its face.
constexpr double kSlidBearing = 0.1;

template <int Dim>
double shear_stiffness_of(const Body<Dim>& body, int contact) {
  return body.properties.contacts[body.properties.of_contact[contact]].stiffness().shear;
}

/// Gives the points of a pair of edges the state of the contacts of their face.
void take_history(const Body<2>& body, int face, const EdgePair<double>& p, int points, FoundPair<2>& pair) {
  const Reader<2> read(body);
  pair.internals.clear();
  for (int k = 0; k < points; ++k) {
    const int contact = body.model.face_contacts[face] + k;
    const ContactState state = read.contact(contact);
    PairPoint<2>& point = pair.points[k];
    point.area = body.model.contacts[contact].area;
    point.held = {{state.shear_traction[0] / shear_stiffness_of(body, contact)}};
    point.shift = {{state.tangential_jump[0] - p.slide[k]}};
    point.offset = state.opening - p.gap[k];
    pair.internals.insert(pair.internals.end(), state.internals.begin(), state.internals.end());
    pair.stored += state.stored * point.area;
  }
}

/// Gives the points of a pair of triangles the state of the nearest contacts of their face.
void take_history(const Body<3>& body, int face, const TrianglePair<double>& p, int points,
                  FoundPair<3>& pair) {
  const Reader<3> read(body);
  const LawOfRows& law = body.found->arrays.laws[pair.law];
  const auto tangents = tangents_of(p.a, p.normal);
  const int first = body.model.face_contacts[face];
  for (int k = 0; k < points; ++k) {
    const Vec<3> place = p.on_a(k);
    int nearest = first;
    double least = std::numeric_limits<double>::infinity();
    for (int c = first; c < body.model.face_contacts[face + 1]; ++c) {
      const int g = body.model.contacts[c].a;
      const Vec<3> way = body.model.position[g] + read.displacement_of_force(g) - place;
      if (!(dot(way, way) < least)) continue;
      least = dot(way, way);
      nearest = c;
    }
    const ContactState state = read.contact(nearest);
    const auto frame = read.frame_of_forces(nearest);
    const auto turned = [&](const Vec<2>& v) {
      const Vec<3> in_space = frame.tangents[0] * v[0] + frame.tangents[1] * v[1];
      return Vec<2>{{dot(in_space, tangents[0]), dot(in_space, tangents[1])}};
    };
    PairPoint<3>& point = pair.points[k];
    point.area = pair.ratio * p.cosine * p.cosine * p.part[k];
    point.held = turned(state.shear_traction * (1.0 / shear_stiffness_of(body, nearest)));
    point.shift = turned(state.tangential_jump);
    point.offset = state.opening - p.gap[k];
    double* const internals = &pair.internals[static_cast<std::size_t>(k * law.internals)];
    std::ranges::copy(state.internals, internals);
    if (law.slip >= 0) {
      const Vec<2> slip = turned({{internals[law.slip], internals[law.slip + 1]}});
      internals[law.slip] = slip[0];
      internals[law.slip + 1] = slip[1];
    }
    pair.stored += state.stored * point.area;
  }
}

}  // namespace

template <int Dim>
std::vector<int> HandedFaces<Dim>::due() const {
  std::vector<int> faces;
  const auto& s = body_.arrays;
  for (int pack = 0; pack < body_.layout.face_packs(); ++pack) {
    const LawTable& law = body_.law_of_pack(pack);
    const auto count = static_cast<int>(law.internals(Dim).size());
    const int points = body_.layout.first_point_of(pack + 1) - body_.layout.first_point_of(pack);
    unsigned broken = 0xffU & ~static_cast<unsigned>(body_.left_out.empty() ? 0 : body_.left_out[pack]);
    for (int point = 0; point < points; ++point) {
      unsigned of_point = 0;
      for (const Remembers what : kCrackModes)
        if (const int place = place_of(law, what, Dim); place >= 0)
          for (int lane = 0; lane < kLanes; ++lane)
            if (s.internals[s.first_internal[pack] + point * count + place].number[lane] >= 1.0)
              of_point |= 1U << static_cast<unsigned>(lane);
      broken &= of_point;
    }
    for (int lane = 0; broken != 0 && lane < kLanes; ++lane)
      if (const int face = found_.face_of_lane[kLanes * pack + lane];
          (broken >> static_cast<unsigned>(lane) & 1U) != 0 && face >= 0)
        faces.push_back(face);
  }
  for (int face = 0; face < std::ssize(body_.torn); ++face)
    if (body_.torn[face] && !found_.is_handed_over[face]) faces.push_back(face);
  // beyond some slide a contact of the beginning would press a side of a bearing where it is no more
  const auto has_slid = [&](int face) {
    double extent = 0.0;
    for (int c = body_.model.face_contacts[face]; c < body_.model.face_contacts[face + 1]; ++c)
      extent += body_.model.extent(c);
    return Reader<Dim>(body_).slide(face) > kSlidBearing * (Dim == 2 ? extent : std::sqrt(extent));
  };
  const ChunkList::Items own = body_.model.gridpoint_chunks().own();
  for (const int face : found_.bearings) {
    const Joint& contact = body_.model.contacts[body_.model.face_contacts[face]];
    if (!found_.is_handed_over[face] && (own.contain(contact.a) || own.contain(contact.b)) && has_slid(face))
      faces.push_back(face);
  }
  faces = body_.model.ranks().collect(faces);
  sort_unique(faces);
  return faces;
}

template <int Dim>
void HandedFaces<Dim>::mark(int face) {
  found_.is_handed_over[face] = true;
  for (int f = found_.first_of_face[face]; f < found_.first_of_face[face + 1]; ++f)
    found_.facets[f].is_free = true;
  body_.leave_out(face);
}

/// Returns the pairs of the two sides of a face, with the areas, jumps and history of its contact points at
/// the displacements of the last forces.
template <int Dim>
std::vector<FoundPair<Dim>> HandedFaces<Dim>::pairs_of(int face) const {
  const Reader<Dim> read(body_);
  const auto& model = body_.model;
  double face_area = 0.0, stored = 0.0, overlap = 0.0;
  for (int c = model.face_contacts[face]; c < model.face_contacts[face + 1]; ++c) {
    face_area += model.contacts[c].area;
    stored += read.contact(c).stored * model.contacts[c].area;
  }
  std::vector<FoundPair<Dim>> pairs;
  std::vector<PairShape<Dim>> shapes;
  const int begin = found_.first_of_face[face], end = found_.first_of_face[face + 1],
            middle = (begin + end) / 2;
  for (int a = begin; a < middle; ++a)
    for (int b = middle; b < end; ++b) {
      FoundPair<Dim>& pair = pairs.emplace_back(facts_.new_pair({a, b}));
      const auto at = facts_.places_of_forces(pair.facets);
      const PairShape<Dim>& shape = shapes.emplace_back(facts_.shape(pair.facets, at));
      // else they have left each other already, or never met
      pair.is_handed_over = shape.points > 0 && !(body_.is_torn(face) && shape.p.cosine < kLeans);
      if (!pair.is_handed_over) continue;
      overlap += shape.p.cosine * shape.p.cosine * shape.p.overlap;
      if constexpr (Dim == 3) pair.pressed_at = at;
    }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!pairs[i].is_handed_over) continue;
    pairs[i].ratio = face_area / (overlap * model.thickness);
    take_history(body_, face, shapes[i].p, shapes[i].points, pairs[i]);
    stored -= pairs[i].stored;
  }
  // in space points of pairs are others than those of the face, and so is their energy, a little; and what
  // sides held that have left each other is lost
  pairs.front().lost_area = stored;
  return pairs;
}

template <int Dim>
std::vector<bool> HandedFaces<Dim>::hand_over(const std::vector<int>& faces) {
  // facets beside a face are fresh too: where it held them together they may press from now on
  std::vector<bool> ends(body_.model.position.size()), fresh(found_.facets.size());
  const std::ptrdiff_t known = std::ssize(found_.pairs);
  for (const int face : faces) {
    if (found_.is_of_rank(body_.model.ranks().me(),
                          {found_.first_of_face[face], found_.first_of_face[face + 1] - 1}))
      for (FoundPair<Dim>& pair : pairs_of(face))
        if (Dim == 2 || pair.is_handed_over || pair.has_lost()) found_.pairs.push_back(std::move(pair));
    for (int c = body_.model.face_contacts[face]; c < body_.model.face_contacts[face + 1]; ++c)
      ends[body_.model.contacts[c].a] = ends[body_.model.contacts[c].b] = true;
  }
  for (std::size_t f = 0; f < fresh.size(); ++f)
    for (const int g : found_.facets[f].gridpoints) fresh[f] = fresh[f] || ends[g];
  for (const int face : faces) mark(face);
  const auto by_key = [](const auto& a, const auto& b) { return a.facets < b.facets; };
  std::sort(found_.pairs.begin() + known, found_.pairs.end(), by_key);
  std::inplace_merge(found_.pairs.begin(), found_.pairs.begin() + known, found_.pairs.end(), by_key);
  return fresh;
}

template <int Dim>
std::vector<bool> HandedFaces<Dim>::forget_gone() {
  const auto is_gone = [&](int facet) { return body_.is_gone(found_.facets[facet].block); };
  for (FoundPair<Dim>& pair : found_.pairs) {
    if (!is_gone(pair.facets[0]) && !is_gone(pair.facets[1])) continue;
    FoundPair<Dim> lost = facts_.new_pair(pair.facets);
    lost.is_near = false;
    lost.lost = pair.lost;
    lost.lost_area = pair.lost_area;
    lost.lost_damping = pair.lost_damping;
    pair = std::move(lost);
  }
  std::vector<bool> fresh(found_.facets.size());
  for (int face = 0; face < body_.model.face_count(); ++face) {
    const int begin = found_.first_of_face[face], end = found_.first_of_face[face + 1];
    if (found_.is_handed_over[face] || (!is_gone(begin) && !is_gone(end - 1))) continue;
    mark(face);
    std::fill(fresh.begin() + begin, fresh.begin() + end, true);
  }
  bury_gone();
  return fresh;
}

template <int Dim>
void HandedFaces<Dim>::bury_gone() {
  for (BlockFacet<Dim>& facet : found_.facets)
    if (body_.is_gone(facet.block)) facet.is_free = false;
}

template class HandedFaces<2>;
template class HandedFaces<3>;

}  // namespace pyroclast
