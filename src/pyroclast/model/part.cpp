#include "pyroclast/model/part.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

/// Copies of the whole's named lists those items that stand in the part.
/// \param here  number in the part of each item, -1 for others
template <class Sets>
Sets cut_sets(const Sets& whole, const std::vector<int>& here) {
  Sets cut;
  for (const auto& [name, items] : whole) {
    std::vector<int>& own = cut[name];
    for (const int item : items)
      if (here[item] >= 0) own.push_back(here[item]);
  }
  return cut;
}

}  // namespace

std::vector<int> ranks_of_chunks(const std::vector<int>& zones, int ranks) {
  const int count = static_cast<int>(zones.size()) - 1;
  if (ranks > count)
    throw Error(
        fmt::format("{} ranks cannot share a body of {} chunks: take {} ranks at most, or more blocks", ranks,
                    count, count));
  std::vector<int> rank;
  for (int c = 0; c < count; ++c) {
    const std::int64_t twice_the_middle = zones[c] + zones[c + 1];
    const auto by_zones = static_cast<int>(twice_the_middle * ranks / (2 * std::int64_t{zones.back()}));
    const int least = std::max(rank.empty() ? 0 : rank.back(), ranks - (count - c));
    const int most = rank.empty() ? 0 : rank.back() + 1;  // no rank is passed over
    rank.push_back(std::clamp(by_zones, least, std::max(least, most)));
  }
  return rank;
}

std::vector<int> ranks_of_chunks(const Model& whole, int ranks) {
  std::vector<int> zones;
  for (const int block : whole.chunk_blocks) zones.push_back(whole.block_zones[block]);
  return ranks_of_chunks(zones, ranks);
}

std::vector<std::vector<int>> neighbours_of_chunks(const Model& whole) {
  const std::vector<int> chunk_of = whole.gridpoint_chunks().of_items();
  std::vector<int> root(chunk_of.size());  // of the gridpoints in one place
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int gridpoint) {
    while (root[gridpoint] != gridpoint) gridpoint = root[gridpoint] = root[root[gridpoint]];
    return gridpoint;
  };
  for (int c = 0; c < whole.contact_count(); ++c) root[find(whole.joint(c).a)] = find(whole.joint(c).b);
  std::map<int, std::set<int>> chunks_at;  // by root, where a place is in several chunks
  for (int g = 0; g < whole.gridpoint_count(); ++g)
    if (chunk_of[g] != chunk_of[find(g)]) chunks_at[find(g)].insert({chunk_of[g], chunk_of[find(g)]});
  std::vector<std::set<int>> with(static_cast<std::size_t>(whole.chunks().count()));
  for (const auto& [at, chunks] : chunks_at)
    for (const int c : chunks) with[static_cast<std::size_t>(c)].insert(chunks.begin(), chunks.end());
  std::vector<std::vector<int>> neighbours;
  for (std::size_t c = 0; c < with.size(); ++c) {
    with[c].erase(static_cast<int>(c));
    neighbours.emplace_back(with[c].begin(), with[c].end());
  }
  return neighbours;
}

template <int Dim>
ModelOf<Dim> part_of(const ModelOf<Dim>& whole, std::shared_ptr<Ranks> ranks,
                     const std::vector<int>& rank_of_chunk, const std::vector<int>& nodes,
                     ForeignBlocks foreign) {
  const int me = ranks->me(), blocks = whole.block_count();
  const std::vector<int> chunk_of = whole.chunks().of_items();
  const std::vector<int> block_of = gridpoint_blocks(whole);
  const auto is_own = [&](int gridpoint) { return rank_of_chunk[chunk_of[block_of[gridpoint]]] == me; };

  const bool holds_all = foreign == ForeignBlocks::all;
  std::vector<bool> is_in(static_cast<std::size_t>(blocks));
  for (int b = 0; b < blocks; ++b) is_in[b] = holds_all || rank_of_chunk[chunk_of[b]] == me;
  for (const Contact<Dim>& contact : whole.contacts)
    if (is_own(contact.a) || is_own(contact.b))
      is_in[block_of[contact.a]] = is_in[block_of[contact.b]] = true;
  std::vector<bool> is_own_node(nodes.size());
  for (std::size_t g = 0; g < nodes.size(); ++g)
    if (nodes[g] >= 0 && is_own(static_cast<int>(g))) is_own_node[nodes[g]] = true;
  for (std::size_t g = 0; g < nodes.size(); ++g)
    if (nodes[g] >= 0 && is_own_node[nodes[g]]) is_in[block_of[g]] = true;

  ModelOf<Dim> part;
  part.thickness = whole.thickness;
  part.material_names = whole.material_names;
  part.interface_names = whole.interface_names;
  part.bearing_materials = whole.bearing_materials;
  part.bearing_interfaces = whole.bearing_interfaces;
  part.symmetry = whole.symmetry;
  part.chunk_blocks.clear();
  PartOfBody of;
  of.zones_of_whole = whole.whole_zone_count();
  std::vector<int> here(whole.position.size(), -1);
  for (int b = 0; b < blocks; ++b) {
    if (!is_in[b]) continue;
    if (of.chunk.empty() || of.chunk.back() != chunk_of[b]) {
      of.chunk.push_back(chunk_of[b]);
      of.rank_of_chunk.push_back(rank_of_chunk[chunk_of[b]]);
      part.chunk_blocks.push_back(part.block_count());
    }
    of.block.push_back(b);
    part.block_material.push_back(whole.block_material[b]);
    for (int g = whole.block_gridpoints[b]; g < whole.block_gridpoints[b + 1]; ++g) {
      here[g] = static_cast<int>(of.gridpoint.size());
      of.gridpoint.push_back(g);
      part.position.push_back(whole.position[g]);
    }
    for (int z = whole.block_zones[b]; z < whole.block_zones[b + 1]; ++z) {
      of.zone.push_back(z);
      auto zone = whole.zones[z];
      for (int& g : zone) g = here[g];
      part.zones.push_back(zone);
    }
    part.block_gridpoints.push_back(static_cast<int>(part.position.size()));
    part.block_zones.push_back(static_cast<int>(part.zones.size()));
  }
  part.chunk_blocks.push_back(part.block_count());

  const auto has_face = [&](int face) {
    const Contact<Dim>& first = whole.contacts[whole.face_contacts[face]];
    return here[first.a] >= 0 && here[first.b] >= 0 &&
           (holds_all || !nodes.empty() || is_own(first.a) || is_own(first.b));
  };
  std::size_t contacts = 0;
  for (int f = 0; f < whole.face_count(); ++f)
    if (has_face(f)) contacts += whole.face_contacts[f + 1] - whole.face_contacts[f];
  part.contacts.reserve(contacts);
  std::vector<int> contact_here(whole.contacts.size(), -1);
  for (int f = 0; f < whole.face_count(); ++f) {
    if (!has_face(f)) continue;
    const int face = part.face_count();
    for (int c = whole.face_contacts[f]; c < whole.face_contacts[f + 1]; ++c) {
      Contact<Dim> contact = whole.contacts[c];
      contact.a = here[contact.a];
      contact.b = here[contact.b];
      contact.face = face;
      contact_here[c] = static_cast<int>(of.contact.size());
      of.contact.push_back(c);
      part.contacts.push_back(contact);
    }
    part.face_contacts.push_back(static_cast<int>(part.contacts.size()));
  }
  part.sets = cut_sets(whole.sets, here);
  part.contact_sets = cut_sets(whole.contact_sets, contact_here);
  if (whole.part) {
    const PartOfBody& given = *whole.part;
    for (const auto& [numbers, of_whole] :
         {std::pair(&of.chunk, &given.chunk), std::pair(&of.block, &given.block),
          std::pair(&of.gridpoint, &given.gridpoint), std::pair(&of.zone, &given.zone),
          std::pair(&of.contact, &given.contact)})
      for (int& number : *numbers) number = (*of_whole)[number];
  }
  of.ranks = std::move(ranks);
  part.part = std::make_shared<const PartOfBody>(std::move(of));
  return part;
}

std::unique_ptr<Model> part_of(const Model& whole, std::shared_ptr<Ranks> ranks,
                               const std::vector<int>& nodes, ForeignBlocks foreign) {
  const auto rank_of_chunk = whole.part ? whole.part->rank_of_chunk : ranks_of_chunks(whole, ranks->count());
  return with_dimension(whole, [&]<int Dim>(const ModelOf<Dim>& of_dimension) -> std::unique_ptr<Model> {
    return std::make_unique<ModelOf<Dim>>(part_of(of_dimension, ranks, rank_of_chunk, nodes, foreign));
  });
}

std::map<int, SharedGridpoints> shared_gridpoints(const Model& part) {
  const std::vector<int> chunk_of = part.gridpoint_chunks().of_items();
  const int me = part.ranks().me();
  const auto rank_of = [&](int gridpoint) { return part.part->rank_of_chunk[chunk_of[gridpoint]]; };
  std::map<int, SharedGridpoints> with;
  const auto add = [&](int own, int foreign) {
    if (rank_of(own) != me || rank_of(foreign) == me) return;
    SharedGridpoints& shared = with[rank_of(foreign)];
    shared.own.insert(own);
    shared.foreign.insert(foreign);
  };
  for (int c = 0; c < part.contact_count(); ++c) {
    const Joint& contact = part.joint(c);
    add(contact.a, contact.b);
    add(contact.b, contact.a);
  }
  return with;
}

template ModelOf<2> part_of(const ModelOf<2>&, std::shared_ptr<Ranks>, const std::vector<int>&,
                            const std::vector<int>&, ForeignBlocks);
template ModelOf<3> part_of(const ModelOf<3>&, std::shared_ptr<Ranks>, const std::vector<int>&,
                            const std::vector<int>&, ForeignBlocks);

}  // namespace pyroclast
