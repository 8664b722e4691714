#pragma once

#include <filesystem>

#include "pyroclast/experiment/experiment.hpp"
#include "pyroclast/results/frame_series.hpp"
#include "pyroclast/results/text_file.hpp"

namespace pyroclast {

/// The fields of a run: `mesh.h5`, frames of the blocks and of the contacts, see FrameSeries, and
/// `frames.csv`, which lists them.
class FieldFiles {
 public:
  /// Creates the folder and writes the mesh.
  FieldFiles(const std::filesystem::path& folder, const Model<2>& model);

  void write(const Experiment& experiment, const Sample& sample);

 private:
  LineFile frames_;
  FrameSeries blocks_, contacts_;
};

/// The fields of heat conduction alone: the same mesh, and frames of the blocks only, with temperatures.
class HeatFieldFiles {
 public:
  /// Creates the folder and writes the mesh.
  HeatFieldFiles(const std::filesystem::path& folder, const Model<2>& model);

  void write(const TemperatureField& field);

 private:
  LineFile frames_;
  FrameSeries blocks_;
};

}  // namespace pyroclast
