#include "line/chain/run_chain.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "base/error.h"
#include "base/store/store.h"
#include "tests/base/temp_folder.h"
#include "tests/line/support/fake_line.h"
namespace venato::line {
namespace {

graphics::VeinPlan stripe(const LineBasics& b) {
  graphics::VeinPlan plan;
  plan.powders = {"white", "grey"};
  plan.fraction = graphics::RasterF(100, 200, 2, 0.001);
  for (int j = 0; j < 200; ++j)
    for (int i = 0; i < 100; ++i) plan.fraction.at(i, j, j > 80 && j < 110 ? 1 : 0) = 1;
  (void)b;
  return plan;
}

struct Bench {
  explicit Bench(const std::string& chain = R"([{"stage":"dose"},{"stage":"squeeze"}])")
      : stages(fake::stages()),
        config(load_line_config_text(fake::config_text(chain), "/", {}, stages)),
        store(folder.path()),
        log(make_null_log()),
        progress(make_null_progress()),
        context{*log, *progress, store, 7, 2, &stop} {}
  std::vector<Operator> operators() {
    std::vector<Operator> out;
    for (const auto& s : config.chain) out.push_back(obtain_operator(config, s, context).op);
    return out;
  }
  TempFolder folder;
  std::vector<StageDescriptor> stages;
  LineConfig config;
  Store store;
  std::unique_ptr<Log> log;
  std::unique_ptr<Progress> progress;
  std::atomic<bool> stop{false};
  Context context;
};

TEST(RunChain, SlabHoldsWhatTheCommandsLaid) {
  Bench t;
  const auto commands = t.config.chain[0].stage.plan_commands(stripe(t.config.basics), t.config.basics);
  const auto& g = t.config.basics.grid;
  const auto result = apply_chain(t.config, t.config.basics, t.operators(), commands, JitterField({0.002, 0.4}, g.ny * g.pitch_m, 7), {}, t.context);
  ASSERT_TRUE(result.state.slab.has_value());
  // Whole strip at the bed's areal mass; sums of 1e5 cells keep 1e-9.
  EXPECT_NEAR(result.commands_mass_kg, t.config.basics.bed_mass_kg_m2 * g.nx * g.ny * g.pitch_m * g.pitch_m, 1e-9 * result.commands_mass_kg);
  EXPECT_NEAR(result.slab_mass_kg, result.commands_mass_kg, 1e-9 * result.commands_mass_kg);
  EXPECT_EQ(result.stages.size(), 2u);
}

TEST(RunChain, LostMassIsAnErrorThatNamesTheStage) {
  Bench t(R"([{"stage":"spill"},{"stage":"squeeze"}])");
  const auto commands = t.config.chain[0].stage.plan_commands(stripe(t.config.basics), t.config.basics);
  try {
    apply_chain(t.config, t.config.basics, t.operators(), commands, JitterField{}, {}, t.context);
    FAIL() << "lost 1 % of the mass and nobody noticed";
  } catch (const WorkError& e) {
    EXPECT_NE(std::string(e.what()).find("spill"), std::string::npos) << e.what();
  }
}

TEST(RunChain, MassBookLimits) {
  EXPECT_NO_THROW(check_mass_book("s", 1, 1 + 0.9e-6));
  EXPECT_THROW(check_mass_book("s", 1, 1 + 1.1e-6), WorkError);
  EXPECT_THROW(check_mass_book("s", 1, std::nan("")), WorkError);
  EXPECT_NO_THROW(check_mass_book("s", 0, 0));
}

TEST(RunChain, StopIsHeard) {
  Bench t;
  const auto commands = t.config.chain[0].stage.plan_commands(stripe(t.config.basics), t.config.basics);
  const auto operators = t.operators();
  t.stop = true;
  EXPECT_THROW(apply_chain(t.config, t.config.basics, operators, commands, JitterField{}, {}, t.context), Interrupted);
}

TEST(RunChain, LogLine) {
  EXPECT_EQ(stage_border_line({"press", 1.204, 1.204, 1.82, {}}), "press               1.82 s  mass in 1.2040 kg  out 1.2040 kg");
}

TEST(Operators, SecondTimeComesFromTheStore) {
  Bench t;
  const auto first = obtain_operator(t.config, t.config.chain[0], t.context), second = obtain_operator(t.config, t.config.chain[0], t.context);
  EXPECT_FALSE(first.cached);
  EXPECT_TRUE(second.cached);
  EXPECT_EQ(first.op.weight, second.op.weight);
  EXPECT_EQ(first.op.figures, second.op.figures);
}

TEST(Operators, TwoAtTheSameTimeMakeItOnce) {
  Bench t;
  auto stage = t.config.chain[0];
  std::atomic<int> made{0};
  std::atomic<bool> inside{false}, go{false};
  const auto make = stage.stage.characterise;
  stage.stage.characterise = [&](const LineBasics& b, const std::filesystem::path& folder, Context& context) {
    ++made, inside = true;
    while (!go) std::this_thread::yield();
    return make(b, folder, context);
  };
  StageOperator first, second;
  std::thread one([&] { first = obtain_operator(t.config, stage, t.context); });
  while (!inside) std::this_thread::yield();
  std::thread two([&] { second = obtain_operator(t.config, stage, t.context); });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // long enough to get past a missing lock
  EXPECT_EQ(made, 1);
  go = true;
  one.join(), two.join();
  EXPECT_EQ(made, 1);
  EXPECT_FALSE(first.cached);
  EXPECT_TRUE(second.cached);
  EXPECT_EQ(first.op.weight, second.op.weight);
}
TEST(Operators, WaitingForAnotherProcessCanBeStopped) {
  Bench t;
  auto stage = t.config.chain[0];
  std::atomic<bool> inside{false}, go{false};
  const auto make = stage.stage.characterise;
  stage.stage.characterise = [&](const LineBasics& b, const std::filesystem::path& folder, Context& context) {
    inside = true;
    while (!go) std::this_thread::yield();
    return make(b, folder, context);
  };
  std::thread one([&] { obtain_operator(t.config, stage, t.context); });
  while (!inside) std::this_thread::yield();
  t.stop = true;
  EXPECT_THROW(obtain_operator(t.config, stage, t.context), Interrupted);
  go = true;
  one.join();
}

TEST(Operators, AnotherStageConfigIsAnotherOperator) {
  Bench a, b(R"([{"stage":"dose","speed_m_s":2},{"stage":"squeeze"}])");
  EXPECT_NE(operator_key(a.config, a.config.chain[0]), operator_key(b.config, b.config.chain[0]));
  EXPECT_EQ(operator_key(a.config, a.config.chain[1]), operator_key(b.config, b.config.chain[1]));
}

TEST(Operators, RaisedCodeVersionIsAnotherOperator) {
  Bench t;
  const auto before = operator_key(t.config, t.config.chain[0]);
  t.stages[0].code_version = "2";
  EXPECT_NE(operator_key(t.config, t.config.chain[0]), before);
}
}  // namespace
}  // namespace venato::line
