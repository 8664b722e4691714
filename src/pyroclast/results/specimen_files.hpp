#pragma once

#include <filesystem>
#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "pyroclast/simulation/specimen_body.hpp"

namespace pyroclast {

/// Returns the numbers that specimens of the plane and of space have, under their names in `specimen.json`
/// and `summary.json`.
nlohmann::ordered_json specimen_facts(const MadeSpecimen& made);

/// Returns `specimen.json`, `aggregates.csv`, `gradation.csv` and, in the plane, `grain_fit.csv` and
/// `outlines.csv` of a specimen: their texts, by name.
std::map<std::string, std::string> specimen_files(const MadeSpecimen& made,
                                                  const specimen::SpecimenParameters& asked);
/// Writes such files into a folder.
void write_specimen_files(const std::filesystem::path& folder,
                          const std::map<std::string, std::string>& files);

}  // namespace pyroclast
