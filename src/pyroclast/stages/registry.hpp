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
#include "pyroclast/simulation/exchange.hpp"
#include "pyroclast/simulation/records.hpp"
#include "pyroclast/simulation/stage.hpp"

namespace pyroclast {

/// How often things are looked at: the table [output].
struct OutputIntervals {
  double history_strain = 0.0;     ///< axial strain between two rows of the history, while compressing
  double frame_strain = 0.0;       ///< axial strain between two frames of the fields, while compressing
  double frame_temperature = 0.0;  ///< frames at its multiples, of the mean temperature, K
  /// Frames at its multiples, of the heating time, s; never if the deck does not say.
  double frame_interval = std::numeric_limits<double>::infinity();
};

/// What a deck says beside the stage's own table.
struct StageTables {
  OutputIntervals output;
  std::optional<Section> coupling_table;
  Coupling coupling;  ///< as the table has it
  bool has_platens = false;
  std::vector<RecordParameters> records;
  std::filesystem::path folder;  ///< of the deck
};

/// A kind of stage.
struct StageKind {
  std::string name;
  std::string meaning;  ///< what it does, for the deck reference
  StageNeeds needs;
  /// Reads a stage of this kind. What is wrong is recorded in the deck.
  /// \param own  its table of [[stages]]
  std::function<std::unique_ptr<Stage>(const Section& own, const StageTables& tables)> read;
};

/// The kinds of stages that a deck may ask for, by name.
class StageRegistry {
 public:
  /// With the kinds of this library: settle, load, compress, drive, heat, expose, conduct.
  StageRegistry();

  /// Throws Error when there is one of this name.
  void add(StageKind kind);
  const std::vector<StageKind>& kinds() const { return kinds_; }

 private:
  std::vector<StageKind> kinds_;
};

}  // namespace pyroclast
