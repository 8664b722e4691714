#include "pyroclast/simulation/acting/heat_conditions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/overloaded.hpp"
#include "pyroclast/base/rounding.hpp"
#include "pyroclast/thermal/conduction.hpp"

namespace pyroclast {

namespace {

/// Accuracy to which the time of the last change is found, as a fraction of the duration.
constexpr double kTimeAccuracy = 1e-6;

/// Relative difference of areas that count as equal.
constexpr double kSameArea = 1e-6;

/// Resistance of a closed crack over that of a block that is left out where cracks split by the block size.
constexpr double kLeftOut = 0.05;

/// Curves of a condition; null where it has none.
struct ConditionCurves {
  const Curve* temperature = nullptr;
  const Curve* other = nullptr;
};

ConditionCurves curves_of(const HeatCondition& condition) {
  return std::visit(Overloaded{
                        [](const PrescribedTemperature& c) {
                          return ConditionCurves{&c.temperature, nullptr};
                        },
                        [](const HeatFlux& c) {
                          return ConditionCurves{nullptr, &c.flux};
                        },
                        [](const Convection& c) {
                          return ConditionCurves{&c.gas_temperature, &c.coefficient};
                        },
                        [](const Radiation& c) {
                          return ConditionCurves{&c.gas_temperature, &c.emissivity};
                        },
                        [](const Adiabatic&) { return ConditionCurves{}; },
                    },
                    condition);
}

bool is_constant(const Curve* curve, double begin, double end) {
  return !curve || curve->is_constant() || curve->minimum(begin, end) == curve->maximum(begin, end);
}

bool boundaries_are_constant(const HeatConditions& heat, double begin, double end) {
  return std::all_of(heat.boundaries.begin(), heat.boundaries.end(), [&](const HeatBoundaryCondition& b) {
    const auto curves = curves_of(b.condition);
    return is_constant(curves.temperature, begin, end) && is_constant(curves.other, begin, end);
  });
}

HeatMaterial heat_material(const BlockMaterial& material) {
  const auto require = [&](const std::optional<Curve>& curve, const char* key) -> const Curve& {
    if (!curve) throw Error(fmt::format("heat conduction needs materials.{}.{}", material.name, key));
    return *curve;
  };
  return {require(material.conductivity, "conductivity"),
          material.density * require(material.specific_heat, "specific_heat")};
}

/// Returns the heat material of each material of blocks; none for bearings.
std::vector<std::optional<HeatMaterial>> heat_materials(const std::vector<BlockMaterial>& block_materials) {
  std::vector<std::optional<HeatMaterial>> materials(block_materials.size());
  for (std::size_t m = 0; m < block_materials.size(); ++m)
    if (!block_materials[m].is_of_bearing) materials[m] = heat_material(block_materials[m]);
  return materials;
}

std::optional<GapHeat> gap_heat(const HeatConditions& heat) {
  if (!heat.cracks) return std::nullopt;
  return heat.cracks->law;
}

template <int Dim>
void apply(Conduction<Dim>& conduction, const std::vector<int>& faces, const HeatCondition& condition) {
  std::visit(
      Overloaded{
          [&](const PrescribedTemperature& c) { conduction.prescribe_temperature(faces, c.temperature); },
          [](const Adiabatic&) {},
          [&](const auto& c) { conduction.apply(faces, c); },
      },
      condition);
}

/// Conditions that act on each face of an outline.
class FaceUse {
 public:
  explicit FaceUse(std::size_t faces) : conditions_(faces) {}

  /// Adds a condition to faces. Throws Error when a condition that is there already contradicts it.
  void add(const std::vector<int>& faces, const HeatBoundaryCondition& boundary) {
    for (int face : faces) {
      for (const HeatBoundaryCondition* other : conditions_[face])
        if (contradict(other->condition, boundary.condition))
          throw Error(fmt::format("\"{}\" acts on faces that have \"{}\" already ({})",
                                  kind_name(boundary.condition), kind_name(other->condition), other->place));
      conditions_[face].push_back(&boundary);
    }
  }

 private:
  std::vector<std::vector<const HeatBoundaryCondition*>> conditions_;
};

}  // namespace

HeatConditions with_specimen(HeatConditions heat, const std::vector<BlockMaterial>& block_materials,
                             const std::vector<double>& fraction, double mean_size) {
  if (!heat.cracks || !heat.cracks->splits_by_block_size) return heat;
  double conductivity = 0.0;
  for (std::size_t i = 0; i < fraction.size(); ++i)
    conductivity += fraction[i] * heat_material(block_materials[i]).conductivity(kReferenceTemperature);
  heat.cracks->law.split_below = conductivity / (kLeftOut * mean_size);
  heat.cracks->splits_by_block_size = false;
  return heat;
}

bool contradict(const HeatCondition& a, const HeatCondition& b) {
  const auto excludes_others = [](const HeatCondition& c) {
    return std::holds_alternative<PrescribedTemperature>(c) || std::holds_alternative<Adiabatic>(c);
  };
  return a.index() == b.index() || excludes_others(a) || excludes_others(b);
}

const char* kind_name(const HeatCondition& condition) {
  return std::visit(Overloaded{
                        [](const PrescribedTemperature&) { return "temperature"; },
                        [](const HeatFlux&) { return "flux"; },
                        [](const Convection&) { return "convection"; },
                        [](const Radiation&) { return "radiation"; },
                        [](const Adiabatic&) { return "adiabatic"; },
                    },
                    condition);
}

Interval temperature_range(const HeatConditions& heat, double duration) {
  if (heat.temperature_range) return *heat.temperature_range;
  Interval range{heat.initial, heat.initial};
  for (const auto& boundary : heat.boundaries) {
    if (std::holds_alternative<HeatFlux>(boundary.condition))
      throw Error(fmt::format("{}: with a given flux the temperature_range must be stated", boundary.place));
    if (const Curve* temperature = curves_of(boundary.condition).temperature) {
      range.lower = std::min(range.lower, temperature->minimum(0.0, duration));
      range.upper = std::max(range.upper, temperature->maximum(0.0, duration));
    }
  }
  return range;
}

bool heats_or_cools(const HeatConditions& heat, double duration) {
  return std::ranges::any_of(heat.boundaries, [&](const HeatBoundaryCondition& boundary) {
    if (std::holds_alternative<HeatFlux>(boundary.condition)) return true;
    const Curve* temperature = curves_of(boundary.condition).temperature;
    return temperature && !(same(temperature->minimum(0.0, duration), heat.initial, absolute_zero) &&
                            same(temperature->maximum(0.0, duration), heat.initial, absolute_zero));
  });
}

double constant_from(const HeatConditions& heat, double duration) {
  if (boundaries_are_constant(heat, 0.0, duration)) return 0.0;
  double changing = 0.0, constant = duration;
  while (constant - changing > kTimeAccuracy * duration) {
    const double middle = 0.5 * (changing + constant);
    (boundaries_are_constant(heat, middle, duration) ? constant : changing) = middle;
  }
  return constant;
}

namespace {

template <int Dim>
std::unique_ptr<HeatSolver> make_conduction_of(const ModelOf<Dim>& model,
                                               const std::vector<BlockMaterial>& block_materials,
                                               const HeatConditions& heat, const Interval& range,
                                               std::shared_ptr<Team> team, bool loses_blocks) {
  auto conduction = std::make_unique<Conduction<Dim>>(model, heat_materials(block_materials),
                                                      HeatParameters{.temperature_range = range,
                                                                     .initial_temperature = heat.initial,
                                                                     .scheme = heat.scheme,
                                                                     .safety = heat.safety,
                                                                     .largest_change = heat.largest_change,
                                                                     .largest_step = heat.largest_step,
                                                                     .gaps = gap_heat(heat),
                                                                     .loses_blocks = loses_blocks},
                                                      std::move(team));
  FaceUse use(conduction->outline().size());
  for (const auto& boundary : heat.boundaries) {
    try {
      const auto faces = faces_of(model, conduction->outline(), boundary.faces);
      use.add(faces, boundary);
      apply(*conduction, faces, boundary.condition);
    } catch (const Error& e) {
      throw Error(fmt::format("{}: {}", boundary.place, e.what()));
    }
  }
  return conduction;
}

/// Returns how far a boundary warms above a temperature, K; infinite where it gives heat.
double rise_of(const HeatCondition& condition, double initial) {
  constexpr double kLongest = 86400.0;  // s
  const auto most = [&](const Curve& curve) {
    return curve.maximum(std::max(0.0, curve.range().lower), std::min(kLongest, curve.range().upper));
  };
  if (const auto* flux = std::get_if<HeatFlux>(&condition))
    return most(flux->flux) > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
  const Curve* const temperature = curves_of(condition).temperature;
  return temperature ? most(*temperature) - initial : 0.0;
}

/// Returns how far a boundary takes temperatures away from the initial one, K.
double drive_of(const HeatCondition& condition, double initial, double duration) {
  if (const auto* flux = std::get_if<HeatFlux>(&condition))
    return flux->flux.maximum(0.0, duration) > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
  const Curve* const temperature = curves_of(condition).temperature;
  if (!temperature) return 0.0;
  return std::max(std::abs(temperature->maximum(0.0, duration) - initial),
                  std::abs(temperature->minimum(0.0, duration) - initial));
}

template <int Dim>
BoxSide most_heated_side_of(const ModelOf<Dim>& model, const std::vector<BlockMaterial>& block_materials,
                            const HeatConditions& heat, double duration) {
  constexpr double kFaces = 0.7;  // cosine of the angle up to which a face looks along an axis, 45 degrees
  std::vector<bool> takes_part;
  for (const BlockMaterial& material : block_materials) takes_part.push_back(!material.is_of_bearing);
  const auto faces = outline(model, zone_geometry(model), blocks_of(model, takes_part));
  const ChunkList chunks =
      model.zone_chunks().of_some(static_cast<int>(faces.size()), [&](int face) { return faces[face].zone; });
  struct DrivenFaces {
    double drive;
    std::vector<int> faces;
  };
  std::vector<DrivenFaces> boundaries;
  for (const HeatBoundaryCondition& boundary : heat.boundaries)
    boundaries.push_back(
        {drive_of(boundary.condition, heat.initial, duration), faces_of(model, faces, boundary.faces)});
  std::pair<double, double> most{-1.0, 0.0};  // drive and area
  BoxSide side;
  for (int axis = 0; axis < Dim; ++axis)
    for (const bool is_upper : {false, true})
      for (const DrivenFaces& driven : boundaries) {
        const double area = chunked_sum(chunks.of_some(driven.faces), [&](int i) {
          const auto& face = faces[driven.faces[i]];
          return (is_upper ? 1.0 : -1.0) * face.normal[axis] > kFaces ? face.area : 0.0;
        });
        const std::pair acts{driven.drive, area};
        if (area == 0.0 || acts.first < most.first) continue;
        // areas of equal sides differ by rounding
        if (acts.first == most.first && !(area > most.second * (1.0 + kSameArea))) continue;
        most = acts;
        side = {axis, is_upper};
      }
  return side;
}

}  // namespace

std::vector<bool> are_fires(const HeatConditions& heat) {
  std::vector<double> rise;
  for (const HeatBoundaryCondition& boundary : heat.boundaries)
    rise.push_back(rise_of(boundary.condition, heat.initial));
  const double most = rise.empty() ? 0.0 : std::ranges::max(rise);
  std::vector<bool> found;
  for (const double r : rise) found.push_back(r > 0.0 && r >= 0.5 * most);
  return found;
}

BoxSide most_heated_side(const Model& model, const std::vector<BlockMaterial>& block_materials,
                         const HeatConditions& heat, double duration) {
  return with_dimension(model, [&](const auto& of_dimension) {
    return most_heated_side_of(of_dimension, block_materials, heat, duration);
  });
}

std::unique_ptr<HeatSolver> make_conduction(const Model& model,
                                            const std::vector<BlockMaterial>& block_materials,
                                            const HeatConditions& heat, const Interval& range,
                                            std::shared_ptr<Team> team, bool loses_blocks) {
  return with_dimension(model, [&](const auto& of_dimension) {
    return make_conduction_of(of_dimension, block_materials, heat, range, std::move(team), loses_blocks);
  });
}

}  // namespace pyroclast
