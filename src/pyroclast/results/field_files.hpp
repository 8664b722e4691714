#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/results/frame_series.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/simulation/history.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

/// The fields of a run: `mesh.h5`, frames of the blocks and, where the body moves, of the contacts, see
/// FrameSeries, and `frames.csv`, which lists them with some columns of the history.
class FieldFiles {
 public:
  /// Creates the folder and writes the mesh.
  FieldFiles(const std::filesystem::path& folder, const Simulation& simulation, const History& history);

  /// A frame of the fields now; its time is that of the mechanics, or of heating where nothing moves.
  void write(const Simulation& simulation, const History& history);

 private:
  LineFile frames_;
  std::vector<std::string> columns_;  ///< of the history, that frames.csv has
  FrameSeries blocks_;
  std::optional<FrameSeries> contacts_;
};

}  // namespace pyroclast
