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

/// How a set moves along a component that it holds: at rest, or driven.
struct HeldMotion {
  double velocity = 0.0;   ///< m/s; 0 at rest
  double ramp_time = 0.0;  ///< s
  bool is_free = false;    ///< of a course of its own over time, which is like no other

  bool is_like(const HeldMotion& other) const {
    return !is_free && !other.is_free && velocity == other.velocity && ramp_time == other.ramp_time;
  }
};

/// Which sets hold which components of their gridpoints. A component of a gridpoint is held while any set
/// holds it, whatever other sets that have the gridpoint do; so neither the order of tables nor that of
/// stages matters. Sets that share a gridpoint may hold it alike, and not otherwise.
///
/// Serves a run, and the check of its stages before it.
template <int Dim>
class Supports {
 public:
  explicit Supports(const Model<Dim>& model) : model_(model), holders_(model.position.size()) {}

  /// A set takes hold of a component, or goes on holding it in another way. Throws Error, which names both
  /// places, where another set holds one of its gridpoints in an unlike way.
  ///
  /// \param place  in the deck, for messages
  void hold(const std::string& set, int component, const HeldMotion& motion, const std::string& place);
  /// It does so no longer. Throws Error where it does not hold the component: what holds its gridpoints there
  /// is another set, or nothing.
  void release(const std::string& set, int component, const std::string& place);
  /// Who is driven rests from now on.
  void halt(const std::string& set, int component);

  bool holds(const std::string& set, int component) const { return held_.contains({set, component}); }
  bool holds(int gridpoint, int component) const { return holders_[gridpoint][component] > 0; }
  /// How many sets hold it: each bears an even share of the reaction.
  int holders(int gridpoint, int component) const { return holders_[gridpoint][component]; }
  /// Where one of them took hold of it; empty where none does.
  std::string place_of(int gridpoint, int component) const;

  /// A motion of the body as a whole that nothing hinders, in words: "along x"; empty where there is none.
  std::optional<std::string> free_motion() const;

  void visit_state(StateVisitor& visitor);

 private:
  struct Held {
    HeldMotion motion;
    std::string place;
  };
  void count(const std::string& set, int component, int more);

  const Model<Dim>& model_;
  std::map<std::pair<std::string, int>, Held> held_;  ///< by set and component
  std::vector<std::array<int, Dim>> holders_;         ///< by gridpoint and component
};

template <>
std::optional<std::string> Supports<2>::free_motion() const;

bool has_weight(const Simulation& simulation);

/// Throws Error where nothing hinders the body from moving as a whole, and no press holds it.
/// \param what  is about to be done to it, for the message
void require_held(const Simulation& simulation, const Supports<2>& supports, const std::string& what);

}  // namespace pyroclast
