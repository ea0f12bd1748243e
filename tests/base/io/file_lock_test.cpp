#include "base/io/file_lock.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "base/error.h"
#include "tests/base/temp_folder.h"

namespace venato {
namespace {
TEST(FileLock, one_holder_at_a_time) {
  TempFolder t;
  auto first = FileLock::try_take(t / "lock");
  ASSERT_TRUE(first);
  EXPECT_FALSE(FileLock::try_take(t / "lock"));
  EXPECT_TRUE(FileLock::try_take(t / "other"));
  first.reset();
  EXPECT_TRUE(FileLock::try_take(t / "lock"));
  EXPECT_EQ(t.file_count(), 0);  // nothing is left behind
}
TEST(FileLock, waits_and_what_the_waiter_throws_ends_the_wait) {
  TempFolder t;
  auto first = FileLock::try_take(t / "lock");
  ASSERT_TRUE(first);
  int looks = 0;
  EXPECT_THROW(FileLock::take(t / "lock",
                              [&] {
                                if (++looks == 2) throw Interrupted("stop");
                              }),
               Interrupted);
  EXPECT_EQ(looks, 2);
  looks = 0;
  const FileLock second = FileLock::take(t / "lock", [&] {
    if (++looks == 2) first.reset();
  });
  EXPECT_EQ(looks, 2);
  EXPECT_FALSE(FileLock::try_take(t / "lock"));  // although the first holder removed the file
}
TEST(FileLock, a_killed_holder_lets_go) {
  TempFolder t;
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const auto held = FileLock::try_take(t / "lock");
    const char ok = held ? 'y' : 'n';
    if (::write(ready[1], &ok, 1) != 1) ::_exit(1);
    ::pause();
    ::_exit(0);
  }
  char ok = 0;
  ASSERT_EQ(::read(ready[0], &ok, 1), 1);
  EXPECT_EQ(ok, 'y');
  EXPECT_FALSE(FileLock::try_take(t / "lock"));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_TRUE(FileLock::try_take(t / "lock"));
}
TEST(FileLock, many_threads_never_hold_it_together) {
  TempFolder t;
  std::atomic<int> inside{0}, most{0};
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([&] {
      for (int i = 0; i < 200; ++i) {
        const auto lock = FileLock::try_take(t / "lock");
        if (!lock) continue;
        const int now = ++inside;
        if (now > most) most = now;
        std::this_thread::yield();
        --inside;
      }
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(most, 1);
}
TEST(FileLock, a_place_that_cannot_be_written_to_is_named) {
  try {
    FileLock::try_take("/nonexistent/lock");
    FAIL();
  } catch (const WorkError& e) {
    EXPECT_NE(std::string(e.what()).find("/nonexistent/lock"), std::string::npos);
  }
}
}  // namespace
}  // namespace venato
