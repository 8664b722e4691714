#include "register.hpp"

namespace bench {

// The place for the parts of the step: zones, contacts, motion. Registered like the steps in step.cpp, named
// kernel/<part>/<loading>/zones:<n>/threads:<n>, on `bodies.mechanics(zones, loading)`.
void register_kernels(Bodies&) {}

}  // namespace bench
