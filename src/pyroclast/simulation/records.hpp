#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/base/unit.hpp"
#include "pyroclast/mechanics/mechanics.hpp"
#include "pyroclast/simulation/history.hpp"

namespace pyroclast {

class Simulation;

/// What a record measures.
enum class RecordKind : std::uint8_t {
  displacement,   ///< mean of a set along a direction, m
  opening,        ///< the same of a second set minus that of the first, m
  force,          ///< on the body by a set that loads, holds or drives it, or at one that does not, N
  stress,         ///< mean over the zones of a set, normal to planes across a direction, tension positive, Pa
  temperature,    ///< mean of a set, °C
  crack_length,   ///< of the damaged contact points of a set, m
  crack_opening,  ///< mean over the contact points of a set, by length, m
};

/// What the mean of a set of gridpoints is taken over.
enum class MeanOver : std::uint8_t {
  size,  ///< the zones that lie wholly in the set, by area; without any its faces, by length; else gridpoints
  gridpoints,  ///< each counts alike
};

struct RecordParameters {
  std::string name;
  RecordKind kind{};
  std::string set;         ///< of contacts where it is of cracks, else of gridpoints
  std::string other = "";  ///< the second set of an opening
  Vec<2> direction{};      ///< unit
  std::string place = "";  ///< where it is asked for, for messages
  MeanOver over = MeanOver::size;
};

/// Column of a record in the history: its name and unit.
Column column_of(const RecordParameters& record);
/// In which decks state it.
const Unit& unit_of(RecordKind kind);
/// Of its change over time.
const Unit& rate_unit_of(RecordKind kind);
/// A value of the column over the same in SI: 1e-6 where it is in MPa.
double column_over_si(RecordKind kind);

/// A quantity that a run records. Displacements and openings count from the last zero.
class Record {
 public:
  /// Throws Error, with the record's place, when a set is missing, the set of a stress holds no zone, or
  /// nothing moves and it is of another kind than temperature.
  ///
  /// \param mechanics  null where nothing moves
  Record(const Model<2>& model, const Mechanics<2>* mechanics, RecordParameters parameters);

  const RecordParameters& parameters() const { return parameters_; }
  /// Now, in SI; temperatures in °C.
  double read(const Simulation& simulation) const;
  void set_zero(const Simulation& simulation) {
    if (counts_from_zero()) zero_ += read(simulation);
  }
  /// Sets of an opening, which a control pulls apart; the first alone of others.
  const GridpointSet& set() const { return mean_.set; }
  const GridpointSet& other() const { return mean_of_other_.set; }

  void visit_state(StateVisitor& visitor) { visitor.visit(parameters_.name, zero_); }

 private:
  bool counts_from_zero() const {
    return parameters_.kind == RecordKind::displacement || parameters_.kind == RecordKind::opening;
  }
  /// A mean over a set: gridpoints and their weights, whose sum is 1.
  struct Mean {
    GridpointSet set;
    std::vector<double> weights;

    template <class T, class Value>
    T of(Value value) const;
  };
  Mean mean_over(const Model<2>& model, GridpointSet set) const;
  double measure(const Simulation& simulation) const;
  double force(const Simulation& simulation) const;

  RecordParameters parameters_;
  Mean mean_, mean_of_other_;
  std::vector<int> items_;    ///< zones or contacts, ascending
  std::vector<int> chunks_;   ///< where those of each chunk begin
  std::vector<double> size_;  ///< of each, m³ or m
  double whole_ = 0.0;        ///< of all
  double zero_ = 0.0;
};

}  // namespace pyroclast
