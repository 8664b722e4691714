#include "pyroclast/simulation/specimen_body.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/memory.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/simulation/sums.hpp"
#include "pyroclast/specimen/polyhedron.hpp"

namespace pyroclast {

namespace {

/// Measured peak of the memory over the number of blocks, bytes, rounded up (docs/develop/performance.md).
constexpr double kBytesPerBlock = 6000.0, kBytesPerRawCell = 55000.0, kBytesPerMergedCell = 40000.0;
constexpr double kOfConduction = 1.5;  ///< memory with heat conduction over that without
constexpr double kBytesFixed = 40e6;

constexpr const char* kUpperPlaten = "top_platen";

bool has_platens(const std::optional<MovingBody>& moving) {
  const auto is_upper = [](const Bearing& bearing) { return bearing.name == kUpperPlaten; };
  return moving && std::ranges::any_of(moving->bearings, is_upper);
}

Press::Specimen between_platens(const specimen::Specimen<2>& specimen, const Model& model) {
  const specimen::Box& box = specimen.outline.box();
  return {kVertical, box.height(), model.thickness * box.width(), {box.width()}};
}

Press::Specimen between_platens(const specimen::Specimen<3>& specimen, const Model& model) {
  const specimen::Prism& of = specimen.outline;
  Press::Specimen between;
  between.axis = kVertical;
  between.height = of.high()[kVertical] - of.low()[kVertical];
  const int top = specimen::find_side(of.sides(), "top");
  for (const specimen::Facet<3>& face : specimen.cells.faces)
    if (face.side == top) between.area += norm(specimen::area_vector(specimen.cells, face));
  const auto& [left, right, front, back] = kQuartersOfRim;
  if (!model.sets.contains("left")) between.sides = {{left, right}, {front, back}};
  const auto mean = [&](const std::string& set, int component) {
    return mean_position(model, gridpoint_set(model, model.set(set)), component);
  };
  for (const int d : {0, 1}) {
    const int across = d == 0 ? 0 : 2;
    const auto& [lower, upper] = between.sides[d];
    between.widths.push_back(mean(upper, across) - mean(lower, across));
  }
  return between;
}

}  // namespace

const std::vector<std::string>& phases(const MadeSpecimen& specimen) {
  return std::visit([](const auto& s) -> const std::vector<std::string>& { return s.phases; }, specimen);
}

const std::vector<int>& stones(const MadeSpecimen& specimen) {
  return std::visit([](const auto& s) -> const std::vector<int>& { return s.stone; }, specimen);
}

std::vector<std::string> warnings(const MadeSpecimen& specimen) {
  return std::visit([](const auto& s) { return warnings(s); }, specimen);
}

double estimate_memory(const specimen::SpecimenParameters& asked, bool conducts_heat) {
  const double of_solid = asked.blocks.shortest_edge > 0.0 ? kBytesPerMergedCell : kBytesPerRawCell;
  return kBytesFixed + (asked.prism() ? of_solid : kBytesPerBlock) * (conducts_heat ? kOfConduction : 1.0) *
                           static_cast<double>(asked.blocks.count);
}

MadeSpecimen make_checked_specimen(const specimen::SpecimenParameters& asked, Team* team,
                                   bool conducts_heat) {
  const double needed = estimate_memory(asked, conducts_heat);
  const double available = available_memory();
  if (needed > available)
    throw Error(fmt::format("blocks.count = {}: needs about {:.1f} GB of memory, but only {:.1f} GB is free",
                            asked.blocks.count, needed * 1e-9, available * 1e-9));
  if (asked.prism()) return specimen::make_specimen<3>(asked, team);
  return specimen::make_specimen(asked, team);
}

SpecimenNumbers numbers_of(const MadeSpecimen& specimen) {
  return std::visit(
      []<int Dim>(const specimen::Specimen<Dim>& s) -> SpecimenNumbers {
        return {s.fraction, s.metrics.mean_size, specimen::block_size(s),
                specimen::side_of<Dim>(s.outline.extent()), Dim};
      },
      specimen);
}

std::unique_ptr<Model> make_model(const MadeSpecimen& specimen, double thickness,
                                  const std::optional<MovingBody>& moving) {
  return std::visit(
      [&](const auto& s) -> std::unique_ptr<Model> {
        auto made = moving ? make_model(s, thickness, moving->contacts.interfaces, moving->bearings)
                           : make_model(s, thickness);
        if (moving) add_loose_bodies(made, moving->bodies);
        return std::make_unique<decltype(made)>(std::move(made));
      },
      specimen);
}

SpecimenBody make_body(const MadeSpecimen& specimen, double thickness, const std::vector<SetParameters>& sets,
                       const std::optional<MovingBody>& moving) {
  SpecimenBody body{make_model(specimen, thickness, moving), numbers_of(specimen), {}, {}, {}};
  if (moving) add_symmetry(*body.model, moving->symmetry);
  add_sets(*body.model, sets);
  if (const auto* plane = std::get_if<specimen::Specimen<2>>(&specimen))
    body.notches = plane->outline.notches();
  if (has_platens(moving))
    body.between_platens =
        std::visit([&](const auto& s) { return between_platens(s, *body.model); }, specimen);
  return body;
}

}  // namespace pyroclast
