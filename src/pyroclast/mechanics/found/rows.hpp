#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pyroclast/mechanics/found/triangle_pair.hpp"
#include "pyroclast/mechanics/state.hpp"

/// Rows of found contacts, as a step sees them; found.hpp explains the words.
namespace pyroclast {

/// Most contact points of a pair of facets: the ends or corners of their overlap.
template <int Dim>
inline constexpr int kPointsOfPair = Dim == 2 ? 2 : Overlap::kMost;
/// Sets of parameters of a pair: in the plane each end has its own.
template <int Dim>
inline constexpr int kSetsOfPair = Dim == 2 ? 2 : 1;
/// Returns the set of parameters of a point, among those of its pair.
template <int Dim>
constexpr int set_of_point(int point) {
  return point < kSetsOfPair<Dim> ? point : 0;
}

/// Law as rows need it.
struct LawOfRows {
  static constexpr int kMost = 16;  ///< most internal variables, and most losses

  int internals = 0, losses = 0, constants = 0;
  int held_jump = -1;      ///< place of the internal variable of this name; -1: none
  int slip = -1;           ///< likewise, of its first component
  double broken[kMost]{};  ///< internal variables of a point that is broken and was never touched
};

/// Shapes of eight pairs.
template <int Dim>
struct ShapesOfRow;

template <>
struct ShapesOfRow<2> {
  Line unloaded_a, unloaded_b;  ///< lengths of the edges without load, m
};

/// Places of the corners of a pair of triangles.
using TriangleCorners = std::array<Vec<3>, 6>;

template <>
struct ShapesOfRow<3> {
  /// Corners side by side.
  using Places = std::array<std::array<Vec<3>, kLanes>, 6>;

  /// Places of the corners in the last step in which the pair pressed, from which jumps go on, m.
  alignas(64) Places pressed_at;
  std::array<Overlap, kLanes> overlap;  ///< overlap there; its count is 0 where the pair did not press
  std::uint32_t had;                    ///< bits of the lanes where it is not
  // What follows from places, kept because it changes seldom.
  std::array<Overlap, kLanes>
      seen;               ///< overlap in the last step in which corners lay on other sides of edges
  OverlapsInLanes names;  ///< names of its corners
  Line sides;             ///< see FoundContactForces::Sides; less than 0 where not known
  /// Bits of the lanes where `seen` has other corners than `overlap`, and where it may have other numbers.
  std::uint32_t changed, renewed;
  std::array<std::uint8_t, Overlap::kMost> silent_points;  ///< bits of the points that never press
  std::array<std::uint32_t, kLanes> joined;  ///< bits of the corners that an unbroken contact joins
  std::uint32_t asked;                       ///< bits of the lanes whose overlap the last step went through
};

/// Returns the corners of one pair of several.
TriangleCorners corners_in(const ShapesOfRow<3>::Places& places, int lane);
/// Returns triangle a or b of a pair.
Triangle triangle_a(const TriangleCorners& corners);
Triangle triangle_b(const TriangleCorners& corners);
/// Returns the overlap of a pair.
Overlap overlap_of(const TriangleCorners& corners);

/// Eight pairs side by side.
template <int Dim>
struct alignas(64) FoundRow : ShapesOfRow<Dim> {
  static constexpr int kPoints = kPointsOfPair<Dim>, kCorners = 2 * Dim;
  /// Components of a tangential jump.
  using Jump = std::array<Line, Dim - 1>;

  std::array<std::array<int, kLanes>, kCorners> corners;  ///< offsets of the corners of a, then of b
  Line thickness;    ///< thickness of the body (3D: 1) times the pair's ratio, m; 0 where idle
  Line most_depth;   ///< depth from which on a point does not count, m
  Line not_counted;  ///< m, or m²
  Line area[kPoints];
  Jump held[kPoints], shift[kPoints];
  Line offset[kPoints], rest[kPoints];            ///< see PairPoint
  Line shear_stiffness[kSetsOfPair<Dim>];         ///< Pa/m
  Line damping;                                   ///< coefficient of damping, Pa s/m
  Line damped[kPoints];                           ///< see PairPoint
  Line stored, applied, lost_area, lost_damping;  ///< see FoundPair
  std::array<std::uint32_t, 2> counts;            ///< bits of the lanes whose end may press; plane only
  std::uint32_t handed_over;                      ///< bits of the lanes whose pair is handed over
  double wakes;  ///< FoundRows::way below which no pair of the row can press or change
  bool rests;    ///< true where no pair pressed in the last step, and all that follows from it is written
  int law;       ///< entry of State::laws and FoundRows::laws
  int first_internal;  ///< first line of FoundRows::internals, of the first point and then the others
  int first_loss;      ///< first line of FoundRows::lost
  int first_constant;  ///< first line of FoundRows::constants, of the first set and then the others
  int first_choice;    ///< first byte of FoundRows::choices: constants of which the choices count
};

/// Gridpoint on which rows act.
struct LoadedGridpoint {
  int slot = 0;
  int first_force = 0, last_force = 0;  ///< entries of FoundRows::acting
  double wakes = 0.0;                   ///< least of the rows
};

/// Pack of gridpoints of free facets.
struct WatchedPack {
  Line over_way;  ///< one over the square of the way that each may go before the next search, 1/m²
  int pack = 0;
};

/// Arrays of found contacts as a step needs them, owned (FlatArray) or seen (View).
template <int Dim, template <class> class Array>
struct FoundArrays {
  Array<LawOfRows> laws;  ///< in the order of State::laws
  Array<FoundRow<Dim>> rows;
  Array<Line> internals, lost, constants;
  Array<std::byte> choices;
  Array<Vec<Dim>> forces;         ///< forces on the corners of each row, eight of each corner, N
  Array<LoadedGridpoint> loaded;  ///< gridpoints by slot
  Array<int> loaded_of_bundle;    ///< first of them of each bundle, and of one more
  Array<int> acting;              ///< entries of `forces`, in the order of the pairs' keys
  Array<WatchedPack> watched;     ///< by pack, ascending
  Array<Vec<Dim>> searched;       ///< displacement by slot at the last search for near pairs, m

  template <class F, class... A>
  static void each(F&& f, A&... a) {
    f(ArrayInfo{"found_laws", Per::entry}, a.laws...);
    f(ArrayInfo{"found_rows", Per::entry}, a.rows...);
    f(ArrayInfo{"found_internals", Per::entry}, a.internals...);
    f(ArrayInfo{"found_lost", Per::entry}, a.lost...);
    f(ArrayInfo{"found_constants", Per::entry}, a.constants...);
    f(ArrayInfo{"found_choices", Per::entry}, a.choices...);
    f(ArrayInfo{"found_forces", Per::entry}, a.forces...);
    f(ArrayInfo{"found_loaded", Per::entry}, a.loaded...);
    f(ArrayInfo{"found_loaded_of_bundle", Per::entry}, a.loaded_of_bundle...);
    f(ArrayInfo{"found_acting", Per::entry}, a.acting...);
    f(ArrayInfo{"found_watched", Per::entry}, a.watched...);
    f(ArrayInfo{"found_searched", Per::entry}, a.searched...);
  }
};

/// What a step sees of found contacts.
template <int Dim>
struct FoundRows : FoundArrays<Dim, View> {
  bool is_damped = false;
  /// Longest way since the last search, see FoundContactForces::way.
  double way = 0.0;
  bool moves = false;  ///< true where the sweep moves the body
};

}  // namespace pyroclast
