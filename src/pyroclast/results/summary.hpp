#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pyroclast/experiment/case.hpp"
#include "pyroclast/experiment/heating_response.hpp"
#include "pyroclast/experiment/response.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast {

/// What a reader of a run wants to know first.
struct Summary {
  std::string title;
  Outcome outcome = Outcome::completed;
  std::optional<CompressionResponse> compression;
  QuasiStaticReport quasi_static;
  std::optional<HeatingResponse> heating;
  std::vector<std::string> stages;  ///< kinds, in order
  bool uniform_temperature = true;
  std::string expansion_reading;
  double estimated_modulus = 0.0;  ///< Pa
  double fracture_zone = 0.0;      ///< t_b, m
  double time_step = 0.0;          ///< s
  double mass_ratio = 0.0;         ///< moving over real mass
  double wall_time = 0.0;          ///< s
  Sample last;
  std::vector<std::string> warnings;
};

/// Gathers it after a run, with a warning for each thing that keeps the result from being taken at face
/// value.
Summary summarize(const Case& c, const Experiment& experiment, Outcome outcome);

/// `summary.json`.
void write_summary(const std::filesystem::path& path, const Summary& summary,
                   const specimen::Specimen& specimen);

}  // namespace pyroclast
