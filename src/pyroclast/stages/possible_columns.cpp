#include "pyroclast/stages/possible_columns.hpp"

#include "pyroclast/simulation/loop/exchange.hpp"
#include "pyroclast/simulation/loop/run.hpp"
#include "pyroclast/stages/opening_control.hpp"

namespace pyroclast {

std::vector<Column> possible_columns() {
  std::vector<Column> columns{stage_column()};
  for (const auto& more : {possible_gauge_columns(), Exchange::columns(), OpeningControl::columns()})
    columns.insert(columns.end(), more.begin(), more.end());
  return columns;
}

}  // namespace pyroclast
