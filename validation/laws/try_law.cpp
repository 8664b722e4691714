// Tries one law, named when this is compiled: -DLAW=Cohesive -DLAW_HEADER="pyroclast/laws/cohesive.hpp".
// try_law PATHS SEED: prints the kit's report; 1 when the law fails.
#include <cstdlib>

#include <fmt/format.h>

#include "pyroclast/laws/kit.hpp"
#include "pyroclast/mechanics/step/contacts.hpp"
#include LAW_HEADER

int main(int, char** words) {
  pyroclast::KitOptions options;
  options.paths = std::atoi(words[1]);
  options.seed = std::strtoull(words[2], nullptr, 10);
  // eight points by the code of the step find a law that does not tell what changed
  using pyroclast::Contacts, pyroclast::Portable;
  using Law = pyroclast::LAW;
  options.lanes = {{"portable lanes",
                    {Contacts<2, Portable, Law>::update_lanes, Contacts<3, Portable, Law>::update_lanes}}};
  const pyroclast::KitReport report = pyroclast::verify(pyroclast::table_of<pyroclast::LAW>(), options);
  fmt::print("{}", report.text());
  return report.passed() ? 0 : 1;
}
