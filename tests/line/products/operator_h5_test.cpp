#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "base/error.h"
#include "tests/line/products/random_operator.h"

using namespace venato;
using namespace venato::line;

class OperatorFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("venato_operator_test_" + std::to_string(getpid()));
};

TEST_F(OperatorFile, RoundTripKeepsEveryBit) {
  Operator op = random_operator(3, 4, 5, 0.0123, 1.7e-3, 41);
  op.reference_delay_s = 1.0 / 3;
  op.replicates = {op.weight, random_operator(3, 4, 5, 0.0123, 1.7e-3, 42).weight};
  op.replicate_reference_delay_s = {0.1, 0.2};
  op.figures = {{"latency_on_s", 0.012}, {"sinkhorn_correction", 0.01}};
  op.curves = {{"step_response", {{"time_s", {0, 1, 2}}, {"mass_flow_kg_s", {0, 0.5, 0.75}}}}};
  op.warnings = {"too few tracers", "cg 4"};
  op.provenance_json = R"({"seed":1})";
  write_operator(folder / "op.h5", op);
  const Operator back = read_operator(folder / "op.h5");
  EXPECT_EQ(back.stage, op.stage);
  EXPECT_EQ(back.full_bed, op.full_bed);
  EXPECT_EQ(back.weight, op.weight);
  EXPECT_EQ(back.replicates, op.replicates);
  EXPECT_EQ(back.replicate_reference_delay_s, op.replicate_reference_delay_s);
  EXPECT_EQ(back.figures, op.figures);
  EXPECT_EQ(back.curves, op.curves);
  EXPECT_EQ(back.warnings, op.warnings);
  EXPECT_EQ(back.provenance_json, op.provenance_json);
  for (auto member : {&Operator::theta0_s, &Operator::dtheta_s, &Operator::eta0_m, &Operator::deta_m, &Operator::reference_delay_s})
    EXPECT_EQ(back.*member, op.*member);
  for (auto member : {&Operator::nz_in, &Operator::nz_out, &Operator::n_theta, &Operator::n_eta}) EXPECT_EQ(back.*member, op.*member);
}

TEST_F(OperatorFile, MinimalOperatorAndWrongFiles) {
  write_operator(folder / "id.h5", identity_operator(2));
  EXPECT_EQ(read_operator(folder / "id.h5").weight, identity_operator(2).weight);
  EXPECT_THROW(read_operator(folder / "missing.h5"), std::runtime_error);
  std::ofstream(folder / "text.h5") << "no HDF5 file";
  EXPECT_THROW(read_operator(folder / "text.h5"), WorkError);
}
