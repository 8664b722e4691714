#include "pyroclast/moisture/crack_network.hpp"

#include <map>

namespace pyroclast {

namespace {

/// Crack that comes to an end.
struct Arm {
  int crack;
  double conductance;  ///< from its middle to that end, m3
};

/// Returns the cube of the width that stands for an even taper between two widths, m3.
double cube_of_taper(double from, double to) {
  return from > 0.0 && to > 0.0 ? 2.0 * (from * from) * (to * to) / (from + to) : 0.0;
}

}  // namespace

CrackNetwork crack_network(const MoistureMesh& mesh, const std::vector<OpenFace>& cracks,
                           const std::vector<bool>& opens, double roughness) {
  std::map<int, std::vector<Arm>> arms;  // by edge
  for (std::size_t c = 0; c < cracks.size(); ++c) {
    const CellFace& face = mesh.faces[cracks[c].face];
    for (int e = 0; e < face.end_count; ++e) {
      const FaceEnd& end = mesh.ends[face.first_end + e];
      const double cube = cube_of_taper(cracks[c].width, cracks[c].at_ends[e]);
      if (cube > 0.0)
        arms[end.edge].push_back(
            {static_cast<int>(c), cube * end.breadth / (12.0 * roughness * end.distance)});
    }
  }
  std::map<int, int> mouth_at;  // outer face by edge
  for (const auto& [edge, outer] : mesh.outer_edges)
    if (opens[outer]) mouth_at.try_emplace(edge, outer);
  CrackNetwork network;
  for (const auto& [edge, meeting] : arms) {
    if (const auto mouth = mouth_at.find(edge); mouth != mouth_at.end()) {
      for (const Arm& arm : meeting) network.mouths.push_back({arm.crack, mouth->second, arm.conductance});
      continue;
    }
    double sum = 0.0;
    for (const Arm& arm : meeting) sum += arm.conductance;
    for (std::size_t i = 0; i < meeting.size(); ++i)
      for (std::size_t j = i + 1; j < meeting.size(); ++j)
        network.conduits.push_back(
            {{meeting[i].crack, meeting[j].crack}, meeting[i].conductance * meeting[j].conductance / sum});
  }
  return network;
}

}  // namespace pyroclast
