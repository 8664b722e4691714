// Shared objects that pyroclast has to refuse; compiled once for each REFUSED_..., with the flags that it
// tells of.
#include "pyroclast/plugin/stamp.hpp"
#include "small.hpp"

#ifdef REFUSED_flush
#include <xmmintrin.h>

// As the start-up code does that GCC 12 and Clang 14 link to shared objects by -ffast-math:
// numbers near zero are flushed to zero (bit 15), and taken as zero (bit 6).
[[gnu::constructor]] static void flush_to_zero() {
  _mm_setcsr(_mm_getcsr() | 0x8040u);
}
#endif

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
