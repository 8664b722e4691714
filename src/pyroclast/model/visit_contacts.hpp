#pragma once

#include <string_view>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/model/item_halo.hpp"

namespace pyroclast {

/// Shows numbers of contacts to a visitor, chunk by chunk: a collective. Contacts of other ranks get those of
/// their owners.
/// \tparam Numbers  a type made of nothing but doubles
template <class Numbers>
void visit_contacts(StateVisitor& visitor, std::string_view name, const Model& model,
                    std::vector<Numbers>& of_contacts, const StateRule& rule = state::finite()) {
  const ContactsByChunk all = contacts_by_chunk(model);
  std::vector<Numbers> by_chunk;
  by_chunk.reserve(all.contacts.size());
  for (const int contact : all.contacts) by_chunk.push_back(of_contacts[contact]);
  visitor.visit_by_chunk(name, by_chunk, all.chunks, rule);
  if (!visitor.replaces()) return;
  for (std::size_t i = 0; i < by_chunk.size(); ++i) of_contacts[all.contacts[i]] = by_chunk[i];
  contact_halo(model).spread(of_contacts);
}

}  // namespace pyroclast
