#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/base/vec.hpp"
#include "pyroclast/deck/deck.hpp"
#include "pyroclast/setup/read_space.hpp"
#include "pyroclast/specimen/cells_file.hpp"

namespace pyroclast {

/// Statements of a deck on the outline, before the size of the blocks is known.
struct ReadOutline {
  Shape shape;
  double width = 0.0, height = 0.0, diameter = 0.0, inner_diameter = 0.0;  ///< m
  double unit = 0.0;            ///< unit of the coordinates of a file, m
  std::vector<Vec<2>> corners;  ///< m
  struct Hole {
    std::string name;
    Vec<2> centre{};
    double diameter = 0.0;
    std::vector<Vec<2>> corners;
  };
  std::vector<Hole> holes;
  std::vector<specimen::Notch> notches;
  std::optional<specimen::FileOfCells> cells;
};

/// Reads the outline in [specimen]. Errors are recorded in the deck.
/// \param folder  folder to which files are relative
ReadOutline read_outline(const Section& s, const std::filesystem::path& folder, const DeckSpace& space);

/// Warns of an outline that is not as large as specimens usually are, unless a key has warned already.
void check_outline(const Section& s, const ReadOutline& outline,
                   const specimen::SpecimenParameters& specimen);

}  // namespace pyroclast
