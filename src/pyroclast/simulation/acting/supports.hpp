#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/model/model.hpp"

namespace pyroclast {

class Simulation;

/// Motion of a set along a component that it holds: at rest, or driven.
struct HeldMotion {
  double velocity = 0.0;   ///< m/s; 0 at rest
  double ramp_time = 0.0;  ///< s
  bool is_free = false;    ///< true for a motion over time of its own, which is like no other

  bool is_like(const HeldMotion& other) const {
    return !is_free && !other.is_free && velocity == other.velocity && ramp_time == other.ramp_time;
  }
};

/// Supports: the sets that hold components of their gridpoints. A component of a gridpoint is held while any
/// set holds it, whatever other sets with the gridpoint do; so neither the order of tables nor the order of
/// stages matters. Sets that share a gridpoint may hold it alike, and not otherwise.
///
/// The class serves a run, and the check of its stages before it.
class Supports {
 public:
  /// Holds what lies in the body's planes of symmetry.
  explicit Supports(const Model& model);

  /// Lets a set take hold of a component, or go on holding it in another way. Throws Error, which names both
  /// places, where another set holds one of its gridpoints in an unlike way.
  ///
  /// \param place  place in the deck, for messages
  void hold(const std::string& set, int component, const HeldMotion& motion, const std::string& place);
  /// Lets a set release a component. Throws Error where the set does not hold the component: then another set
  /// holds its gridpoints, or none does. Planes of symmetry release nothing.
  void release(const std::string& set, int component, const std::string& place);
  /// Brings a set that is driven to rest from now on.
  void halt(const std::string& set, int component);

  bool holds(const std::string& set, int component) const { return held_.contains({set, component}); }
  bool holds(int gridpoint, int component) const { return holders_[gridpoint][component] > 0; }
  /// Returns how many sets hold a component: each bears an even share of the reaction.
  int holders(int gridpoint, int component) const { return holders_[gridpoint][component]; }
  /// Returns the place where one of the sets took hold of a component; empty where none holds it.
  std::string place_of(int gridpoint, int component) const;

  /// Describes a motion of the body as a whole that nothing hinders: "along x"; empty where there is none.
  std::optional<std::string> free_motion() const;

  void visit_state(StateVisitor& visitor);

 private:
  struct Held {
    HeldMotion motion;
    std::string place;
  };
  void count(const std::string& set, int component, int more);

  const Model& model_;
  std::map<std::pair<std::string, int>, Held> held_;  ///< holds by set and component
  std::vector<std::array<int, 3>> holders_;           ///< number of holders by gridpoint and component
};

bool has_weight(const Simulation& simulation);

/// Throws Error where nothing hinders the body from moving as a whole, and no press holds it.
/// \param what  action that is about to begin, for the message
void require_held(const Simulation& simulation, const Supports& supports, const std::string& what);

}  // namespace pyroclast
