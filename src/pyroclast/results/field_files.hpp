#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/results/frame_series.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/simulation/watching/history.hpp"

namespace pyroclast {

/// Frames of the fields that were written so far.
struct FrameRows {
  std::vector<std::int64_t> rows;  ///< rows of the history at which they were taken
};

/// Files of a run's fields: `mesh.h5`, frames of the blocks and, where the body moves, of the contacts and of
/// those that are found, see FrameSeries, and `frames.csv`, which lists the frames with some columns of the
/// history.
class FieldFiles {
 public:
  /// Creates the folder, writes the mesh and lists the frames that are there.
  FieldFiles(const std::filesystem::path& folder, const Simulation& simulation, const History& history,
             const FrameRows& frames);

  /// Writes a frame of the present fields, at the last row of the history. The time of the frame is the
  /// heating time during heating, and before and after it the time of the mechanics. The frame is added to
  /// `frames` once it is written whole.
  void write(const Simulation& simulation, const History& history, FrameRows& frames);

  /// Returns the names of the files of earlier frames that are missing or broken.
  std::vector<std::string> lost() const;

 private:
  std::vector<std::string> columns_;  ///< columns of the history in frames.csv
  LineFile frames_;
  FrameSeries blocks_;
  std::optional<FrameSeries> contacts_, found_;
};

}  // namespace pyroclast
