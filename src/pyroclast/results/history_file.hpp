#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pyroclast/experiment/experiment.hpp"
#include "pyroclast/experiment/probe.hpp"
#include "pyroclast/results/text_file.hpp"

namespace pyroclast {

/// `history.csv`: a row for each sample; the column names carry the units.
class HistoryFile {
 public:
  explicit HistoryFile(const std::filesystem::path& path);
  void write(const Sample& sample);

  /// Names of the columns, in order.
  static std::string header();

 private:
  LineFile file_;
};

/// `history.csv` of heat conduction alone: a row for each look, and a column for each probe.
class HeatHistoryFile {
 public:
  /// Throws Error when a probe lies outside the body.
  HeatHistoryFile(const std::filesystem::path& path, const Model<2>& model,
                  const std::vector<ProbeCase>& probes);
  /// The field must be one that conduction computes.
  void write(const TemperatureField& field);

 private:
  LineFile file_;
  std::vector<Probe> probes_;
};

}  // namespace pyroclast
