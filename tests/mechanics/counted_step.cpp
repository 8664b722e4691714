#include <cstdio>
#include <cstdlib>

#include "bodies.hpp"

/// counted_step STEPS [finite]: takes steps of 300 raw cells in AVX2, with small or finite kinematics, and
/// prints the number of zones. The script count_instructions counts their instructions.
int main(int argc, char** argv) {
  using namespace pyroclast;
  if (argc != 2 && argc != 3) return 2;
  const ModelOf<3> model = bodies::laguerre_cells(300, 0.1, 1);
  auto parameters = bodies::quasi_static<3>();
  parameters.instructions = InstructionSet::avx2;
  if (argc == 3) parameters.kinematics = Kinematics::finite;
  auto m = bodies::mechanics(model, mortar_contact(), parameters);
  for (int g = 0; g < model.gridpoint_count(); ++g)
    if (const double y = model.position[g][1]; y == 0.0 || y == 0.1)
      for (int i = 0; i < 3; ++i) m.constraints().prescribe_velocity(g, i, i == 1 && y == 0.1 ? -1e-4 : 0.0);
  m.advance(std::atoi(argv[1]));
  if (m.totals().energy().dissipated.total() != 0.0) return 1;  // the count is of an intact body
  std::printf("%d\n", model.zone_count());
}
