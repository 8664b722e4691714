#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "pyroclast/model/model.hpp"
#include "pyroclast/results/hdf5_file.hpp"

namespace pyroclast {

/// Part of a mesh that has fields of its own.
enum class MeshPart : std::uint8_t {
  blocks,
  contacts,
  found  ///< ends of pairs of edges that press: each frame has a mesh of its own
};

/// Writes `mesh.h5`, which holds blocks and contacts once for all frames: zones as triangles or tetrahedra
/// with block and material, contact points as cells, see ends_of_contact, with interface and length or area.
/// A collective. \param folder  empty on ranks but the first
void write_mesh(const std::filesystem::path& folder, const Model& model);

/// Writes lines as the mesh of a frame of its own.
/// \param points  both ends of each line in turn, m
void write_lines(Hdf5File& file, const std::vector<Vec<3>>& points);

/// Returns some columns of rows, row by row.
/// \param width    numbers of a row
/// \param padding  zeros behind these columns
template <class To, class From>
std::vector<To> columns_of(const std::vector<From>& rows, int width, int first, int count = 1,
                           int padding = 0) {
  std::vector<To> columns;
  columns.reserve(rows.size() / static_cast<std::size_t>(width) * static_cast<std::size_t>(count + padding));
  for (auto row = rows.begin(); row != rows.end(); row += width) {
    for (int column = first; column < first + count; ++column)
      columns.push_back(static_cast<To>(row[column]));
    columns.insert(columns.end(), static_cast<std::size_t>(padding), To{});
  }
  return columns;
}

/// Frames of a part of the mesh as VTKHDF files, which ParaView and VTK read. Each frame k is a file
/// `blocks_<k>.hdf` or `contacts_<k>.hdf` that links to `mesh.h5` beside it, or a file `found_<k>.hdf`, which
/// is whole; `blocks.hdf.series` and so on open all of them as a time series.
class FrameSeries {
 public:
  /// \param dimension  dimension of the body, 2 or 3
  /// \param times      times of the frames that are there, s; later frames left by a run that was broken off
  ///                   are removed
  FrameSeries(std::filesystem::path folder, MeshPart part, int dimension, std::vector<double> times = {});

  /// Writes a frame: a collective.
  /// \param times   times of all frames so far and of this one, s
  /// \param fields  adds the frame's datasets below /VTKHDF/PointData and /VTKHDF/CellData; of what is found
  ///                also the mesh, see write_lines
  void write(std::vector<double> times, Ranks& ranks, const std::function<void(Hdf5File&)>& fields);

  int count() const { return static_cast<int>(times_.size()); }
  /// Returns the names of the files of frames that are counted, but are missing or broken.
  std::vector<std::string> lost() const;
  /// Returns the name of a frame's file.
  static std::string file_name(MeshPart part, int frame);

 private:
  void write_series() const;

  std::filesystem::path folder_;
  MeshPart part_;
  int dimension_;
  std::vector<double> times_;
};

}  // namespace pyroclast
