#pragma once

#include <span>
#include <vector>

#include "pyroclast/base/kept_sums.hpp"
#include "pyroclast/mechanics/body.hpp"

namespace pyroclast {

/// Parameters of zones and contacts in the places where a step reads them, and the creep of zones.
template <int Dim>
class Properties {
 public:
  explicit Properties(Body<Dim>& body) : body_(body) {}

  /// Puts zone and contact parameters in their places.
  void place();
  /// Tells whether zones of this rank creep.
  bool creep_here(const std::vector<CreepIncrement>& creep) const;
  /// Begins creep with the stress that zones have by the properties that there are.
  void begin_creep(const std::vector<CreepIncrement>& creep);
  /// Strains of the second half of the creep under way, and the work of both halves.
  struct EndOfCreep {
    std::vector<SymmetricTensor<Dim>> strain;  ///< strains by zone
    KeptSums work;                             ///< J
  };
  /// Returns the end of the creep under way with the present stress, which stays as it is.
  EndOfCreep end_of_creep() const;
  void end_creep(const EndOfCreep& end);
  /// Breaks a contact from the start: neither tension nor cohesion ever held it. Returns false where the law
  /// of the contact has no damage; the contact then holds.
  [[nodiscard]] bool break_contact(int contact);
  /// Puts the pressures of pore water in their places.
  void place_pore_pressure();
  void visit_state(StateVisitor& visitor);

 private:
  void place_creep_strain();
  void place_contact_properties();
  std::vector<int> find_sets_of_faces();
  void place_own_constants();
  void visit_contacts_sets(StateVisitor& visitor);
  std::vector<ContactProperties> visit_sets_of_interfaces(StateVisitor& visitor);
  void add_set(const StateVisitor& visitor, const LawTable& law, std::span<const int> choices,
               std::span<const double> numbers);
  void take_sets_from_owners();

  Body<Dim>& body_;
};

extern template class Properties<2>;
extern template class Properties<3>;

}  // namespace pyroclast
