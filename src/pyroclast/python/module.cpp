#include "pyroclast/base/physics_version.hpp"
#include "pyroclast/mechanics/instruction_set.hpp"
#include "pyroclast/python/bindings.hpp"
#include "pyroclast/version.hpp"

PYBIND11_MODULE(_core, m) {
  using namespace pyroclast::python;
  pyroclast::best_instruction_set();  // its Error ends the import where no set is usable
  m.doc() = "The library of pyroclast, as its package for Python needs it. Use the package.";
  m.attr("version") = pyroclast::kVersion;
  m.attr("physics_version") = pyroclast::kPhysicsVersion;
  m.attr("commit") = pyroclast::kCommit;
  m.attr("instruction_sets") = pyroclast::describe_built_instruction_sets();
  bind_errors(m);
  bind_decks(m);
  bind_laws(m);
  bind_stages(m);
  bind_specimens(m);
  bind_sessions(m);
  bind_tables(m);
}
