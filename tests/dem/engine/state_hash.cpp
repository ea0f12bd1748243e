/// Prints hashes of small runs. Built several times with the engine at different optimisation levels (tests/CMakeLists.txt): the lines must be equal.
#include <cstdio>

#include "tests/dem/engine/stirred_scene.h"

int main() {
  using namespace venato::dem;
  for (const LawKind law : {LawKind::hertz_mindlin_epsd, LawKind::eepa}) {
    Simulation sim = scene::stirred_heap(300, 1, law);
    for (int k = 0; k < 4; ++k) {
      sim.step(500);
      std::printf("law %d step %lld contacts %.0f hash %016llx\n", static_cast<int>(law), static_cast<long long>(sim.step_number()),
                  sim.statistics().contact_count, static_cast<unsigned long long>(sim.state_hash()));
    }
  }
}
