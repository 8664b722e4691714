#include "pyroclast/mechanics/gone.hpp"

#include <algorithm>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/mechanics/reader.hpp"

namespace pyroclast {

template <int Dim>
void GoneBlocks<Dim>::book(const std::vector<int>& blocks) {
  const Reader<Dim> read(body_);
  const ModelOf<Dim>& model = body_.model;
  for (const int block : blocks)
    for (int g = model.block_gridpoints[block]; g < model.block_gridpoints[block + 1]; ++g) {
      if (body_.state.weighs())
        body_.books.gravity +=
            body_.gravity_mass[g] * dot(body_.state.gravity, read.displacement_of_force(g));
      const Vec<Dim> v = read.velocity(g);  // of the half step that has begun
      body_.books.begun_removed += 0.5 * body_.mass[g] * dot(v, v);
    }
}

template <int Dim>
void GoneBlocks<Dim>::remove(const std::vector<int>& blocks) {
  const ModelOf<Dim>& model = body_.model;
  body_.gone.resize(static_cast<std::size_t>(model.block_count()));
  body_.left.resize(model.position.size());
  for (const int block : blocks) {
    body_.gone[block] = true;
    for (int g = model.block_gridpoints[block]; g < model.block_gridpoints[block + 1]; ++g) {
      const int slot = body_.layout.gridpoint_slot[g];
      set_vector<Dim>(body_.state.velocity, slot, {});
      body_.left[g] = true;
      body_.gravity_mass[g] = 0.0;
      if (body_.state.weighs()) body_.arrays.real_mass[slot] = 0.0;
      --body_.gridpoints_of_whole;
    }
  }
  body_.real_mass = chunked_sum(body_.layout.chunks.gridpoints, [&](int g) { return body_.gravity_mass[g]; });
  for (const Contact<Dim>& contact : model.contacts)
    if (body_.has_left(contact)) body_.leave_out(contact.face);
  leave_out_of(body_.properties);
}

template <int Dim>
void GoneBlocks<Dim>::leave_out_of(BodyProperties& properties) const {
  const ModelOf<Dim>& model = body_.model;
  for (int b = 0; b < std::ssize(body_.gone); ++b)
    if (body_.gone[b])
      for (int z = model.block_zones[b]; z < model.block_zones[b + 1]; ++z) {
        properties.zones[z] = {};
        if (!properties.creep.empty()) properties.creep[z] = {};
        if (body_.creeps()) body_.creep_strain[z] = {};
      }
  for (std::size_t c = 0; c < properties.pore_pressure.size(); ++c)
    if (body_.has_left(model.contacts[c])) properties.pore_pressure[c] = 0.0;
}

template <int Dim>
void GoneBlocks<Dim>::visit_state(StateVisitor& visitor) {
  std::vector<int> blocks;
  for (int b = 0; b < std::ssize(body_.gone); ++b)
    if (body_.gone[b]) blocks.push_back(b);
  const bool is_whole = blocks.empty();
  visitor.visit("gone", blocks, state::index(static_cast<std::size_t>(body_.model.block_count())));
  visitor.visit("removed", body_.books.removed);
  visitor.visit("begun_removed", body_.books.begun_removed);
  visitor.visit("gravity_of_gone", body_.books.gravity);
  if (!visitor.replaces()) return;
  visitor.require(is_whole, "gone", "cannot come back to a body that has lost blocks already");
  visitor.require(std::ranges::is_sorted(blocks) && std::ranges::adjacent_find(blocks) == blocks.end(),
                  "gone", "must come once each, in order");
  if (!blocks.empty()) remove(blocks);
}

template class GoneBlocks<2>;
template class GoneBlocks<3>;

}  // namespace pyroclast
