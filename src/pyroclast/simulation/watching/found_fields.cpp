#include "pyroclast/simulation/watching/found_fields.hpp"

#include <algorithm>
#include <utility>

namespace pyroclast {

namespace {

/// Writes σ n n + τ (n t + t n) of the tractions.
void put_stress(const FoundPoint& p, double* to) {
  const Vec<3>&n = p.normal, &t = p.tangent;
  const auto of = [&](int i, int j) {
    return p.normal_traction * n[i] * n[j] + p.shear_traction * (n[i] * t[j] + n[j] * t[i]);
  };
  int next = 0;
  for (const auto& [i, j] : {std::pair{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}) to[next++] = of(i, j);
}

}  // namespace

const std::vector<FoundField>& found_fields() {
  constexpr Item kItem = Item::found;
  constexpr ValueKind kNumber = ValueKind::number;
  static const std::vector<FoundField> all{
      {{"opening", unit::length, kItem, kNumber,
        "normal jump, negative where the facets press; of a face that was handed over that of its contact"},
       [](const FoundPoint& p, double* to) { *to = p.opening; }},
      {{"tangential_jump", unit::length, kItem, kNumber,
        "jump along the facets since they met; of a solid its size"},
       [](const FoundPoint& p, double* to) { *to = p.slip; }},
      {{"normal_traction", unit::stress, kItem, kNumber, "positive in tension, with the damping"},
       [](const FoundPoint& p, double* to) { *to = p.normal_traction; }},
      {{"shear_traction", unit::stress, kItem, kNumber, "along the facets; of a solid its size"},
       [](const FoundPoint& p, double* to) { *to = p.shear_traction; }},
      {{"stress", unit::stress, kItem, ValueKind::tensor,
        "σ n n + τ (n t + t n) of the tractions σ and τ, with n across the facets and t along them"},
       put_stress},
      {{"area", unit::area, kItem, kNumber,
        "the point's part of the overlap, less where facets do not lie parallel, or deep in each other"},
       [](const FoundPoint& p, double* to) { *to = p.area; }},
      {{"normal", unit::dimensionless, kItem, ValueKind::vector,
        "across the mean of both facets, from block a to b"},
       [](const FoundPoint& p, double* to) { std::ranges::copy(p.normal.c, to); }},
      {{"force", unit::force, kItem, ValueKind::vector,
        "on block a, across the facet that the point meets, but for what the change of its area adds"},
       [](const FoundPoint& p, double* to) { std::ranges::copy(p.force.c, to); }},
      {{"stored", unit::fracture_energy, kItem, kNumber, "elastic energy", false},
       [](const FoundPoint& p, double* to) { *to = p.stored; }},
  };
  return all;
}

std::vector<double> values_of(const FoundField& field, const std::vector<FoundPoint>& points) {
  const auto components = static_cast<std::size_t>(components_of(field.kind, 3));
  std::vector<double> values(points.size() * components);
  for (std::size_t i = 0; i < points.size(); ++i) field.read(points[i], &values[i * components]);
  return values;
}

}  // namespace pyroclast
