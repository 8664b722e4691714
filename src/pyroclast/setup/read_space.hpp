#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "pyroclast/base/vec.hpp"
#include "pyroclast/deck/deck.hpp"

namespace pyroclast {

/// Shapes of specimens in decks.
enum class Shape : std::uint8_t { rectangle, disc, ring, polygon, tessellation, cells, cylinder, polyhedra };

/// Space in which a deck describes its body: the plane, or space where the specimen has a depth.
struct DeckSpace {
  Shape shape = Shape::rectangle;
  std::optional<double> depth = std::nullopt;  ///< m; none in the plane, of a cylinder and of polyhedra

  bool is_solid() const { return depth || shape == Shape::cylinder || shape == Shape::polyhedra; }
  int dimension() const { return is_solid() ? 3 : 2; }
  /// Returns the coordinates of a point.
  Coordinates of_point() const { return {dimension(), false, 0.5 * depth.value_or(0.0)}; }
  /// Returns the coordinates of a place for which a pair stands for all z of a solid.
  Coordinates of_extrusion() const { return {dimension(), true, 0.0}; }
};

/// Reads the shape of the specimen and its depth, which say in which space everything else has its place.
/// Records errors in the deck.
DeckSpace read_space(const Section& root);

/// Returns a place as a vector, m.
Vec<3> vec_of(const StatedPlace& place);

/// Two places of a deck, m.
struct TwoPlaces {
  std::array<Vec<3>, 2> places{};
  bool is_along_z = false;  ///< true where they stand for all z of a solid
};

/// Reads two places. In a solid two pairs stand for all z between or along them.
TwoPlaces read_two_places(const Section& s, const char* key, const DeckSpace& space, Meaning meaning);

/// Records an error where two places are not the lower and the upper corner of a box.
void require_upright(const Section& s, const char* key, const TwoPlaces& box);

}  // namespace pyroclast
