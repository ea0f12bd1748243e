#pragma once
#include <gtest/gtest.h>

#include "line/stages/stage_api.h"
namespace venato::line {

/// A narrow strip with the demo's powders and materials: enough to build and run the stages' slices.
inline LineBasics small_line() {
  LineBasics b;
  b.belt_speed_m_s = 0.1;
  b.fired_thickness_m = 0.012;
  const dem::SizeDistribution psd{375e-6, 2.75, 250e-6, 500e-6};
  b.powders = {{"white", {240, 238, 230}, psd, 1850, 1050}, {"grey", {120, 115, 110}, psd, 1850, 1050}};
  b.materials.materials = {{"grain", 1850, 2e6, 0.25}, {"steel", 7800, 5e7, 0.3}, {"belt", 1200, 2e7, 0.3}};
  const dem::PairProperties grains{0.44, 0.5, 0.1, 0.3}, steel{0.44, 0.36, 0.1, 0.3}, belt{0.44, 0.6, 0.1, 0.3};
  b.materials.pairs = {grains, steel, belt, steel, steel, steel, belt, steel, belt};
  b.bed_mass_kg_m2 = 26.8;
  b.grid = {60, 120, 10, 0.001, 0.05};
  b.seed = 1;
  b.bootstrap_replicates = 2;
  return b;
}

/// A stage's config from its declared defaults.
template <class Config>
Config defaults(void (*read)(ObjectReader&, Config&)) {
  Config c;
  const ReadOutcome o = read_config_text("{}", ".", {}, [&](ObjectReader& r) { read(r, c); });
  EXPECT_TRUE(o.ok()) << (o.issues.empty() ? "" : o.issues[0].pointer + ": " + o.issues[0].problem);
  return c;
}
}  // namespace venato::line
