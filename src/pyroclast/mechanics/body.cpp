#include "pyroclast/mechanics/body.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/mechanics/energy_ledger.hpp"
#include "pyroclast/mechanics/found/found.hpp"
#include "pyroclast/model/item_halo.hpp"

namespace pyroclast {

int place_of(const LawTable& law, Remembers what, int dim) {
  const auto internals = law.internals(dim);
  const auto found = std::ranges::find(internals, what, &InternalInfo::what);
  return found == internals.end() ? -1 : static_cast<int>(found - internals.begin());
}

BodyProperties by_interface(const Model& model, std::vector<ZoneProperties> zones,
                            const std::vector<ContactProperties>& interfaces) {
  BodyProperties p{std::move(zones), ContactSets(interfaces), {}, {}, {}};
  p.of_contact.reserve(model.contact_count());
  for (int c = 0; c < model.contact_count(); ++c) p.of_contact.push_back(model.joint(c).interface);
  for (int i = 0; i < p.contacts.size(); ++i) p.of_interface.push_back(i);
  return p;
}

template <int Dim>
Body<Dim>::Body(const ModelOf<Dim>& of, BodyProperties with, const MechanicsParameters& by,
                std::shared_ptr<Team> threads)
    : model(of),
      parameters(by),
      team(threads ? std::move(threads) : std::make_shared<Team>()),
      geometry(zone_geometry(of)),
      layout(of, by.layout),
      step(step_functions<Dim>(by.instructions)),
      properties(std::move(with)) {
  if (Dim == 2 && parameters.gravity[2] != 0.0) throw Error("gravity acts across the plane of this body");
  if (!properties.creep.empty()) creep_strain.resize(model.zones.size());
  list_laws();
  place_model();
  place_internals();
  mean_height = chunked_sum(layout.chunks.zones, [&](int z) { return 1.0 / norm(geometry.gradient[z][0]); }) /
                layout.chunks.zones.whole_count();
  gridpoints_of_whole = layout.chunks.gridpoints.whole_count();
}

template <int Dim>
Body<Dim>::~Body() = default;

template <int Dim>
std::size_t Body<Dim>::memory() const {
  return pyroclast::memory(layout) + pyroclast::memory(arrays) +
         (found ? pyroclast::memory(found->arrays) : 0);
}

template <int Dim>
int Body<Dim>::first_bundle_of(int bundle) const {
  if (!layout.bundles[bundle].is_part) return bundle;
  return layout.bundle_of(model.block_gridpoints[layout.block_in(bundle, 0)]);
}

template <int Dim>
bool Body<Dim>::ties_join_parts() const {
  return std::ranges::any_of(made_ties,
                             [&](const TieOfBundle& tie) { return layout.bundles[tie.bundle].is_part; });
}

template <int Dim>
void Body<Dim>::leave_out(int face) {
  if (is_left_out.empty()) {
    is_left_out.resize(static_cast<std::size_t>(model.face_count()));
    left_out = made<std::uint8_t>(layout.faces.size());
    state.left_out = {left_out.data(), left_out.size()};
  }
  is_left_out[face] = true;
  const int slot = layout.contact_slot[model.face_contacts[face]];
  left_out[layout.face_pack_of_point[slot / kLanes]] |=
      static_cast<std::uint8_t>(1U << static_cast<unsigned>(slot % kLanes));
}

template <int Dim>
void Body<Dim>::leave_none_out() {
  is_left_out.clear();
  left_out = {};
  state.left_out = {};
}

template <int Dim>
int Body<Dim>::constraint_pack_of(int gridpoint) const {
  const int bundle = layout.bundle_of(gridpoint), index = made_constraints[bundle];
  if (index < 0) return -1;
  return arrays.constraints[index].first_pack + layout.gridpoint_slot[gridpoint] / kLanes -
         layout.bundles[bundle].first_pack;
}

template <int Dim>
FlatArray<double> Body<Dim>::make_scratch() const {
  return FlatArray<double>(kScratchNumbers<Dim> * static_cast<std::size_t>(layout.most_packs));
}

/// Places all that does not change: parameters, positions, and arrays of their sizes.
template <int Dim>
void Body<Dim>::place_model() {
  see(state.layout, layout);
  state.gravity = resized<Dim>(parameters.gravity);
  state.local_damping = parameters.local_damping;
  state.viscous_damping = parameters.viscous_damping;
  state.damping_form = parameters.damping_form;
  state.kinematics = parameters.kinematics;
  state.thickness = model.thickness;
  state.block_size = block_size();
  auto& s = arrays;
  const auto packs = static_cast<std::size_t>(layout.gridpoint_packs);
  s.velocity = made<VectorPack<Dim>>(packs);
  s.force = made<VectorPack<Dim>>(packs);
  s.stiffness = made<double>(packs * kLanes);
  s.displacement = made<Vec<Dim>>(packs * kLanes);
  s.step_over_mass = made<double>(packs * kLanes);
  const auto point_packs = static_cast<std::size_t>(layout.point_packs);
  s.crack_step = made<double>(point_packs * kLanes);
  std::fill(s.crack_step.begin(), s.crack_step.end(), kNotCracked);
  s.losing = made<bool>(point_packs);
  s.contact_force = made<Vec<Dim>>(point_packs * kLanes);
  if (parameters.kinematics == Kinematics::finite) place_turning();
  if (!layout.piece_zones.empty()) {
    const auto idle = static_cast<std::size_t>(1);
    s.corner_force = made<Vec<Dim>>(kLanes * ((Dim + 1) * layout.piece_zones.size() + idle));
  }
  if (!layout.parts.empty()) s.part_force = made<VectorPack<Dim>>(layout.corners_of_pack.size());
  s.constraints_of_bundle = FlatArray<int>(layout.bundles.size());
  std::fill(s.constraints_of_bundle.begin(), s.constraints_of_bundle.end(), -1);
  made_constraints.assign(layout.bundles.size(), -1);
  s.bundle_sums = made<BundleSums>(layout.bundles.size());
  s.face_sums = made<FaceSums>(layout.faces.size());

  place_positions();
  refresh_views();
}

/// Returns the root of the mean area or volume of the blocks that are of no bearing, m; of all blocks where
/// there are no others.
template <int Dim>
double Body<Dim>::block_size() const {
  struct Sums {
    double volume = 0.0, blocks = 0.0, volume_of_all = 0.0, all = 0.0;
    void operator+=(const Sums& o) {
      volume += o.volume;
      blocks += o.blocks;
      volume_of_all += o.volume_of_all;
      all += o.all;
    }
  };
  const auto sums = chunked_sum<Sums>(layout.chunks.blocks, [&](int b, Sums& sum) {
    double of_block = 0.0;
    for (int z = model.block_zones[b]; z < model.block_zones[b + 1]; ++z) of_block += geometry.volume[z];
    const bool counts = !model.is_of_bearing(b);
    sum += {counts ? of_block : 0.0, counts ? 1.0 : 0.0, of_block, 1.0};
  });
  const double mean = sums.blocks > 0.0 ? sums.volume / sums.blocks : sums.volume_of_all / sums.all;
  return Dim == 2 ? std::sqrt(mean / model.thickness) : std::cbrt(mean);
}

/// Places the positions of gridpoints in the form from which the zones of this dimension read.
template <int Dim>
void Body<Dim>::place_positions() {
  const auto packs = static_cast<std::size_t>(layout.gridpoint_packs);
  if (Dim == 2 || parameters.found.is_on) {
    arrays.gathered_position = made<Vec<Dim>>(packs * kLanes);
    for (int g = 0; g < model.gridpoint_count(); ++g)
      arrays.gathered_position[layout.gridpoint_slot[g]] = model.position[g];
  }
  if constexpr (Dim == 3) {
    arrays.from_last = made<Four>(packs * kLanes);
    for (int b = 0; b < model.block_count(); ++b) {
      const int last = model.block_gridpoints[b + 1] - 1;
      for (int g = model.block_gridpoints[b]; g <= last; ++g) {
        const Vec<3> seen = model.position[g] - model.position[last];
        arrays.from_last[layout.gridpoint_slot[g]] = {{seen[0], seen[1], seen[2], 0.0}};
      }
    }
  } else {
    arrays.position = made<VectorPack<Dim>>(packs);
    const View<VectorPack<Dim>> position(arrays.position.data(), arrays.position.size());
    for (int g = 0; g < model.gridpoint_count(); ++g) {
      set_vector<Dim>(position, layout.gridpoint_slot[g], model.position[g]);
    }
    for (int b = 0; b < static_cast<int>(layout.bundles.size()); ++b)
      for (int lane = 0; lane < kLanes; ++lane) {
        if (layout.block_in(b, lane) >= 0) continue;
        // an idle lane has the shape of the first, without stiffness
        const Bundle& bundle = layout.bundles[b];
        for (int i = 0; i < bundle.packs; ++i)
          set_vector<Dim>(position, slot_of(bundle.first_pack + i, lane),
                          vector_at<Dim>(position, slot_of(bundle.first_pack + i, 0)));
      }
  }
}

/// Places the array of the forces of turning frames, and in 3D the weights with which each face turns: those
/// of the gradient of least squares of its places in its first plane.
template <int Dim>
void Body<Dim>::place_turning() {
  arrays.turning_force = made<Vec<Dim>>(static_cast<std::size_t>(layout.point_packs) * kLanes);
  if constexpr (Dim == 3) {
    auto& weights = arrays.turning_weight = made<Line>(2 * layout.points.size());
    auto& gradients = arrays.face_gradient = made<FacePack<3>>(layout.faces.size());
    for (int face = 0; face < model.face_count(); ++face) {
      const int first = model.face_contacts[face], count = model.face_contacts[face + 1] - first;
      const Contact<3>* const contacts = &model.contacts[first];
      std::vector<Vec<3>> places;
      Vec<3> middle{};
      for (int c = 0; c < count; ++c) {
        places.push_back((model.position[contacts[c].a] + model.position[contacts[c].b]) * 0.5);
        middle += places.back() * (1.0 / count);
      }
      double xx = 0.0, xy = 0.0, yy = 0.0;  // second moments in the plane of the tangents
      const auto in_plane = [&](const Vec<3>& seen) {
        return Vec<2>{{dot(seen, contacts->tangents[0]), dot(seen, contacts->tangents[1])}};
      };
      for (Vec<3>& x : places) {
        x -= middle;
        const Vec<2> p = in_plane(x);
        xx += p[0] * p[0];
        xy += p[0] * p[1];
        yy += p[1] * p[1];
      }
      const int lane = layout.contact_slot[first] % kLanes;
      auto& gradient = gradients[layout.face_pack_of_point[layout.contact_slot[first] / kLanes]];
      for (int c = 0; c < count; ++c) {
        const Vec<2> p = in_plane(places[c]);
        const double over = 1.0 / (xx * yy - xy * xy);
        const double of_mean[2] = {(yy * p[0] - xy * p[1]) * over, (xx * p[1] - xy * p[0]) * over};
        for (int t : {0, 1}) {
          weights[2 * (layout.contact_slot[first + c] / kLanes) + t].number[lane] = 0.5 * of_mean[t];
          for (int i = 0; i < 3; ++i) gradient.tangent[t][i][lane] += places[c][i] * of_mean[t];
        }
      }
    }
    // idle lanes turn with the first face, on whose gridpoints they stand
    for (int pack = 0; pack < layout.face_packs(); ++pack)
      for (int lane = 1; lane < kLanes; ++lane) {
        const int points = layout.first_point_of(pack);
        if (layout.points[points].area[lane] > 0.0) continue;
        for (int line = 2 * points; line < 2 * layout.first_point_of(pack + 1); ++line)
          weights[line].number[lane] = weights[line].number[0];
        for (auto& column : gradients[pack].tangent)
          for (auto& component : column) component[lane] = component[0];
      }
  }
}

/// Lists the laws of the body, each once, in the order of the interfaces. Throws Error where there are too
/// many.
template <int Dim>
void Body<Dim>::list_laws() {
  laws = properties.contacts.laws();
  if (laws.size() > kMostLaws)
    throw Error(fmt::format("the contacts of this body have {} laws; at most {} are possible", laws.size(),
                            kMostLaws));
  use(step);
}

template <int Dim>
void Body<Dim>::use(const StepFunctions<Dim>& other) {
  step = other;
  law_functions.clear();
  for (const LawTable* law : laws) law_functions.push_back(step.functions_of(*law));
  state.laws = law_functions.data();
}

/// Gives every pack of faces its law, and its lines of the internal variables and losses.
template <int Dim>
void Body<Dim>::place_internals() {
  auto& s = arrays;
  const auto packs = static_cast<std::size_t>(layout.face_packs());
  s.law_of_faces = FlatArray<std::uint8_t>(packs);
  for (int c = 0; c < model.contact_count(); ++c)
    s.law_of_faces[layout.face_pack_of_point[layout.contact_slot[c] / kLanes]] =
        static_cast<std::uint8_t>(std::ranges::find(laws, &law_of(c)) - laws.begin());
  s.first_internal = FlatArray<int>(packs + 1);
  s.first_loss = FlatArray<int>(packs + 1);
  for (int pack = 0; pack < layout.face_packs(); ++pack) {
    const LawTable& law = law_of_pack(pack);
    const int points = layout.first_point_of(pack + 1) - layout.first_point_of(pack);
    s.first_internal[pack + 1] =
        s.first_internal[pack] + points * static_cast<int>(law.internals(Dim).size());
    s.first_loss[pack + 1] = s.first_loss[pack] + points * static_cast<int>(law.losses.size());
  }
  s.internals = made<Line>(static_cast<std::size_t>(s.first_internal[packs]));
  s.loss = made<Line>(static_cast<std::size_t>(s.first_loss[packs]));
  name_dissipations();
  refresh_views();
}

template <int Dim>
void Body<Dim>::name_dissipations() {
  for (const LawTable* law : laws)
    for (const LossInfo& loss : law->losses)
      if (loss.is_energy() &&
          std::ranges::find(dissipations, std::string_view(loss.name)) == dissipations.end())
        dissipations.emplace_back(loss.name);
  if (creeps() && std::ranges::find(dissipations, kCreep) == dissipations.end())
    dissipations.push_back(kCreep);
  if (parameters.found.is_on) dissipations.push_back(kContactArea);
  if (parameters.found.is_on && parameters.found.damping > 0.0) dissipations.push_back(kContactDamping);
  if (dissipations.size() > kMostDissipations)
    throw Error(
        fmt::format("the laws of this body name {} kinds of dissipated energy; at most {} are counted",
                    dissipations.size(), kMostDissipations));
}

// The state of a checkpoint

template <int Dim>
void Body<Dim>::forget() {
  for_each_array(
      [](const ArrayInfo& info, auto& array) {
        if (info.lasts == Lasts::kept && !array.empty())
          std::memset(static_cast<void*>(array.data()), 0xff, bytes_of(array));
      },
      arrays);
  Vec<Dim> nothing;
  nothing.c.fill(std::numeric_limits<double>::quiet_NaN());
  for (auto* forces : {&arrays.contact_force, &arrays.turning_force})
    for (const int slot : layout.contact_slot)
      if (!forces->empty()) (*forces)[slot] = nothing;
  auto& corners = arrays.corner_force;
  if (!corners.empty()) std::fill(corners.begin(), corners.end() - kLanes, nothing);
  std::fill(arrays.crack_step.end() - kLanes, arrays.crack_step.end(), kNotCracked);  // the idle pack
}

/// Returns the chunks of an array that lasts; none for lists of constraints.
template <int Dim>
ChunkList Body<Dim>::chunks_of(const ArrayInfo& info, const void* array) const {
  const auto from = [](const ChunkList& items, auto first) {
    std::vector<int> begins;
    for (const int item : items.begins()) begins.push_back(first(item));
    return items.of(std::move(begins));
  };
  const Chunks& chunks = layout.chunks;
  const auto pack = [&](int bundle) { return layout.first_pack_of(bundle); };
  switch (info.per) {
    case Per::bundle:
      return chunks.bundles;
    case Per::gridpoint_pack:
      return from(chunks.bundles, pack);
    case Per::gridpoint_slot:
      return from(chunks.bundles, [&](int bundle) { return kLanes * pack(bundle); });
    case Per::face_pack:
      return chunks.face_packs;
    case Per::point_slot_or_idle:
      return from(chunks.face_packs, [&](int faces) { return kLanes * layout.first_point_of(faces); });
    default:
      break;
  }
  for (const auto& [lines, first] :
       {std::pair{&arrays.internals, &arrays.first_internal}, std::pair{&arrays.loss, &arrays.first_loss}})
    if (array == lines) return from(chunks.face_packs, [&, of = first](int faces) { return (*of)[faces]; });
  throw Error(fmt::format("\"{}\" has no form in which a state can keep it", info.name));  // a fault here
}

template <int Dim>
void Body<Dim>::visit_arrays(StateVisitor& visitor) {
  for_each_array(
      [&](const ArrayInfo& info, auto& array) {
        using T = std::decay_t<decltype(*array.data())>;
        if constexpr (!std::is_same_v<T, BundleConstraints> && !std::is_same_v<T, ConstraintPack<Dim>> &&
                      !std::is_same_v<T, Tie> && !std::is_integral_v<T> && !std::is_same_v<T, std::byte>)
          if (info.lasts == Lasts::kept) visitor.visit_by_chunk(info.name, array, chunks_of(info, &array));
      },
      arrays);
  if (visitor.replaces() && model.part) take_contacts_from_owners();
}

/// Gives contacts between an own block and one of an earlier rank the numbers that their owner keeps.
template <int Dim>
void Body<Dim>::take_contacts_from_owners() {
  std::size_t most = 0;
  for (const LawTable* law : laws) most = std::max(most, law->internals(Dim).size() + law->losses.size());
  const std::size_t of_each = most + 1;  // and the step of the crack
  std::vector<double> numbers(of_each * static_cast<std::size_t>(model.contact_count()));
  const auto move = [&](int contact, auto one) {
    const LawTable& law = law_of(contact);
    const int slot = layout.contact_slot[contact], lane = slot % kLanes;
    double* number = numbers.data() + of_each * static_cast<std::size_t>(contact);
    const auto move_lines = [&](auto& lines, const auto& first, std::size_t count) {
      Line* const line = lines_of(layout, lines, first, contact, count);
      for (std::size_t i = 0; i < count; ++i) one(*number++, line[i].number[lane]);
    };
    one(*number++, arrays.crack_step[slot]);
    move_lines(arrays.internals, arrays.first_internal, law.internals(Dim).size());
    move_lines(arrays.loss, arrays.first_loss, law.losses.size());
  };
  const ChunkList& chunks = layout.chunks.contacts;
  const ChunkList::Items own = chunks.own();
  for (int i = own.first; i < own.last; ++i)
    move(layout.contacts_by_chunk[i], [](double& number, double here) { number = here; });
  contact_halo(model).spread(numbers.data(), of_each);
  for (int chunk = 0; chunk < chunks.count(); ++chunk) {
    if (!chunks.is_foreign(chunk)) continue;
    const auto fill = [&](auto& array, const ArrayInfo& info, const auto& value) {
      const ChunkList of_array = chunks_of(info, &array);
      std::fill(array.begin() + of_array[chunk], array.begin() + of_array[chunk + 1], value);
    };
    fill(arrays.internals, {"internals", Per::entry}, Line{});  // idle lanes too
    fill(arrays.loss, {"loss", Per::entry}, Line{});
    fill(arrays.crack_step, {"crack_step", Per::point_slot_or_idle}, kNotCracked);
    for (int i = chunks[chunk]; i < chunks[chunk + 1]; ++i)
      move(layout.contacts_by_chunk[i], [](double number, double& here) { here = number; });
  }
}

template struct Body<2>;
template struct Body<3>;

}  // namespace pyroclast
