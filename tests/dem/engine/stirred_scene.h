#pragma once
/// The heap of scene.h on a shaken floor and under a ramp that slides to and fro: contacts of every kind come and go and lists are rebuilt for as
/// long as it runs.
#include "tests/dem/engine/scene.h"

namespace venato::dem::scene {
inline Simulation stirred_heap(int n, int threads, LawKind law = LawKind::hertz_mindlin_epsd) {
  SimulationSetup s = setup(4e-6);
  s.threads = threads, s.law = law;
  Simulation sim = heap(n, s);
  WallMotion shake, slide;
  shake.vibration_amplitude_m = Vec3(5e-5, 0, 1.5e-4), shake.vibration_hz = 70;
  slide.vibration_amplitude_m = Vec3(0, 4e-4, 0), slide.vibration_hz = 25;
  sim.set_wall_motion(0, shake), sim.set_wall_motion(1, slide);
  return sim;
}
}  // namespace venato::dem::scene
