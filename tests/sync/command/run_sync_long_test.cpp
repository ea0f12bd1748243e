#include "tests/sync/command/run_sync_fixture.h"

namespace venato::sync {
namespace {

using namespace test;

TEST(RunSyncLong, FractionMapOfVeinsThatWereNotPlannedThisWay) {
  Case c;
  c.write_fractions(5);
  c.write_graphic(5);
  expect_registered(c);
  EXPECT_EQ(c.score().at("details").at("evidence"), "vein fraction against lightness");
}

TEST(RunSyncLong, CameraPictureAndGraphic) {
  Case c;
  c.write_camera(5);
  c.write_graphic(5);
  expect_registered(c);
}

TEST(RunSyncLong, SameBytesForAnyThreadCount) {
  Case c;
  c.write_fractions(5);
  c.write_graphic(5);
  expect_same_bytes_for_any_threads(c);
}

}  // namespace
}  // namespace venato::sync
