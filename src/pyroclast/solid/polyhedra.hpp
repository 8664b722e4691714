#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pyroclast/solid/specimen.hpp"

/// Blocks in space that were made before, and their files.
namespace pyroclast::solid {

/// Blocks in space that were made before.
struct Polyhedra {
  Prism body;
  Complex complex;
  std::vector<std::string> phases;
  std::vector<int> phase;  ///< phase of each cell, index into `phases`
  /// Size that each cell was to have, m, as SolidSpecimen has it; empty where blocks are alike.
  std::vector<double> size = {};
  std::vector<int> grain = {};  ///< number of the stone of each cell; -1: none. Empty where none are known
  std::string origin = {};      ///< text that begins messages, such as the name of a file; may be empty
};

/// Writes a specimen as a file holds it: JSON with the lists `phases` (names), `vertices_m` ([x, y, z]
/// each), `faces` (the vertices around each, from 0), `cells` (the faces of each, from 0) and `phase` (of
/// each cell, from 0), and the table `body`: `axis` ("y" or "z"), `length_m` along it, `section_m` (the
/// corners of its section, counter-clockwise) and `sides` (their names from each corner on, or one name of a
/// round section). The list `block_size_m` has the size that each block was to have, where they are not
/// alike. The list `stone` has the number of the stone of each block, from 0, and -1 where it is of none.
/// Stretches of sides are no part of it.
std::string polyhedra_text(const SolidSpecimen& specimen);

/// Reads a file of blocks in space, and turns each face counter-clockwise seen from outside of the first of
/// its cells. Vertices of faces on a side of the body are laid onto it where they are off by no more than
/// `specimen::kOffSide`, as the file rounds them. Throws Error, with the file, for a text of another form,
/// for lists that do not fit, for cells in several pieces, and for a face on the surface that lies on none of
/// the sides; the message then says whether vertices could be joined (`describe_joinable`). \param join
/// distance below which vertices are joined, m (`solid::join`); 0: none
Polyhedra read_polyhedra(const std::filesystem::path& file, double join = 0.0);
/// Reads blocks from a text; `name` takes the file's place in messages.
Polyhedra polyhedra_from(const std::string& text, const std::string& name, double join = 0.0);

/// Makes a specimen of blocks that were made before. Throws Error when they do not fill the body.
/// \param body  body of the blocks, perhaps with patches
SolidSpecimen specimen_from(Polyhedra polyhedra, const Prism& body);

}  // namespace pyroclast::solid
