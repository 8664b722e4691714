#pragma once

#include <filesystem>
#include <string>

#include "pyroclast/specimen/specimen.hpp"

/// Blocks in space that were made before, and their files.
namespace pyroclast::specimen {

/// Finds the side of the body on which each face of the surface lies.
void find_sides(Cells<3>& cells, const Prism& body);

/// Tells whether a text of a file of cells has blocks in space: faces, or a body.
bool are_in_space(const std::string& text);

/// Reads a file of blocks in space, and turns each face counter-clockwise seen from outside of the first of
/// its cells. Vertices of faces on a side of the body are laid onto it where they are off by no more than
/// `specimen::kOffSide`, as the file rounds them. Throws Error, with the file, for a text of another form,
/// for lists that do not fit, for cells in several pieces, and for a face on the surface that lies on none of
/// the sides; the message then says whether vertices could be joined (`describe_joinable`). \param join
/// distance below which vertices are joined, m (`join`); 0: none
GivenCells<3> read_polyhedra(const std::filesystem::path& file, double join = 0.0);
/// Reads blocks from a text; `name` takes the file's place in messages.
GivenCells<3> polyhedra_from(const std::string& text, const std::string& name, double join = 0.0);

}  // namespace pyroclast::specimen
