#include <cmath>
#include <functional>

#include "../tables/layouts.hpp"
#include "targets.hpp"

namespace pyroclast::fuzz {

// What is read from any layout equals the plain form: the record of a text, written again in one of thirty
// layouts, is the same to the bit.
bool record(std::string_view text) {
  layouts::Record record;
  const ColumnChoice units{"record.csv", {}, {"s", "degC"}};
  if (!takes([&] { record = layouts::read(text); }) && !takes([&] { record = layouts::read(text, units); }))
    return false;
  for (const auto& [time, temperature] : record)
    require(std::isfinite(time) && std::isfinite(temperature), "a record is finite");
  const layouts::Layout& layout = layouts::all()[std::hash<std::string_view>()(text) % layouts::all().size()];
  if (layouts::can_write(layout, record))
    require(layouts::read(layouts::written(layout, record), layouts::choice_of(layout)) == record,
            "each layout of a record is the same record");
  return true;
}

}  // namespace pyroclast::fuzz
