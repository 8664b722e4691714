#include "pyroclast/material/first_guess.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pyroclast {

namespace {

constexpr double kSameMix = 1.2;  // greatest ratio between factors of one mix

constexpr double kDegree = std::numbers::pi / 180.0;

/// How f_c goes with E of the mortar and with the factor on strengths: cases/starter.toml with E of the
/// mortar from 20 to 50 GPa and strengths from 0.7 to 2 times the paper's.
constexpr double kOfStiffness = 0.22, kOfFactor = 0.79;

/// The paper's Table 2. E, f_c, and how f_c goes with the size of blocks: decks of `pyroclast concrete`, the
/// means of five to ten seeds (docs/validation/after_peak.md#first-guesses): E within 2 %, f_c within 6 %.
constexpr FirstGuess kPlane = {
    .source = "the paper's Table 2",
    .law = Cohesive::name,
    .contacts = {2.5e6, 60.0, 31e6, 3.8e6, 240.0, 34.0 * kDegree, 0.038e6, 34.0 * kDegree},
    .mortar_modulus = 29.4e9,
    .strength = 31e6,
    .modulus_over_estimate = 1.04,
    .of_stiffness = kOfStiffness,
    .of_factor = kOfFactor,
    .block_size = 4.8e-3,
    .of_block_size = -0.27};

/// cases/starter_3d.toml, whose contacts were fitted by hand for space. E over its estimate and f_c:
/// docs/validation/solid_strengths.md; how f_c goes with the size of blocks, as does the mode II energy:
/// docs/validation/one_concrete.md. That the other exponents are those of the plane is a guess.
constexpr FirstGuess kSpace = {.source = "those of cases/starter_3d.toml",
                               .law = MixedMode::name,
                               .contacts = {1.8e6, 90.0, 48e6, 7.5e6, 300.0, 12.0 * kDegree},
                               .mortar_modulus = 29.4e9,
                               .strength = 34.3e6,
                               .modulus_over_estimate = 1.08,
                               .of_stiffness = kOfStiffness,
                               .of_factor = kOfFactor,
                               .block_size = 8.06e-3,
                               .of_block_size = -0.08};

}  // namespace

double FirstGuess::strength_with(double modulus, double size, double factor) const {
  return strength * std::pow(modulus / mortar_modulus, of_stiffness) *
         std::pow(size / block_size, of_block_size) * std::pow(factor, of_factor);
}

std::optional<double> FirstGuess::factor_of(const ContactMaterial& mortar) const {
  // by name: a program may be linked without the tables of these laws
  std::string_view of = mortar.law->name;
  if (of == CohesiveWithMemory::name) of = Cohesive::name;
  if (of == MixedModeWithMemory::name) of = MixedMode::name;
  if (of != law) return std::nullopt;
  const auto over = [&](const char* key, double of_guess) {
    return mortar[key](kReferenceTemperature) / of_guess;
  };
  const auto [least, most] =
      std::minmax({over("f_t", contacts.f_t), over("f_cm", contacts.f_cm), over("c_o", contacts.c_o)});
  const double friction = over("phi", contacts.phi);
  if (most > kSameMix * least || friction > kSameMix || friction * kSameMix < 1.0) return std::nullopt;
  return std::sqrt(least * most);
}

const FirstGuess& first_guess(int dimension) {
  return dimension == 2 ? kPlane : kSpace;
}

}  // namespace pyroclast
