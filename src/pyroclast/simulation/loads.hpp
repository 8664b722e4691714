#pragma once

#include <map>
#include <string>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/mechanics/mechanics.hpp"

namespace pyroclast {

/// What acts on a set of gridpoints from outside.
template <int Dim>
struct SetLoad {
  Vec<Dim> force{};       ///< in all, N; shared out by tributary areas, evenly where the set has no face
  double pressure = 0.0;  ///< on the faces of the set, Pa; positive against the body
  bool is_follower =
      false;  ///< the pressure stays normal to the faces as they move, else as they were at the start
};

/// Forces on named sets of gridpoints, which last until they are changed. Where sets overlap they add up.
template <int Dim>
class Loads {
 public:
  /// \param mechanics  kept by reference; must outlive this
  /// \param size       of the body, m: what lengths are measured by
  Loads(Mechanics<Dim>& mechanics, double size) : mechanics_(mechanics), size_(size) {}

  bool empty() const { return entries_.empty(); }
  /// None where the set was never loaded.
  SetLoad<Dim> on(const std::string& set) const;
  /// Of each set that was ever loaded.
  std::map<std::string, SetLoad<Dim>> all() const;
  bool acts_on(const std::string& set) const { return entries_.contains(set); }
  /// What acts on the body at the set by its own load, N.
  Vec<Dim> total(const std::string& set) const;
  /// By set, from the next step on; other sets stay as they are, but that pressures which follow the body
  /// turn to where it is now. Throws Error, and changes nothing, when there is no such set, a force is to act
  /// on a component that is held or driven, or a pressure on a set without faces.
  void set(const std::map<std::string, SetLoad<Dim>>& loads);

  /// Takes the present place of the loaded sets for that from which `give` counts.
  void mark();
  /// The longest way that a loaded set has made along its load since the mark, over the size of the body.
  double give() const;

  void visit_state(StateVisitor& visitor);

 private:
  struct Entry {
    SetLoad<Dim> load;
    GridpointSet set;
    std::vector<int> places;                  ///< of its gridpoints in loaded_
    std::vector<double> shares;               ///< of the force, by gridpoint of the set
    std::vector<std::array<int, Dim>> faces;  ///< right-handed, the normal outwards
    double marked = 0.0;                      ///< way along the load at the mark, m
  };

  Entry& entry(const std::string& set);
  void list_loaded();
  double way(const Entry& entry) const;
  std::vector<Vec<Dim>> forces(const Entry& entry) const;
  void apply();

  Mechanics<Dim>& mechanics_;
  double size_;
  std::map<std::string, Entry> entries_;  ///< by set
  std::vector<int> loaded_;               ///< gridpoints of all, ascending
};

extern template class Loads<2>;
extern template class Loads<3>;

}  // namespace pyroclast
