// Tries one law, named when this is compiled: -DLAW=Cohesive -DLAW_HEADER="pyroclast/laws/cohesive.hpp".
// try_law PATHS SEED: prints the kit's report; 1 when the law fails.
#include <cstdlib>

#include <fmt/format.h>

#include "pyroclast/laws/kit.hpp"
#include LAW_HEADER

int main(int, char** words) {
  pyroclast::KitOptions options;
  options.paths = std::atoi(words[1]);
  options.seed = std::strtoull(words[2], nullptr, 10);
  const pyroclast::KitReport report = pyroclast::verify(pyroclast::table_of<pyroclast::LAW>(), options);
  fmt::print("{}", report.text());
  return report.passed() ? 0 : 1;
}
