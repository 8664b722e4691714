#pragma once

#include <filesystem>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/setup/read_space.hpp"
#include "pyroclast/simulation/specimen_body.hpp"

namespace pyroclast {

/// Reads [aggregates], or the keys of it in a table of inclusions.
/// \param folder  folder to which files are relative
specimen::AggregateParameters read_aggregates(const Section& s, const std::filesystem::path& folder,
                                              const DeckSpace& space);

/// Reads [[inclusions]].
/// \param folder  folder to which files are relative
std::vector<specimen::Inclusions> read_inclusions(const Section& root, const std::filesystem::path& folder,
                                                  const DeckSpace& space);

/// Sets the fraction to the share of the specimen that known stones take.
void set_fraction(double extent_of_specimen, specimen::AggregateParameters& a);

/// Records an error where the largest aggregate has no place, and warns where the specimen is only a few of
/// them wide.
void check_size(const Section& s, const specimen::SpecimenParameters& p);

}  // namespace pyroclast
