#include "pyroclast/results/spall_files.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/model/sets.hpp"
#include "pyroclast/results/text_file.hpp"

namespace pyroclast {

namespace {

std::string table_of_spalls(const Spalling& spalling) {
  std::string text =
      "piece,heating_time_s,blocks,area_m2,mass_kg,mean_depth_m,largest_depth_m,pressure_behind_MPa,"
      "temperature_behind_degC,by_flight\n";
  int piece = 0;
  for (const Spall& s : spalling.spalls())
    text += fmt::format("{},{:.9g},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}\n", ++piece,
                        s.heating_time, s.blocks.size(), s.area, s.mass, s.mean_depth, s.largest_depth,
                        s.pressure * 1e-6, s.temperature, s.sign == SpallSign::flight ? 1 : 0);
  return text;
}

std::string table_of_blocks(const Model& model, const Spalling& spalling) {
  const bool is_solid = model.dimension() == 3;
  std::string text =
      fmt::format("piece,block,x_m,y_m,{}least_depth_m,largest_depth_m\n", is_solid ? "z_m," : "");
  const std::vector<Vec<3>> centroids = block_centroids(model);
  int piece = 0;
  for (const Spall& spall : spalling.spalls()) {
    ++piece;
    for (const int block : spall.blocks) {
      double least = std::numeric_limits<double>::infinity(), largest = 0.0;
      for (int g = model.block_gridpoints[block]; g < model.block_gridpoints[block + 1]; ++g) {
        const double depth = spalling.depth(model.place(g));
        least = std::min(least, depth);
        largest = std::max(largest, depth);
      }
      text += fmt::format("{},{}", piece, block);
      for (int i = 0; i < model.dimension(); ++i) text += fmt::format(",{:.9g}", centroids[block][i]);
      text += fmt::format(",{:.9g},{:.9g}\n", least, largest);
    }
  }
  return text;
}

}  // namespace

SpallFiles::SpallFiles(std::filesystem::path folder, const Model& model, const Spalling& spalling)
    : folder_(std::move(folder)), written_(std::numeric_limits<std::size_t>::max()) {
  write(model, spalling);
}

void SpallFiles::write(const Model& model, const Spalling& spalling) {
  if (std::exchange(written_, spalling.spalls().size()) == spalling.spalls().size()) return;
  write_text_file(file_in(folder_, "spalls.csv"), table_of_spalls(spalling));
  write_text_file(file_in(folder_, "spalled_blocks.csv"), table_of_blocks(model, spalling));
}

}  // namespace pyroclast
