#pragma once

#include <array>
#include <set>
#include <utility>
#include <vector>

#include "pyroclast/mechanics/mechanics.hpp"
#include "pyroclast/model/model.hpp"

/// Parts of a body, each made alone: one chunk, and of the others the blocks that touch it.
namespace pyroclast::parts {

template <int Dim>
struct Part {
  ModelOf<Dim> model;
  int chunk = 0;  ///< of the part's model, the one that it owns
  // numbers in the whole of the part's items
  std::vector<int> block, gridpoint, zone, contact;
};

/// Blocks of the chunk and those that share a face with one of them, or a place.
/// \param places  number of each gridpoint's place, below 0 for none; empty: no gridpoint has a place
template <int Dim>
std::set<int> blocks_at(const ModelOf<Dim>& whole, int chunk, const std::vector<int>& places) {
  const auto is_own = [&](int block) {
    return block >= whole.chunk_blocks[chunk] && block < whole.chunk_blocks[chunk + 1];
  };
  std::set<int> blocks;
  for (int b = whole.chunk_blocks[chunk]; b < whole.chunk_blocks[chunk + 1]; ++b) blocks.insert(b);
  for (const auto& c : whole.contacts) {
    const int a = whole.block_of(c.a), b = whole.block_of(c.b);
    if (is_own(a)) blocks.insert(b);
    if (is_own(b)) blocks.insert(a);
  }
  std::set<int> own_places;
  for (int g = 0; g < static_cast<int>(places.size()); ++g)
    if (places[g] >= 0 && is_own(whole.block_of(g))) own_places.insert(places[g]);
  for (int g = 0; g < static_cast<int>(places.size()); ++g)
    if (own_places.contains(places[g])) blocks.insert(whole.block_of(g));
  return blocks;
}

/// \param places  see blocks_at; with them the part also has the faces between foreign blocks
template <int Dim>
Part<Dim> part_of(const ModelOf<Dim>& whole, int chunk, const std::vector<int>& places = {}) {
  const std::set<int> blocks = blocks_at(whole, chunk, places);
  Part<Dim> part;
  ModelOf<Dim>& model = part.model;
  model.thickness = whole.thickness;
  model.material_names = whole.material_names;
  model.interface_names = whole.interface_names;
  model.bearing_materials = whole.bearing_materials;
  model.bearing_interfaces = whole.bearing_interfaces;
  model.zones_of_whole = whole.zone_count();
  std::vector<int> here(whole.position.size(), -1);
  model.chunk_blocks = {};
  for (int c = 0; c + 1 < static_cast<int>(whole.chunk_blocks.size()); ++c) {
    const int first = static_cast<int>(part.block.size());
    for (int b = whole.chunk_blocks[c]; b < whole.chunk_blocks[c + 1]; ++b) {
      if (!blocks.contains(b)) continue;
      part.block.push_back(b);
      model.block_material.push_back(whole.block_material[b]);
      for (int g = whole.block_gridpoints[b]; g < whole.block_gridpoints[b + 1]; ++g) {
        here[g] = static_cast<int>(part.gridpoint.size());
        part.gridpoint.push_back(g);
        model.position.push_back(whole.position[g]);
      }
      for (int z = whole.block_zones[b]; z < whole.block_zones[b + 1]; ++z) {
        part.zone.push_back(z);
        auto zone = whole.zones[z];
        for (int& g : zone) g = here[g];
        model.zones.push_back(zone);
      }
      model.block_gridpoints.push_back(static_cast<int>(model.position.size()));
      model.block_zones.push_back(static_cast<int>(model.zones.size()));
    }
    if (first == static_cast<int>(part.block.size())) continue;
    if (c == chunk) part.chunk = static_cast<int>(model.chunk_blocks.size());
    model.chunk_blocks.push_back(first);
    model.foreign_chunks.push_back(c != chunk);
  }
  model.chunk_blocks.push_back(static_cast<int>(part.block.size()));
  for (int f = 0; f < whole.face_count(); ++f) {
    const auto& of_face = whole.contacts[whole.face_contacts[f]];
    if (here[of_face.a] < 0 || here[of_face.b] < 0) continue;
    const auto is_own = [&](int g) {
      const int b = whole.block_of(g);
      return b >= whole.chunk_blocks[chunk] && b < whole.chunk_blocks[chunk + 1];
    };
    if (places.empty() && !is_own(of_face.a) && !is_own(of_face.b)) continue;
    const int face = model.face_count();
    for (int c = whole.face_contacts[f]; c < whole.face_contacts[f + 1]; ++c) {
      auto contact = whole.contacts[c];
      contact.a = here[contact.a];
      contact.b = here[contact.b];
      contact.face = face;
      model.contacts.push_back(contact);
      part.contact.push_back(c);
    }
    model.face_contacts.push_back(static_cast<int>(model.contacts.size()));
  }
  return part;
}

/// Every chunk's part.
template <int Dim>
std::vector<Part<Dim>> all_parts(const ModelOf<Dim>& whole, const std::vector<int>& places = {}) {
  std::vector<Part<Dim>> parts;
  for (int chunk = 0; chunk < whole.chunks().count(); ++chunk) parts.push_back(part_of(whole, chunk, places));
  return parts;
}

/// The same things of the whole, in the order of a part.
template <class T>
std::vector<T> some_of(const std::vector<T>& all, const std::vector<int>& numbers) {
  std::vector<T> some;
  for (const int number : numbers) some.push_back(all[number]);
  return some;
}

/// A set of the whole, as far as it lies in the part.
template <int Dim>
std::vector<int> set_in(const Part<Dim>& part, const std::vector<int>& set) {
  const std::set<int> all(set.begin(), set.end());
  std::vector<int> some;
  for (int g = 0; g < static_cast<int>(part.gridpoint.size()); ++g)
    if (all.contains(part.gridpoint[g])) some.push_back(g);
  return some;
}

template <int Dim>
BodyProperties properties_in(const Part<Dim>& part, const BodyProperties& whole) {
  BodyProperties properties;
  properties.contacts = whole.contacts;
  properties.zones = some_of(whole.zones, part.zone);
  properties.of_contact = some_of(whole.of_contact, part.contact);
  if (!whole.creep.empty()) properties.creep = some_of(whole.creep, part.zone);
  return properties;
}

}  // namespace pyroclast::parts
