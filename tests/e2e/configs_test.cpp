/// Every line config that we ship must validate, as it is and after being written out resolved.
#include "tests/e2e/program.h"
namespace venato::e2e {
namespace {

TEST(Configs, EveryLineConfigValidates) {
  TempFolder t;
  int seen = 0;
  for (const auto& entry : fs::directory_iterator(VENATO_SOURCE_DIR "/configs")) {
    if (entry.path().extension() != ".json") continue;
    ++seen;
    const auto ran = run_venato(t, "validate '" + entry.path().string() + "' --threads 2");
    EXPECT_EQ(ran.code, 0) << entry.path() << "\n" << ran.err;
    EXPECT_NE(ran.out.find("simulation to do: about"), std::string::npos) << ran.out;
  }
  EXPECT_GE(seen, 2);
}

TEST(Configs, ReferenceAndSchemaKnowEveryKeyOfTheDemo) {
  TempFolder t;
  const auto text = run_venato(t, "describe-config").out;
  const auto schema = nlohmann::json::parse(run_venato(t, "describe-config --schema").out, nullptr, false);
  ASSERT_FALSE(schema.is_discarded());
  EXPECT_EQ(schema.value("$schema", ""), "https://json-schema.org/draft/2020-12/schema");
  const auto config = demo_config();
  for (const auto& [key, value] : config.items()) {
    EXPECT_NE(text.find("/" + key), std::string::npos) << key;
    EXPECT_TRUE(schema.at("properties").contains(key)) << key;
  }
}

TEST(Configs, EveryVerbHasHelpWithAnExample) {
  TempFolder t;
  for (const char* verb : {"run", "validate", "describe-config", "dem", "sync", "masks", "report"}) {
    const auto ran = run_venato(t, std::string(verb) + " --help");
    EXPECT_EQ(ran.code, 0) << verb;
    EXPECT_NE(ran.out.find("Example"), std::string::npos) << verb;
  }
  EXPECT_EQ(run_venato(t, "--version").out.rfind("venato 0.", 0), 0u);
}
}  // namespace
}  // namespace venato::e2e
