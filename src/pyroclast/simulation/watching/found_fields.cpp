#include "pyroclast/simulation/watching/found_fields.hpp"

namespace pyroclast {

namespace {

using End = FoundPoint;

/// Writes σ n n + τ (n t + t n) of the tractions, with t along the edges.
void put_stress(const End& p, double* to) {
  const Vec<2>&n = p.normal, t{{-n[1], n[0]}};
  const auto of = [&](int i, int j) {
    return p.normal_traction * n[i] * n[j] + p.shear_traction * (n[i] * t[j] + n[j] * t[i]);
  };
  for (int i = 0; i < 6; ++i) to[i] = 0.0;
  to[0] = of(0, 0);
  to[1] = of(1, 1);
  to[3] = of(0, 1);
}

}  // namespace

const std::vector<FoundField>& found_fields() {
  constexpr Item kItem = Item::found;
  constexpr ValueKind kNumber = ValueKind::number;
  static const std::vector<FoundField> all{
      {{"opening", unit::length, kItem, kNumber,
        "normal jump, negative where the edges press; of a face that was handed over that of its contact"},
       [](const End& p, double* to) { *to = p.opening; }},
      {{"tangential_jump", unit::length, kItem, kNumber, "jump along the edges since they met"},
       [](const End& p, double* to) { *to = p.slip; }},
      {{"normal_traction", unit::stress, kItem, kNumber, "positive in tension, with the damping"},
       [](const End& p, double* to) { *to = p.normal_traction; }},
      {{"shear_traction", unit::stress, kItem, kNumber, "along the edges"},
       [](const End& p, double* to) { *to = p.shear_traction; }},
      {{"stress", unit::stress, kItem, ValueKind::tensor,
        "σ n n + τ (n t + t n) of the tractions σ and τ, with n across the edges and t along them"},
       put_stress},
      {{"length", unit::length, kItem, kNumber,
        "area over the thickness: half of the overlap, less where edges do not lie parallel or deep"},
       [](const End& p, double* to) { *to = p.length; }},
      {{"normal", unit::dimensionless, kItem, ValueKind::vector,
        "across the mean of both edges, from block a to b"},
       [](const End& p, double* to) { to[0] = p.normal[0], to[1] = p.normal[1]; }},
      {{"force", unit::force, kItem, ValueKind::vector,
        "on block a, across the edge that the corner meets, but for what the change of its area adds"},
       [](const End& p, double* to) { to[0] = p.force[0], to[1] = p.force[1]; }},
      {{"stored", unit::fracture_energy, kItem, kNumber, "elastic energy", false},
       [](const End& p, double* to) { *to = p.stored; }},
  };
  return all;
}

std::vector<double> values_of(const FoundField& field, const std::vector<FoundPoint>& points) {
  const auto components = static_cast<std::size_t>(components_of(field.kind, 2));
  std::vector<double> values(points.size() * components);
  for (std::size_t i = 0; i < points.size(); ++i) field.read(points[i], &values[i * components]);
  return values;
}

}  // namespace pyroclast
