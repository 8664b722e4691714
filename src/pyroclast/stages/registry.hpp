#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/simulation/loop/exchange.hpp"
#include "pyroclast/simulation/loop/stage.hpp"
#include "pyroclast/simulation/watching/records.hpp"

namespace pyroclast {

/// Intervals of looks and frames: the table [output].
struct OutputIntervals {
  double history_strain = 0.0;     ///< axial strain between two rows of the history, while compressing
  double frame_strain = 0.0;       ///< axial strain between two frames of the fields, while compressing
  double frame_temperature = 0.0;  ///< interval of the mean temperature whose multiples have frames, K
  /// Interval of the heating time whose multiples have frames, s; infinite if the deck does not state it.
  double frame_interval = std::numeric_limits<double>::infinity();
};

/// Content of a deck beside the stage's own table.
struct StageTables {
  OutputIntervals output;
  std::optional<Section> coupling_table;
  Coupling coupling;  ///< coupling as the table states it
  bool has_platens = false;
  std::vector<RecordParameters> records;
  std::filesystem::path folder;  ///< folder of the deck
  int dimension = 2;             ///< dimension of the body, 2 or 3
  bool has_thickness = true;     ///< false for a cylinder
};

/// Kind of stage.
struct StageKind {
  std::string name;
  std::string meaning;  ///< meaning of the kind, for the deck reference
  StageNeeds needs;
  /// Function that reads a stage of this kind. Errors are recorded in the deck.
  /// \param own  the stage's own table of [[stages]]
  std::function<std::unique_ptr<Stage>(const Section& own, const StageTables& tables)> read;
};

/// Kinds of stages that a deck may ask for, by name.
class StageRegistry {
 public:
  /// Registers the kinds of this library: settle, load, compress, drive, heat, expose, conduct.
  StageRegistry();

  /// Adds a kind. Throws Error when there is one of this name.
  void add(StageKind kind);
  const std::vector<StageKind>& kinds() const { return kinds_; }

 private:
  std::vector<StageKind> kinds_;
};

}  // namespace pyroclast
