#include <cmath>

#include "pyroclast/units/units.hpp"
#include "targets.hpp"

namespace pyroclast::fuzz {

bool quantity(std::string_view text) {
  bool taken = false;
  for (const Unit& unit : {unit::stress, unit::temperature, unit::dimensionless, unit::heat_transfer})
    taken |= takes([&] { require(std::isfinite(parse_quantity(text, unit)), "a quantity is finite"); });
  return taken;
}

}  // namespace pyroclast::fuzz
