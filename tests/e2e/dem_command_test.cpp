// `venato dem` as a user meets it: what it leaves, how it stops and goes on, what it refuses.
#include <gtest/gtest.h>

#include <regex>

#include "base/io/file_lock.h"
#include "tests/e2e/program.h"

namespace venato::e2e {
namespace {
/// The heap with a few large grains, in a second or two.
const std::string kHeap = "dem '" VENATO_SOURCE_DIR
                          "/configs/dem/lifted_cylinder.json' --set /coarse_graining=6 --set /duration_s=0.4 --set /fills/0/mass_g=1.5 --set "
                          "/materials/0/young_modulus_mpa=1 --set "
                          "/walls/1/motion/translate_when_s=[[0.15,0.4]] --set '/snapshots=[]' --set /pictures/every_s=0.1 --set "
                          "/pictures/width_px=200 --set /vtk/every_s=0.05 ";

fs::path checkpoint_of(const TempFolder& t) {
  for (const auto& e : fs::recursive_directory_iterator(t / ".store"))
    if (e.path().filename() == "case.checkpoint") return e.path();
  return {};
}
int files_in(const fs::path& folder) {
  int n = 0;
  for (const auto& e : fs::directory_iterator(folder)) n += e.is_regular_file();
  return n;
}
/// Every frame that an index names is there.
void expect_whole_index(const fs::path& pvd, int frames) {
  const std::string text = slurp(pvd);
  const std::regex file("file=\"([^\"]+)\"");
  int n = 0;
  for (std::sregex_iterator k(text.begin(), text.end(), file), end; k != end; ++k, ++n)
    EXPECT_TRUE(fs::exists(pvd.parent_path() / (*k)[1].str())) << (*k)[1].str();
  EXPECT_EQ(n, frames);
}

TEST(DemCommand, leaves_numbers_plots_pictures_and_says_what_it_costs) {
  TempFolder t;
  const Ran ran = run_venato(t, kHeap + "-o @/out --profile");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(std::regex_search(ran.err, std::regex("lifted_cylinder: about \\d+ grains, \\d+ steps of .* particle-steps, \\d+ MiB, about ")))
      << ran.err;
  EXPECT_NE(ran.err.find("profile: list"), std::string::npos) << ran.err;
  EXPECT_TRUE(std::regex_search(ran.out, std::regex("repose_angle_deg +[0-9.]+ \\+- [0-9.]+ deg  \\(6 wedges\\)"))) << ran.out;
  for (const char* name : {"result.h5", "kpi.csv", "heap_profile.csv", "heap_profile.svg", "case.json"})
    EXPECT_TRUE(fs::exists(t / "out" / name)) << name;
  EXPECT_EQ(files_in(t / "out/pictures"), 5);  // 0, 0.1, 0.2, 0.3 s and the end
  EXPECT_EQ(slurp(t / "out/pictures/picture_0004.png").substr(1, 3), "PNG");
  expect_whole_index(t / "out/vtk/grains.pvd", 9);
  EXPECT_TRUE(checkpoint_of(t).empty());
}
TEST(DemCommand, until_and_resume_give_the_same_bytes_as_one_run) {
  TempFolder t;
  ASSERT_EQ(run_venato(t, kHeap + "-o @/whole --threads 1").code, 0);
  const Ran part = run_venato(t, kHeap + "-o @/part --threads 1 --until 0.17");
  ASSERT_EQ(part.code, 0) << part.err;
  EXPECT_NE(part.err.find("--resume"), std::string::npos) << part.err;
  EXPECT_EQ(part.out.find("repose_angle_deg"), std::string::npos) << "a part of a run is not measured";
  EXPECT_TRUE(fs::exists(t / "part/result.h5"));
  expect_whole_index(t / "part/vtk/grains.pvd", 4);
  // Without a word about it, nothing is thrown away and nothing goes on by itself.
  const Ran asked = run_venato(t, kHeap + "-o @/again");
  EXPECT_EQ(asked.code, 2);
  for (const char* word : {"--resume", "--restart", "stopped before its end"}) EXPECT_NE(asked.err.find(word), std::string::npos) << asked.err;
  EXPECT_FALSE(fs::exists(t / "again"));
  EXPECT_FALSE(checkpoint_of(t).empty());
  const Ran rest = run_venato(t, kHeap + "-o @/resumed --threads 2 --resume");
  ASSERT_EQ(rest.code, 0) << rest.err;
  EXPECT_NE(rest.err.find("goes on from t = 0.17"), std::string::npos) << rest.err;
  EXPECT_TRUE(checkpoint_of(t).empty());
  int compared = 0;
  for (const auto& e : fs::recursive_directory_iterator(t / "whole")) {
    if (!e.is_regular_file()) continue;
    const fs::path other = (t / "resumed") / fs::relative(e.path(), t / "whole");
    ++compared;
    EXPECT_EQ(slurp(e.path()), slurp(other)) << other;
  }
  EXPECT_GT(compared, 25);  // with all ParaView frames and pictures of both parts
  expect_whole_index(t / "resumed/vtk/grains.pvd", 9);
}
TEST(DemCommand, restart_begins_anew_and_resume_without_a_checkpoint_begins) {
  TempFolder t;
  ASSERT_EQ(run_venato(t, kHeap + "-o @/part --until 0.1").code, 0);
  const Ran anew = run_venato(t, kHeap + "-o @/part --until 0.05 --restart");
  ASSERT_EQ(anew.code, 0) << anew.err;
  EXPECT_NE(anew.err.find("stopped at t = 0.05"), std::string::npos) << anew.err;
  fs::remove_all(t / ".store");
  const Ran resumed = run_venato(t, kHeap + "-o @/part --until 0.05 --resume");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_NE(resumed.err.find("no checkpoint of this case"), std::string::npos) << resumed.err;
}
TEST(DemCommand, two_processes_do_not_share_one_case) {
  TempFolder t;
  ASSERT_EQ(run_venato(t, kHeap + "-o @/part --until 0.05").code, 0);
  const fs::path file = checkpoint_of(t).parent_path().string() + ".lock";
  {
    const auto lock = FileLock::try_take(file);
    ASSERT_TRUE(lock);
    const Ran second = run_venato(t, kHeap + "-o @/other --resume");
    EXPECT_EQ(second.code, 1);
    EXPECT_NE(second.err.find("being run by another process"), std::string::npos) << second.err;
    EXPECT_FALSE(fs::exists(t / "other"));
  }
  EXPECT_EQ(run_venato(t, kHeap + "-o @/other --resume --until 0.06").code, 0);  // negative control: it was the lock
}
TEST(DemCommand, its_keys_are_described) {
  TempFolder t;
  const Ran text = run_venato(t, "describe-config --dem"), schema = run_venato(t, "describe-config --dem --schema");
  ASSERT_EQ(text.code, 0) << text.err;
  for (const char* key : {"/rig/kind", "tapped_density", "/pictures/every_s", "/smallest_opening_mm", "/walls/N/motion/tapping"})
    EXPECT_NE(text.out.find(key), std::string::npos) << key;
  EXPECT_TRUE(nlohmann::json::parse(schema.out).at("properties").contains("rig"));
}
TEST(DemCommand, bad_options_exit_with_two) {
  TempFolder t;
  for (const char* options : {"--until 0", "--until -1", "--until soon", "--resume --restart", "--threads 0", "--until"}) {
    const Ran ran = run_venato(t, kHeap + "-o @/out " + options);
    EXPECT_EQ(ran.code, 2) << options << ran.err;
    EXPECT_NE(ran.err.find("venato: "), std::string::npos) << ran.err;
    EXPECT_FALSE(fs::exists(t / "out")) << options;
  }
  const Ran bad = run_venato(t, kHeap + "-o @/out --set /rig/kind=static_respose --set /rigs=1");
  EXPECT_EQ(bad.code, 2);
  for (const char* word : {"/rig/kind", "static_repose"}) EXPECT_NE(bad.err.find(word), std::string::npos) << bad.err;
}
}  // namespace
}  // namespace venato::e2e
