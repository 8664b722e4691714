#include "pyroclast/simulation/acting/boundary_faces.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

template <int Dim>
struct Box {
  Vec<Dim> low, high;
};

template <int Dim>
Box<Dim> bounding_box(const std::vector<OutlineFace<Dim>>& outline, const ModelOf<Dim>& model) {
  Box<Dim> box;
  box.low.c.fill(std::numeric_limits<double>::infinity());
  box.high.c.fill(-std::numeric_limits<double>::infinity());
  for (const auto& face : outline)
    for (int g : face.gridpoints)
      for (int d = 0; d < Dim; ++d) {
        box.low[d] = std::min(box.low[d], model.position[g][d]);
        box.high[d] = std::max(box.high[d], model.position[g][d]);
      }
  for (int d = 0; d < Dim; ++d) {
    box.low[d] = model.ranks().least(box.low[d]);
    box.high[d] = model.ranks().largest(box.high[d]);
  }
  return box;
}

template <int Dim, class Predicate>
std::vector<int> chosen_by(const std::vector<OutlineFace<Dim>>& outline, Predicate predicate) {
  std::vector<int> chosen;
  for (std::size_t i = 0; i < outline.size(); ++i)
    if (predicate(outline[i])) chosen.push_back(static_cast<int>(i));
  return chosen;
}

template <int Dim>
std::vector<int> faces_in_box(const ModelOf<Dim>& model, const std::vector<OutlineFace<Dim>>& outline,
                              const BoundaryFaces& faces) {
  const Box<Dim> specimen = bounding_box(outline, model);
  Vec<Dim> slack;
  slack.c.fill(1e-9 * norm(specimen.high - specimen.low));  // allows for rounding
  const auto low = resized<Dim>(faces.box_low), high = resized<Dim>(faces.box_high);
  auto chosen = chosen_by(outline, in_box<Dim>(low - slack, high + slack));
  if (!model.ranks().any(!chosen.empty()))
    throw Error(fmt::format(
        "no face of the outline has its centre in the box from ({:g}) to ({:g}) m; the specimen lies from "
        "({:g}) to ({:g}) m",
        fmt::join(low.c, ", "), fmt::join(high.c, ", "), fmt::join(specimen.low.c, ", "),
        fmt::join(specimen.high.c, ", ")));
  return chosen;
}

}  // namespace

template <int Dim>
std::vector<int> faces_of(const ModelOf<Dim>& model, const std::vector<OutlineFace<Dim>>& outline,
                          const BoundaryFaces& faces) {
  if (faces.part == BoundaryFaces::kBox) return faces_in_box(model, outline, faces);
  if (faces.part == BoundaryFaces::kOutline)
    return chosen_by(outline, [](const OutlineFace<Dim>&) { return true; });
  std::vector<int> side = model.set(faces.part);
  std::ranges::sort(side);
  auto chosen = chosen_by(outline, [&](const OutlineFace<Dim>& face) {
    return std::ranges::all_of(face.gridpoints, [&](int g) { return std::ranges::binary_search(side, g); });
  });
  if (!model.ranks().any(!chosen.empty()))
    throw Error(fmt::format(
        "has no effect: no face of the outline lies wholly in \"{}\"; a face of the outline meets "
        "no other block",
        faces.part));
  return chosen;
}

template std::vector<int> faces_of(const ModelOf<2>&, const std::vector<OutlineFace<2>>&,
                                   const BoundaryFaces&);
template std::vector<int> faces_of(const ModelOf<3>&, const std::vector<OutlineFace<3>>&,
                                   const BoundaryFaces&);

}  // namespace pyroclast
