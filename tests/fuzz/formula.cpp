#include <cmath>
#include <string>

#include "pyroclast/material/curve.hpp"
#include "targets.hpp"

namespace pyroclast::fuzz {

bool formula(std::string_view text) {
  return takes([&] {
    const Curve curve = Curve::expression(std::string(text), {20.0, 800.0}, temperature_axis());
    for (const double temperature : {20.0, 314.15, 800.0})
      takes([&] { require(std::isfinite(curve(temperature)), "a formula's value is finite"); });
  });
}

}  // namespace pyroclast::fuzz
