#include "dem/case_reader.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "base/error.h"
#include "dem/coarse_graining/openings.h"
#include "dem/material_reader.h"
#include "dem/rigs/rig_api.h"
#include "dem/run_case.h"

namespace venato::dem {
namespace {
const std::filesystem::path kConfigs = std::filesystem::path(VENATO_SOURCE_DIR) / "configs/dem";

struct Read {
  Case c;
  ReadOutcome outcome;
};
Read read(const std::vector<Override>& changes = {}, const std::string& file = "slot_hopper.json") {
  Read r;
  r.outcome = read_config_file(kConfigs / file, changes, [&r](ObjectReader& reader) { read_case(reader, r.c); });
  return r;
}
std::string issue_list(const ReadOutcome& outcome) {
  std::string text;
  for (const ConfigIssue& i : outcome.issues) text += i.pointer + ": " + i.problem + " | " + i.suggestion + "\n";
  return text;
}

TEST(CaseReader, every_ready_case_is_valid_and_has_a_cost) {
  int cases = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kConfigs)) {
    if (entry.path().extension() != ".json") continue;
    ++cases;
    const Case c = load_case(entry.path());
    EXPECT_EQ(c.name, entry.path().stem().string());
    const CaseCost cost = estimate_cost(c, 2);
    EXPECT_TRUE(cost.seconds > 0 && cost.seconds < 300) << entry.path() << " " << cost.seconds;  // ready cases take minutes
  }
  EXPECT_GE(cases, 2);
}

TEST(CaseReader, narrow_places_and_rigs_lead_to_warnings) {
  // slot_hopper's rig states its 6 mm slot; 0.39 mm grains times 2.
  const auto [c, outcome] = read();
  ASSERT_TRUE(outcome.ok()) << issue_list(outcome);
  ASSERT_EQ(c.openings.size(), 1u);
  EXPECT_NEAR(c.openings[0].size_m, 6e-3, 1e-15);
  EXPECT_TRUE(c.openings[0].slot);
  ASSERT_EQ(coarse_graining_warnings(c).size(), 1u);
  const auto fine = read({{"/coarse_graining", "1"}});
  EXPECT_TRUE(coarse_graining_warnings(fine.c).empty());
  const auto stated =
      read({{"/coarse_graining", "1.5"}, {"/smallest_opening_mm", "2"}, {"/smallest_opening_form", "hole"}, {"/layer_thickness_mm", "4"}});
  ASSERT_TRUE(stated.outcome.ok()) << issue_list(stated.outcome);
  const auto warnings = coarse_graining_warnings(stated.c);
  ASSERT_EQ(warnings.size(), 2u);  // the slot of the rig is wide enough now: 10 grains, 0.93 of the flow
  EXPECT_NE(warnings[0].find("smallest opening of 2 mm"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("layer of 4 mm"), std::string::npos) << warnings[1];
}
TEST(CaseReader, rigs_read_their_keys_and_refuse_what_does_not_fit) {
  for (const RigDescriptor& d : all_rigs()) EXPECT_FALSE(d.help.empty()) << d.name;
  EXPECT_EQ(all_rigs().size(), 5u);
  const struct {
    const char *file, *pointer, *value, *expected;
  } bad[] = {{"slot_hopper.json", "/rig/counter", "\"slott\"", "there is no counter 'slott'"},
             {"slot_hopper.json", "/rig/openings/0/to_s", "9", "closes after the end of the run"},
             {"slot_hopper.json", "/rig/openings/0/to_s", "0.31", "before the flow has settled"},
             {"slot_hopper.json", "/rig/kind", "\"repose\"", "is not one of"},
             {"slot_hopper.json", "/rig/bulk_region/high_mm", "[8, 10, 300]", "the box from"},
             {"lifted_cylinder.json", "/rig/fit_to", "0.12", "is not above fit_from"},
             {"rotating_drum.json", "/rig/speeds/2/to_s", "9", "ends after the end of the run"},
             {"rotating_drum.json", "/rig/speeds/0/to_s", "0.95", "fewer than 16 frames"},
             {"tapped_density.json", "/rig/taps", "60", "after the end of the run"},
             {"tapped_density.json", "/walls/0/motion/tapping/period_s", "0.02", "too short"},
             {"inclined_wall.json", "/rig/wall", "\"front\"", "is not a plane that rotates"},
             {"inclined_wall.json", "/rig/wall", "\"board\"", "there is no wall 'board'"}};
  for (const auto& b : bad) {
    const auto [c, outcome] = read({{b.pointer, b.value}}, b.file);
    EXPECT_NE(issue_list(outcome).find(b.expected), std::string::npos) << b.file << " " << b.pointer << ": " << issue_list(outcome);
  }
}
TEST(CaseReader, tapping_is_a_track_of_lifts_and_falls) {
  const auto [c, outcome] = read({}, "tapped_density.json");
  ASSERT_TRUE(outcome.ok()) << issue_list(outcome);
  const auto& track = c.walls[0].motion.track;
  ASSERT_FALSE(track.empty());
  EXPECT_EQ(track.size(), c.walls[1].motion.track.size());
  EXPECT_NEAR(track.front().time_s, 0.3, 1e-12);
  double highest = 0, fastest = 0;
  for (std::size_t k = 1; k < track.size(); ++k) {
    EXPECT_GT(track[k].time_s, track[k - 1].time_s);
    highest = std::max(highest, track[k].offset_m.z());
    fastest = std::max(fastest, (track[k - 1].offset_m.z() - track[k].offset_m.z()) / (track[k].time_s - track[k - 1].time_s));
  }
  EXPECT_NEAR(highest, 1e-3, 1e-12);
  // Free fall over 1 mm ends at sqrt(2 g h); the last of 12 straight pieces is 1/24 slower.
  EXPECT_NEAR(fastest / std::sqrt(2 * 9.80665 * 1e-3), 1 - 1.0 / 24, 1e-6);
  EXPECT_EQ(track.back().offset_m, Vec3(Vec3::Zero()));  // it rests on its floor in the end
  EXPECT_LT(track.back().time_s, 0.3 + 40 * 0.08);
}
TEST(CaseReader, slot_hopper_in_si) {
  const auto [c, outcome] = read();
  ASSERT_TRUE(outcome.ok()) << issue_list(outcome);
  EXPECT_EQ(c.name, "slot_hopper");
  EXPECT_EQ(c.seed, 1u);
  EXPECT_NEAR(c.duration_s, 0.65, 1e-15);
  EXPECT_TRUE(c.box.periodic[0]);
  EXPECT_FALSE(c.box.periodic[1]);
  EXPECT_NEAR((c.box.high - Vec3(8e-3, 20e-3, 90e-3)).norm(), 0, 1e-15);
  EXPECT_NEAR(c.gravity_m_s2.z(), -9.80665, 1e-15);
  ASSERT_EQ(c.materials.materials.size(), 2u);
  EXPECT_NEAR(c.materials.materials[0].young_modulus_pa, 5e6, 1e-6);
  EXPECT_NEAR(c.materials.materials[0].density_kg_m3, 1900, 1e-12);
  EXPECT_NEAR(c.materials.pair(0, 1).sliding_friction, 0.3, 1e-15);
  EXPECT_NEAR(c.materials.pair(1, 0).sliding_friction, 0.3, 1e-15);
  EXPECT_EQ(c.materials.pair(1, 1).sliding_friction, 0);  // not given: two walls never touch
  ASSERT_EQ(c.powders.size(), 1u);
  EXPECT_NEAR(c.powders[0].psd.scale_m, 400e-6, 1e-18);
  EXPECT_NEAR(c.powders[0].psd.upper_cut_m, 600e-6, 1e-18);
  EXPECT_EQ(c.coarse_graining, 2);
  ASSERT_EQ(c.walls.size(), 3u);
  EXPECT_EQ(c.walls[0].material, 1);
  const auto& mesh = std::get<MeshShape>(c.walls[0].shape);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  for (const Triangle& t : mesh.triangles)
    for (const Vec3& p : {t.a, t.b, t.c}) EXPECT_TRUE(p.x() == c.box.low.x() || p.x() == c.box.high.x());
  EXPECT_NEAR(c.walls[2].present.off_s, 0.3, 1e-15);
  ASSERT_EQ(c.fills.size(), 1u);
  EXPECT_NEAR(c.fills[0].mass_kg, 2.2e-3, 1e-15);
  ASSERT_EQ(c.counters.size(), 1u);
  EXPECT_EQ(c.counters[0].sign, -1);
  EXPECT_EQ(c.counters[0].axis, 2);
  EXPECT_TRUE(c.counters[0].remove);
  EXPECT_NEAR(c.counters[0].position_m, 2e-3, 1e-15);
  ASSERT_EQ(c.snapshots.size(), 2u);  // its own, and one frame that the rig takes the bulk density from
  EXPECT_EQ(c.vtk_every_s, 0);
  EXPECT_EQ(c.time_step_s, 0);
}

TEST(CaseReader, shapes_motions_rain_and_laws) {
  auto [c, outcome] =
      read({{"/walls/2/motion", R"({"velocity_m_s":[0,0.1,0],"translate_when_s":[[0.1,0.2],[0.3,0.4]],
      "track":[{"time_s":0,"offset_mm":[0,0,0]},{"time_s":1,"offset_mm":[0,5,0]}],"rotation":{"centre_mm":[0,1,2],"speed_deg_s":[0,0,180]},
      "vibration":{"amplitude_um":[0,0,50],"frequency_hz":200,"phase_deg":90,"when_s":[[0,1]]},"surface_velocity_m_s":[0,0.3,0]})"},
            {"/contact", R"({"law":"eepa","stiffness_ratio_k2_k1":5,"adhesion_ratio_kadh_k1":0.5,"constant_force_mn":-2})"},
            {"/rains", R"([{"name":"top","low_mm":[0,-5,60],"high_mm":[8,5,80],"mass_fractions":[1],"mass_rate_g_s":2.5,"when_s":[[0,0.5]],
      "velocity_m_s":[0,0,-0.2],"level_control":{"z_mm":55}}])"},
            {"/time_step", R"({"fixed_us":2})"},
            {"/vtk", R"({"every_s":0.02})"}});
  ASSERT_TRUE(outcome.ok()) << issue_list(outcome);
  const WallMotion& m = c.walls[2].motion;
  EXPECT_NEAR(m.velocity_m_s.y(), 0.1, 1e-15);
  ASSERT_EQ(m.translate_when.size(), 2u);
  EXPECT_NEAR(m.translate_when[1].on_s, 0.3, 1e-15);
  ASSERT_EQ(m.track.size(), 2u);
  EXPECT_NEAR(m.track[1].offset_m.y(), 5e-3, 1e-15);
  EXPECT_NEAR(m.rotation_rad_s.z(), std::numbers::pi, 1e-12);
  EXPECT_NEAR(m.rotation_centre.z(), 2e-3, 1e-15);
  EXPECT_NEAR(m.vibration_amplitude_m.z(), 50e-6, 1e-18);
  EXPECT_NEAR(m.vibration_hz, 200, 1e-12);
  EXPECT_NEAR(m.vibration_phase_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(m.surface_velocity_m_s.y(), 0.3, 1e-15);
  EXPECT_EQ(c.law, LawKind::eepa);
  EXPECT_EQ(c.eepa.exponent, 1.5);
  EXPECT_NEAR(c.eepa.constant_force_n, -2e-3, 1e-18);
  ASSERT_EQ(c.rains.size(), 1u);
  EXPECT_NEAR(c.rains[0].mass_rate_kg_s, 2.5e-3, 1e-18);
  EXPECT_NEAR(c.rains[0].level_z_m, 0.055, 1e-15);
  EXPECT_NEAR(c.time_step_s, 2e-6, 1e-20);
  EXPECT_NEAR(c.vtk_every_s, 0.02, 1e-15);
}

TEST(CaseReader, dense_fill) {
  const auto [c, outcome] =
      read({{"/fills/0", R"({"low_mm":[0,-10,8],"high_mm":[8,10,20],"mass_fractions":[1],"packing":"dense","solid_fraction":0.6})"}});
  ASSERT_TRUE(outcome.ok()) << issue_list(outcome);
  ASSERT_EQ(c.fills.size(), 1u);
  EXPECT_EQ(c.fills[0].solid_fraction, 0.6);
  EXPECT_EQ(c.fills[0].mass_kg, 0);
  EXPECT_EQ(read().c.fills[0].solid_fraction, 0);  // lattice unless asked
}

TEST(CaseReader, cylinder_and_plane) {
  const auto [c, outcome] = read({}, "lifted_cylinder.json");
  ASSERT_TRUE(outcome.ok()) << issue_list(outcome);
  EXPECT_EQ(std::get<PlaneShape>(c.walls[0].shape).normal, Vec3(0, 0, 1));
  const auto& tube = std::get<CylinderShape>(c.walls[1].shape);
  EXPECT_NEAR(tube.radius_m, 9e-3, 1e-15);
  EXPECT_NEAR(tube.length_m, 82e-3, 1e-15);
  EXPECT_TRUE(tube.inside);
}

TEST(CaseReader, mesh_from_a_file) {
  const auto file = std::filesystem::temp_directory_path() / ("venato_case_reader_" + std::to_string(::getpid()) + ".stl");
  std::ofstream(file) << "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 0 3 0\nendloop\nendfacet\nendsolid s\n";
  const std::string wall = R"({"name":"gate","material":"steel","shape":"mesh","offset_mm":[0,0,7],"file":")" + file.string() + "\"}";
  const auto [c, outcome] = read({{"/walls/2", wall}});
  ASSERT_TRUE(outcome.ok()) << issue_list(outcome);
  const auto& mesh = std::get<MeshShape>(c.walls[2].shape);
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_NEAR((mesh.triangles[0].c - Vec3(0, 3e-3, 7e-3)).norm(), 0, 1e-12);
  std::ofstream(file) << "";
  const auto bad = read({{"/walls/2", wall}});
  EXPECT_NE(issue_list(bad.outcome).find("/walls/2/file"), std::string::npos) << issue_list(bad.outcome);
  EXPECT_NE(issue_list(bad.outcome).find("empty"), std::string::npos) << issue_list(bad.outcome);
  std::filesystem::remove(file);
}

struct Mistake {
  const char* pointer;
  const char* value;
  const char* issue_at;  ///< pointer of the issue
  const char* says;
};

TEST(CaseReader, each_mistake_is_reported_where_it_is) {
  for (const Mistake& m : {
           Mistake{"/format", "\"venato-line\"", "/format", "venato-dem"},
           {"/version", "2", "/version", ""},
           {"/coarse_grainin", "2", "/coarse_grainin", "not a known key"},
           {"/duration_s", "\"1.2\"", "/duration_s", "number"},
           {"/duration_s", "-1", "/duration_s", ""},
           {"/box/high_mm", "[8, -20, 90]", "/box", "upper corner"},
           {"/box/high_mm", "[8, 20]", "/box/high_mm", ""},
           {"/box/high_mm", "[2, 20, 90]", "/box", "periodic length along x"},
           {"/materials/1/name", "\"granulate\"", "/materials", "used twice"},
           {"/materials/0/poisson_ratio", "0.6", "/materials/0/poisson_ratio", ""},
           {"/materials/0/kind", "\"powder\"", "/materials/0/kind", ""},
           {"/pairs/1/b", "\"brass\"", "/pairs/1/b", "no material 'brass'"},
           {"/pairs/1", R"({"a":"granulate","b":"granulate","restitution":0.5,"sliding_friction":0.5,"rolling_friction":0.1})", "/pairs",
            "'granulate' - 'steel' is missing"},
           {"/pairs/1", R"({"a":"granulate","b":"granulate","restitution":0.5,"sliding_friction":0.5,"rolling_friction":0.1})", "/pairs/1",
            "given twice"},
           {"/pairs/0/restitution", "1.5", "/pairs/0/restitution", ""},
           {"/powders/0/material", "\"steel\"", "/powders/0/material", "wall material"},
           {"/powders/0/material", "\"sand\"", "/powders/0/material", "no material 'sand'"},
           {"/powders/0/lower_cut_um", "0", "/powders/0/lower_cut_um", ""},
           {"/powders/0/lower_cut_um", "700", "/powders/0/lower_cut_um", "upper cut"},
           {"/contact/law", "\"hertz\"", "/contact/law", ""},
           {"/contact", R"({"law":"eepa","stiffness_ratio_k2_k1":5,"adhesion_ratio_kadh_k1":0.5,"exponent":1.2})", "/contact/exponent",
            "neither 1 nor 1.5"},
           {"/walls/0/material", "\"glass\"", "/walls/0/material", "known: granulate, steel"},
           {"/walls/0/shape", "\"cone\"", "/walls/0/shape", ""},
           {"/walls/0/points_mm", "[[0,0]]", "/walls/0/points_mm", ""},
           {"/walls/0/points_mm", "[[0,0],[0,0]]", "/walls/0/points_mm", "coincide"},
           {"/walls/1/name", "\"left\"", "/walls", "used twice"},
           {"/walls/1/name", "\"../left\"", "/walls/1/name", ""},
           {"/walls/0", R"({"name":"left","material":"steel","shape":"plane","point_mm":[0,0,0],"normal":[0,0,0]})", "/walls/0/normal", "no length"},
           {"/walls/0", R"({"name":"left","material":"steel","shape":"mesh","file":"missing.stl"})", "/walls/0/file", ""},
           {"/walls/2/present/to_s", "0", "/walls/2/present/to_s", "before it appears"},
           {"/walls/0/motion", R"({"translate_when_s":[[2,1]]})", "/walls/0/motion/translate_when_s", "ends before it starts"},
           {"/walls/0/motion", R"({"translate_when_s":[[1,3],[2,4]]})", "/walls/0/motion/translate_when_s", "before the one before it ends"},
           {"/walls/0/motion", R"({"track":[{"time_s":1,"offset_mm":[0,0,0]},{"time_s":1,"offset_mm":[0,0,1]}]})", "/walls/0/motion/track/1/time_s",
            "rising"},
           {"/fills/0/mass_fractions", "[0.9]", "/fills/0/mass_fractions", "not to 1"},
           {"/fills/0/mass_fractions", "[0.5, 0.5]", "/fills/0/mass_fractions", "1 powders"},
           {"/fills/0/high_mm", "[8, 11, 95]", "/fills/0/low_mm", "the box from"},
           {"/fills/0/high_mm", "[8, -11, 86]", "/fills/0/high_mm", "along y"},
           {"/fills/0/packing", "\"random\"", "/fills/0/packing", ""},
           {"/fills/0/packing", "\"dense\"", "/fills/0/solid_fraction", "at least 0.1"},
           {"/fills/0/solid_fraction", "0.6", "/fills/0/solid_fraction", "no meaning for a lattice"},
           {"/fills/0/solid_fraction", "0.75", "/fills/0/solid_fraction", "0.74"},
           {"/fills/0", R"({"low_mm":[0,-10,8],"high_mm":[8,10,20],"mass_fractions":[1],"packing":"dense","solid_fraction":0.6,"mass_g":1})",
            "/fills/0/mass_g", "no meaning for a dense packing"},
           {"/fills", "[]", "", "no grains"},
           {"/counters/0/position_mm", "95", "/counters/0/position_mm", "outside the box"},
           {"/counters/0/axis", "\"w\"", "/counters/0/axis", ""},
           {"/counters/0/window", R"({"low_mm":[0,5,0],"high_mm":[8,4,0]})", "/counters/0/window", "empty"},
           {"/snapshots/0/to_s", "0.1", "/snapshots/0/to_s", "ends before"},
           {"/snapshots/0/from_s", "5", "/snapshots/0/from_s", "after the end"},
           {"/series/every_s", "0", "/series/every_s", ""},
       }) {
    const auto r = read({{m.pointer, m.value}});
    bool found = false;
    for (const ConfigIssue& i : r.outcome.issues)
      found = found || (i.pointer.rfind(m.issue_at, 0) == 0 && (i.problem + i.suggestion).find(m.says) != std::string::npos);
    EXPECT_TRUE(found) << m.pointer << " = " << m.value << "\n" << issue_list(r.outcome);
  }
}

TEST(CaseReader, mistakes_come_all_at_once_as_config_error) {
  try {
    load_case(kConfigs / "slot_hopper.json", {{"/duration_s", "-1"}, {"/walls/0/material", "\"glass\""}});
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_EQ(e.issues().size(), 2u) << e.what();
  }
  EXPECT_THROW(load_case(kConfigs / "nothing.json"), UsageError);
}

TEST(CaseReader, missing_keys_are_required_ones_only) {
  const ReadOutcome outcome = read_config_text("{}", kConfigs, {}, [](ObjectReader& r) {
    Case c;
    read_case(r, c);
  });
  const std::string text = issue_list(outcome);
  for (const char* key :
       {"/format", "/version", "/name", "/seed", "/box", "/materials", "/pairs", "/powders", "/contact", "/duration_s", "/expected_max_speed_m_s"})
    EXPECT_NE(text.find(key), std::string::npos) << key;
  for (const char* key : {"/walls", "/rains", "/counters", "/series", "/vtk", "/coarse_graining", "/gravity", "/time_step"})
    EXPECT_EQ(text.find(std::string(key) + ":"), std::string::npos) << key << "\n" << text;
}

TEST(CaseReader, reference_and_schema_are_made_from_the_same_declarations) {
  const ReadRoot root = [](ObjectReader& r) {
    Case c;
    read_case(r, c);
  };
  const std::string reference = describe_config_text(root);
  for (const char* key : {"lower_cut_um", "vibration", "amplitude_um", "level_control", "stiffness_ratio_k2_k1", "file_unit_mm", "track"})
    EXPECT_NE(reference.find(key), std::string::npos) << key;
  EXPECT_NE(config_json_schema(root, "case").find("lower_cut_um"), std::string::npos);
}

TEST(MaterialReader, pairs_of_two_walls_may_be_missing_and_defaults_apply) {
  MaterialTable table;
  const ReadOutcome outcome =
      read_config_text(R"({"materials":[{"name":"a","kind":"grain","density_kg_m3":2000,"young_modulus_mpa":10,"poisson_ratio":0.25},
      {"name":"b","kind":"wall","young_modulus_mpa":200,"poisson_ratio":0.3},{"name":"c","kind":"wall","young_modulus_mpa":2,"poisson_ratio":0.4}],
      "pairs":[{"a":"a","b":"a","restitution":0.5,"sliding_friction":0.5,"rolling_friction":0.1},{"a":"b","b":"a","restitution":0.6,"sliding_friction":0.4,"rolling_friction":0.1},
      {"a":"a","b":"c","restitution":0.7,"sliding_friction":0.3,"rolling_friction":0.1}]})",
                       kConfigs, {}, [&](ObjectReader& r) { read_materials(r, table); });
  ASSERT_TRUE(outcome.ok()) << issue_list(outcome);
  EXPECT_NEAR(table.pair(0, 1).restitution, 0.6, 1e-15);
  EXPECT_NEAR(table.pair(2, 0).restitution, 0.7, 1e-15);
  EXPECT_EQ(table.pair(1, 2).restitution, 1);
  EXPECT_EQ(table.materials[1].density_kg_m3, 0);
  EXPECT_EQ(outcome.placeholders.size(), 3u);  // rolling_damping_ratio was left to its default three times
  EXPECT_EQ(find_material(table, "c"), 2);
  EXPECT_EQ(find_material(table, "d"), -1);
}
}  // namespace
}  // namespace venato::dem
