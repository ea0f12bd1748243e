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
  c.context.context.threads = 1;
  c.run();
  const auto one = contents(c.options.out);
  c.context.context.threads = 2;
  c.run();
  EXPECT_TRUE(one == contents(c.options.out));
}

}  // namespace
}  // namespace venato::sync
