#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "pyroclast/simulation/specimen_body.hpp"

namespace pyroclast {

/// Returns the numbers that specimens of the plane and of space have, under their names in `specimen.json`
/// and `summary.json`.
nlohmann::ordered_json specimen_facts(const MadeSpecimen& made);

/// Writes `specimen.json`, `aggregates.csv`, `gradation.csv` and, in the plane, `grain_fit.csv` and
/// `outlines.csv` of a specimen into a folder.
void write_specimen_files(const std::filesystem::path& folder, const MadeSpecimen& made,
                          const specimen::SpecimenParameters& asked);

}  // namespace pyroclast
