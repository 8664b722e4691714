#pragma once

#include <map>
#include <string>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/mechanics/motion.hpp"
#include "pyroclast/model/sets.hpp"

namespace pyroclast {

/// Load on a set of gridpoints from outside.
struct SetLoad {
  Vec<3> force{};         ///< total force, N; shared out by tributary areas, evenly where the set has no face
  double pressure = 0.0;  ///< pressure on the faces of the set, Pa; positive against the body
  bool is_follower =
      false;  ///< true: the pressure stays normal to the faces as they move; false: as they were at the start

  bool operator==(const SetLoad&) const = default;
};

/// Forces on named sets of gridpoints, which last until they are changed. Where sets overlap their forces add
/// up.
class Loads {
 public:
  /// \param motion  motion, kept by reference; must outlive this object
  /// \param size    size of the body, m, against which lengths are measured
  Loads(Motion& motion, double size) : motion_(motion), size_(size) {}

  bool empty() const { return entries_.empty(); }
  /// Returns the load on a set; none where the set was never loaded.
  SetLoad on(const std::string& set) const;
  /// Returns the load of each set that was ever loaded.
  std::map<std::string, SetLoad> all() const;
  bool acts_on(const std::string& set) const { return entries_.contains(set); }
  /// Returns the force on the body at a set by the set's own load, N.
  Vec<3> total(const std::string& set) const;
  /// Sets loads by set, from the next step on. Loads on other sets stay, but pressures that follow the body
  /// turn to its present place. Throws Error, and changes nothing, when there is no such set, a force is to
  /// act on a component that is held or driven, or a pressure on a set without faces.
  void set(const std::map<std::string, SetLoad>& loads);

  /// Returns the ways of all loaded sets along their loads, m.
  std::vector<double> ways() const;
  /// Marks the place from which `give` counts: the ways of the loaded sets there.
  void mark(const std::vector<double>& ways);
  /// Returns the longest way that a loaded set has gone along its load since the mark, over the size of the
  /// body.
  double give() const;

  void visit_state(StateVisitor& visitor);

 private:
  struct Entry {
    SetLoad load;
    GridpointSet set;
    std::vector<int> places;     ///< places of the set's gridpoints in loaded_
    std::vector<double> shares;  ///< shares of the force, by gridpoint of the set
    std::vector<Face> faces;     ///< faces of the outline in the set
    bool has_faces = false;      ///< true where the set of the whole has such faces
    double marked = 0.0;         ///< way along the load at the mark, m
  };

  Entry& entry(const std::string& set);
  void list_loaded();
  double way(const Entry& entry) const;
  std::vector<Vec<3>> forces(const Entry& entry) const;
  void apply();

  Motion& motion_;
  double size_;
  std::map<std::string, Entry> entries_;  ///< loads by set
  std::vector<int> loaded_;               ///< loaded gridpoints, ascending
};

}  // namespace pyroclast
