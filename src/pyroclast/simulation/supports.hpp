#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/model/model.hpp"

namespace pyroclast {

class Simulation;

/// What of a body is held or driven, as far as it can be foreseen, so that decks are checked before they run.
template <int Dim>
class Supports {
 public:
  explicit Supports(const Model<Dim>& model) : model_(model), held_(model.position.size()) {}

  void hold(int gridpoint, int component) { held_[gridpoint][component] = true; }
  void release(int gridpoint, int component) { held_[gridpoint][component] = false; }
  bool holds(int gridpoint, int component) const { return held_[gridpoint][component]; }

  /// A motion of the body as a whole that nothing hinders, in words: "along x"; empty where there is none.
  std::optional<std::string> free_motion() const;

 private:
  const Model<Dim>& model_;
  std::vector<std::array<bool, Dim>> held_;  ///< by gridpoint and component
};

template <>
std::optional<std::string> Supports<2>::free_motion() const;

/// What is held or driven now.
Supports<2> supports_of(const Simulation& simulation);

bool has_weight(const Simulation& simulation);

/// Throws Error where nothing hinders the body from moving as a whole, and no press holds it.
/// \param what  is about to be done to it, for the message
void require_held(const Simulation& simulation, const Supports<2>& supports, const std::string& what);

}  // namespace pyroclast
