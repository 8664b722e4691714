#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/base/unit.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/simulation/watching/history.hpp"

namespace pyroclast {

class Simulation;

/// Quantity that a record measures.
enum class RecordKind : std::uint8_t {
  displacement,  ///< mean displacement of a set along a direction, m
  opening,       ///< mean displacement of a second set less that of the first along a direction, m
  force,         ///< force on the body by a set that loads, holds or drives it, or at a set that does not, N
  /// Mean stress over the zones of a set, normal to planes across a direction, tension positive, Pa.
  stress,
  temperature,    ///< mean temperature of a set, °C
  crack_length,   ///< length of the damaged contact points of a set, m; 2D only
  crack_area,     ///< their area, m²; 3D only
  crack_opening,  ///< mean opening over the contact points of a set, by extent, m
};

/// Weights of the mean over a set of gridpoints.
enum class MeanOver : std::uint8_t {
  /// Area of the zones that lie wholly in the set; without any, length of its faces; else gridpoints alike.
  size,
  gridpoints,  ///< equal weights of all gridpoints
};

struct RecordParameters {
  std::string name;
  RecordKind kind{};
  std::string set;         ///< set of contacts for a record of cracks, else set of gridpoints
  std::string other = "";  ///< second set of an opening
  Vec<3> direction{};      ///< unit vector
  std::string place = "";  ///< place in the deck that asks for the record, for messages
  MeanOver over = MeanOver::size;
};

/// Meaning of the column of a record.
inline constexpr const char* kMeaningOfRecord = "a [[record]] of the deck";

/// Returns the column of a record in the history.
Column column_of(const RecordParameters& record);
/// Returns the unit in which decks state a record.
const Unit& unit_of(RecordKind kind);
/// Returns the unit of a record's change over time.
const Unit& rate_unit_of(RecordKind kind);
/// Returns a value of the column over the same value in SI: 1e-6 where the column is in MPa.
double column_over_si(RecordKind kind);

/// Record of a deck: a quantity that a run measures. Displacements and openings count from the last zero.
class Record {
 public:
  /// Throws Error, with the record's place, when a set is missing, the set of a stress holds no zone, or
  /// nothing moves and the record is of another kind than temperature.
  ///
  /// \param moves  true where a stage moves the body
  Record(const Model& model, bool moves, RecordParameters parameters);

  const RecordParameters& parameters() const { return parameters_; }
  /// Returns the present value, in SI; temperatures in °C.
  double read(const Simulation& simulation) const;
  void set_zero(const Simulation& simulation) {
    if (counts_from_zero()) zero_ += read(simulation);
  }
  /// Returns the acceleration of an opening by a pair of forces of 1 N that pulls its sets apart, 1/kg.
  double mobility(const Simulation& simulation) const;

  void visit_state(StateVisitor& visitor) { visitor.visit(parameters_.name, zero_); }
  /// Throws Error, with the place of what needs the record, where a block that it counts on has left the
  /// body.
  void require_there(const Simulation& simulation, const std::string& place) const;

 private:
  bool counts_from_zero() const {
    return parameters_.kind == RecordKind::displacement || parameters_.kind == RecordKind::opening;
  }
  /// Mean over a set: gridpoints and their weights, whose sum is 1.
  struct Mean {
    GridpointSet set;
    std::vector<double> weights;

    template <class T, class Value>
    T of(Value value) const;
  };
  Mean mean_over(const Model& model, GridpointSet set) const;
  bool has_lost(const Simulation& simulation) const;
  double measure(const Simulation& simulation) const;
  double force(const Simulation& simulation) const;

  RecordParameters parameters_;
  Mean mean_, mean_of_other_;
  std::vector<int> items_;    ///< zones or contacts, ascending
  ChunkList chunks_;          ///< chunks of the items
  std::vector<double> size_;  ///< size of each item: volume of a zone, m³, extent of a contact
  double whole_ = 0.0;        ///< size of all items
  double zero_ = 0.0;
};

}  // namespace pyroclast
