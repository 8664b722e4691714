#pragma once

#include <filesystem>

#include "pyroclast/simulation/specimen_body.hpp"

namespace pyroclast {

/// Writes `specimen.json`, `aggregates.csv`, `gradation.csv` and, in the plane, `grain_fit.csv` and
/// `outlines.csv` of a specimen into a folder.
void write_specimen_files(const std::filesystem::path& folder, const MadeSpecimen& made,
                          const specimen::SpecimenParameters& asked);

}  // namespace pyroclast
