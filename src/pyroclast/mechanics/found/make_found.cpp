#include "pyroclast/mechanics/found/make_found.hpp"

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/place_in.hpp"
#include "pyroclast/laws/common.hpp"
#include "pyroclast/mechanics/cracks.hpp"
#include "pyroclast/mechanics/found/pair_facts.hpp"
#include "pyroclast/model/loose_bodies.hpp"
#include "pyroclast/model/outline.hpp"

namespace pyroclast {

namespace {

/// Depth from which on the end of a pair does not count, over the height of the smaller block: the far sides
/// of two blocks that touch face each other too, as deep as both are high.
constexpr double kMostDepth = 0.25;

/// Returns the internal variables of a broken point that was never touched.
std::vector<double> broken_internals(const LawTable& law, int dim) {
  std::vector<double> internals(law.internals(dim).size());
  for (const Remembers what : kCrackModes)
    if (const int place = place_of(law, what, dim); place >= 0)
      internals[static_cast<std::size_t>(place)] = 1.0;
  return internals;
}

/// Tells whether points of a law never break.
bool never_breaks(const LawTable& law, int dim) {
  return std::ranges::none_of(kCrackModes, [&](Remembers what) { return place_of(law, what, dim) >= 0; });
}

/// Tells whether a broken point of a law lets go of what it pulls.
bool lets_go(const ContactProperties& properties, int dim) {
  auto internals = broken_internals(*properties.law, dim);
  std::vector<double> losses(properties.law->losses.size());
  const double open[3] = {1e-3, 0.0, 0.0};
  return properties.law->update(dim)(properties.constants().data(), open, internals.data(), losses.data())
             .normal_traction == 0.0;
}

/// Makes the data, each part from those before it.
template <int Dim>
class FoundMaker {
 public:
  explicit FoundMaker(Body<Dim>& body)
      : body_(body), found_(*body.found), model_(body.model), block_of_(gridpoint_blocks(body.model)) {}

  void make() {
    found_.parameters = body_.parameters.found;
    list_laws();
    list_facets();
    measure_blocks();
    list_contacts();
    choose_interfaces();
    found_.is_handed_over.assign(static_cast<std::size_t>(model_.face_count()), false);
    if (model_.part)
      for (const int chunk : model_.chunks().of_items())
        found_.rank_of_block.push_back(model_.part->rank_of_chunk[chunk]);
    const auto slots = static_cast<std::size_t>(body_.layout.gridpoint_packs) * kLanes;
    found_.block_of_slot.resize(slots);
    for (int g = 0; g < model_.gridpoint_count(); ++g)
      found_.block_of_slot[body_.layout.gridpoint_slot[g]] = block_of_[g];
    found_.arrays.searched = body_.template made<Vec<Dim>>(slots);
    found_.searched_far = body_.template made<Vec<Dim>>(slots);
    body_.state.found = &found_.seen;
  }

 private:
  void list_laws() {
    std::vector<LawOfRows> laws;
    for (const LawTable* table : body_.laws) {
      LawOfRows& law = laws.emplace_back();
      const auto infos = table->internals(Dim);
      law.internals = static_cast<int>(infos.size());
      law.losses = static_cast<int>(table->losses.size());
      law.constants = table->constant_count;
      if (std::max(law.internals, law.losses) > LawOfRows::kMost)
        throw Error(
            fmt::format("contacts = found: the law \"{}\" has more than {} internal variables or losses",
                        table->name, LawOfRows::kMost));
      for (int i = 0; i < law.internals; ++i)
        if (std::string_view(infos[i].name) == info::held_jump.name)
          law.held_jump = i;
        else if (law.slip < 0 && std::string_view(infos[i].name) == info::slip.name)
          law.slip = i;
      std::ranges::copy(broken_internals(*table, Dim), law.broken);
    }
    found_.arrays.laws = FlatArray<LawOfRows>(laws);
  }

  const Vec<Dim>& corner(const BlockFacet<Dim>& facet, int i) const {
    return model_.position[facet.gridpoints[i % Dim]];
  }
  Vec<3> area_of(const BlockFacet<3>& facet) const {
    return cross(corner(facet, 1) - corner(facet, 0), corner(facet, 2) - corner(facet, 0));
  }

  void add_facet(const std::array<int, Dim>& gridpoints, int face) {
    found_.facets.push_back({.block = block_of_[gridpoints[0]], .gridpoints = gridpoints, .face = face});
    BlockFacet<Dim>& facet = found_.facets.back();
    for (int i = 0; i < (Dim == 2 ? 1 : Dim); ++i)
      facet.length = std::max(facet.length, norm(corner(facet, i + 1) - corner(facet, i)));
    if constexpr (Dim == 2)
      facet.extent = facet.length;
    else
      facet.extent = 0.5 * norm(area_of(facet));
  }

  void list_facets() {
    const Layout<Dim>& layout = body_.layout;
    for (const auto& face : outline(model_, body_.geometry, std::vector<bool>(model_.block_count(), true)))
      add_facet(face.gridpoints, -1);
    found_.face_of_lane.assign(layout.faces.size() * kLanes, -1);
    for (int face = 0; face < model_.face_count(); ++face) {
      found_.first_of_face.push_back(static_cast<int>(found_.facets.size()));
      const int first = model_.face_contacts[face], points = model_.face_contacts[face + 1] - first;
      const auto contact = [&](int i) -> const Contact<Dim>& { return model_.contacts[first + i]; };
      if constexpr (Dim == 2) {
        add_facet({contact(0).a, contact(1).a}, face);
        add_facet({contact(1).b, contact(0).b}, face);
      } else {
        // the triangles of the fan from the first corner, as the zones have them; side b runs the other way
        // round
        for (int i = 1; i + 1 < points; ++i) add_facet({contact(0).a, contact(i).a, contact(i + 1).a}, face);
        for (int i = 1; i + 1 < points; ++i) add_facet({contact(0).b, contact(i + 1).b, contact(i).b}, face);
      }
      const int slot = layout.contact_slot[first];
      found_.face_of_lane[kLanes * layout.face_pack_of_point[slot / kLanes] + slot % kLanes] = face;
    }
    found_.first_of_face.push_back(static_cast<int>(found_.facets.size()));
  }

  void measure_blocks() {
    const auto blocks = static_cast<std::size_t>(model_.block_count());
    std::vector<double> longest(blocks), width(blocks, std::numeric_limits<double>::infinity());
    double sum = 0.0;
    for (const BlockFacet<Dim>& facet : found_.facets) {
      const int b = facet.block;
      longest[b] = std::max(longest[b], facet.length);
      sum += facet.length;
      if constexpr (Dim == 3) {
        const Vec<3> area = area_of(facet), normal = area * (1.0 / norm(area));
        double across = 0.0;
        for (int g = model_.block_gridpoints[b]; g < model_.block_gridpoints[b + 1]; ++g)
          across = std::max(across, dot(normal, corner(facet, 0) - model_.position[g]));
        width[b] = std::min(width[b], across);
      }
    }
    found_.mean_edge = sum / static_cast<double>(std::max<std::size_t>(found_.facets.size(), 1));
    for (int b = 0; b < model_.block_count(); ++b) {
      double volume = 0.0;
      for (int z = model_.block_zones[b]; z < model_.block_zones[b + 1]; ++z)
        volume += body_.geometry.volume[z] / model_.thickness;
      found_.broadest.push_back(Dim == 2 ? longest[b] * model_.thickness : volume / width[b]);
      found_.most_depth.push_back(kMostDepth * (Dim == 2 ? volume / longest[b] : width[b]));
    }
  }

  void list_contacts() {
    found_.at_gridpoint = gridpoint_contacts(model_);
    found_.contacts_of_block.resize(static_cast<std::size_t>(model_.block_count()));
    found_.first_contact.assign(model_.interface_names.size(), -1);
    const int materials = static_cast<int>(model_.material_names.size());
    constexpr int kNone = -1, kSeveral = -2;
    found_.interfaces.assign(static_cast<std::size_t>(materials * materials), kNone);
    for (int c = 0; c < model_.contact_count(); ++c) {
      const Joint& contact = model_.joint(c);
      const int a = block_of_[contact.a], b = block_of_[contact.b];
      for (const int block : {a, b}) found_.contacts_of_block[block].push_back(c);
      if (int& first = found_.first_contact[contact.interface]; first < 0) first = c;
      const int of_a = model_.block_material[a], of_b = model_.block_material[b];
      for (const int pair : {of_a * materials + of_b, of_b * materials + of_a}) {
        int& interface = found_.interfaces[pair];
        if (interface == kNone) interface = contact.interface;
        if (interface != contact.interface) interface = kSeveral;
      }
    }
  }

  /// Finds the bearings and the facets that are free from the beginning, and settles the interfaces of
  /// materials.
  void choose_interfaces() {
    const auto set_of_interface = [&](int i) { return PairFacts<Dim>(body_).set_of_interface(i); };
    std::vector<bool> serves(model_.interface_names.size());
    for (int i = 0; i < std::ssize(serves); ++i)
      if (const int set = set_of_interface(i); set >= 0)
        serves[i] = lets_go(body_.properties.contacts[set], Dim);

    std::vector<bool> only_bears(static_cast<std::size_t>(model_.block_count()), true);
    for (int face = 0; face < model_.face_count(); ++face) {
      const Joint& contact = model_.contacts[model_.face_contacts[face]];
      const int set = set_of_interface(contact.interface);
      if (serves[contact.interface] && never_breaks(body_.properties.contacts.law(set), Dim))
        found_.bearings.push_back(face);
      else
        only_bears[block_of_[contact.a]] = only_bears[block_of_[contact.b]] = false;
    }
    for (BlockFacet<Dim>& facet : found_.facets)
      facet.is_free = facet.begins_free = facet.face < 0 || only_bears[facet.block];

    found_.of_body = interfaces_of_loose_bodies(model_);
    const std::string& name = found_.parameters.like;
    const int like = name.empty() ? 0 : place_in(model_.interface_names, name);
    if (like >= std::ssize(serves))
      throw Error(fmt::format("contacts = found: there is no interface \"{}\"", name));
    for (int& interface : found_.interfaces) {
      if (interface >= 0 && serves[interface]) continue;
      if (!serves[like])
        throw Error(fmt::format(
            "contacts = found: the law of the interface \"{}\" does not let go of what it pulls once "
            "it is broken, or none of its contacts is in the body",
            model_.interface_names[like]));
      interface = like;
    }
  }

  Body<Dim>& body_;
  FoundData<Dim>& found_;
  const ModelOf<Dim>& model_;
  const std::vector<int> block_of_;  // block of each gridpoint
};

}  // namespace

template <int Dim>
void make_found(Body<Dim>& body) {
  if (!body.parameters.found.is_on) return;
  if (Dim == 2 && body.parameters.kinematics != Kinematics::finite)
    throw Error("contacts = found: blocks that meet others turn, which needs kinematics = finite");
  if (body.model.part && body.model.part->zones_of_whole != body.model.zone_count())
    throw Error("contacts = found: each rank must hold all blocks");  // a fault of the program
  body.found = std::make_unique<FoundData<Dim>>();
  FoundMaker<Dim>(body).make();
}

template void make_found(Body<2>&);
template void make_found(Body<3>&);

}  // namespace pyroclast
