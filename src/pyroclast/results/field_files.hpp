#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/results/frame_series.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/simulation/history.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

/// Frames of the fields that were written so far.
struct FrameRows {
  std::vector<std::int64_t> rows;  ///< of the history, at which they were taken
};

/// The fields of a run: `mesh.h5`, frames of the blocks and, where the body moves, of the contacts, see
/// FrameSeries, and `frames.csv`, which lists them with some columns of the history.
class FieldFiles {
 public:
  /// Creates the folder, writes the mesh and lists the frames that are there.
  FieldFiles(const std::filesystem::path& folder, const Simulation& simulation, const History& history,
             const FrameRows& frames);

  /// A frame of the fields now, at the row that the history has last. Its time is the heating time while
  /// heated, and before and after it that of the mechanics. Adds it to `frames` once all of it is written.
  void write(const Simulation& simulation, const History& history, FrameRows& frames);

  /// Names of the files of earlier frames that are missing or broken.
  std::vector<std::string> lost() const;

 private:
  std::vector<std::string> columns_;  ///< of the history, that frames.csv has
  LineFile frames_;
  FrameSeries blocks_;
  std::optional<FrameSeries> contacts_;
};

}  // namespace pyroclast
