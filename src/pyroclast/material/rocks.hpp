#pragma once

#include <span>
#include <string_view>

namespace pyroclast {

/// Number with its source; a source that begins with "guess" says so, and what is known beside it.
struct SourcedNumber {
  double value;
  std::string_view source;
};

/// Rock of which aggregates are made, with the numbers for a first guess of a concrete.
struct Rock {
  std::string_view name;
  SourcedNumber modulus;            ///< Young's modulus, GPa
  SourcedNumber poisson;            ///< Poisson's ratio
  SourcedNumber density;            ///< kg/m³
  SourcedNumber expansion;          ///< linear, near 20 °C, 1e-6/K
  SourcedNumber expansion_ratio;    ///< its expansion over the expansion of its concrete, up to some 600 °C
  std::string_view concrete_curve;  ///< built-in free thermal strain of its concrete
  std::string_view curve_source;
};

/// Returns the rocks, in the order in which lists print them.
std::span<const Rock> rocks();

/// Returns a rock by its name. Throws Error that lists them all.
const Rock& rock(std::string_view name);

}  // namespace pyroclast
