// Shared objects that pyroclast has to refuse; compiled once for each REFUSED_..., with the flags that it
// tells of.
#include "pyroclast/plugin/stamp.hpp"
#include "small.hpp"

#ifdef REFUSED_symbol
extern "C" [[gnu::visibility("default")]] int something_else() {
  return 1;
}
#else
extern "C" [[gnu::visibility("default")]] const pyroclast_law* pyroclast_law_v1() {
  static pyroclast_law law = pyroclast::describe_law<small::Law, pyroclast::Dimensions::plane>(VERSION, {});
#ifdef REFUSED_version
  law.version = "0.0.1";
#elif defined(REFUSED_table)
  law.table_version = 1000;
#elif defined(REFUSED_layout)
  law.layout += 1;
#elif defined(REFUSED_magic)
  law.magic[0] = 'P';
#elif defined(REFUSED_name)
  static pyroclast::LawTable table = *law.table;
  table.name = "cohesive";
  law.table = &table;
#endif
  return &law;
}
#endif
