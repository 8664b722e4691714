#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pyroclast/experiment/experiment.hpp"
#include "pyroclast/results/text_file.hpp"

namespace pyroclast {

/// The fields of a run as VTKHDF files, which ParaView and VTK read: `mesh.h5` holds blocks and contacts
/// once, each frame k adds `blocks_<k>.hdf` and `contacts_<k>.hdf`, which link to it. `blocks.hdf.series` and
/// `contacts.hdf.series` open as time series; `frames.csv` lists the frames.
class FieldFiles {
 public:
  /// Creates the folder and writes the mesh.
  FieldFiles(std::filesystem::path folder, const Model<2>& model);

  void write(const Experiment& experiment, const Sample& sample);
  int frame_count() const { return static_cast<int>(times_.size()); }

 private:
  void write_mesh(const Model<2>& model) const;
  void write_series(const std::string& kind) const;

  std::filesystem::path folder_;
  LineFile frames_;
  std::vector<double> times_;
};

}  // namespace pyroclast
