/// Wrong configs, pictures, folders and command lines: each must give its message and exit code and leave nothing behind. One row per mistake.
#include <functional>

#include "tests/e2e/program.h"
namespace venato::e2e {
namespace {
using Json = nlohmann::json;

struct Row {
  const char* name;
  int code;
  std::vector<std::string> says;                                  ///< fragments of stderr, all of them
  std::function<void(Json&)> change = nullptr;                    ///< of the demo config, written to @/c.json
  std::function<void(const TempFolder&, Json&)> setup = nullptr;  ///< files of the case; may change the config too
  std::string arguments = "run @/c.json -o @/out";
  std::function<std::string(const Json&)> text = nullptr;  ///< the config file's bytes, when it shall not be valid JSON
  std::string environment = {};
};
void PrintTo(const Row& row, std::ostream* os) { *os << row.name; }

std::function<void(Json&)> set(const char* pointer, Json value) {
  return [pointer = std::string(pointer), value](Json& c) { c[Json::json_pointer(pointer)] = value; };
}
std::function<void(Json&)> drop(const char* parent, const char* key) {
  return [parent = std::string(parent), key = std::string(key)](Json& c) { (parent.empty() ? c : c[Json::json_pointer(parent)]).erase(key); };
}
std::function<void(Json&)> chain(std::vector<const char*> stages) {
  return [stages](Json& c) {
    c["chain"] = Json::array();
    for (const char* s : stages) c["chain"].push_back({{"stage", s}});
  };
}
std::function<void(const TempFolder&, Json&)> picture(const char* file, std::function<std::string()> bytes) {
  return [file = std::string(file), bytes](const TempFolder& t, Json& c) {
    spill(t / file, bytes());
    c["design"]["image"] = (t / file).string();
  };
}
std::string start_of(const char* file, std::size_t n) { return slurp(std::string(VENATO_SOURCE_DIR "/configs/images/") + file).substr(0, n); }
/// A 4 x 4 grey TIFF whose directory points beyond the end of the file.
std::string truncated_tiff() { return std::string("II*\0\x08\0\0\0", 8) + std::string("\x09\0\x00\x01\x03\0\x01\0\0\0\x04\0\0\0", 14); }
std::string png_header_only() { return std::string("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\x03\xe8\0\0\x03\xe8\x08\x02\0\0\0", 29); }

const std::vector<Row> kRows{
    {"misspelt key",
     2,
     {"/belt_sped_m_s", "did you mean 'belt_speed_m_s'"},
     [](Json& c) { c["belt_sped_m_s"] = c["belt_speed_m_s"], c.erase("belt_speed_m_s"); }},
    {"missing key", 2, {"/belt_speed_m_s", "missing"}, drop("", "belt_speed_m_s")},
    {"missing nested key", 2, {"/powders/0/lower_cut_um", "missing"}, drop("/powders/0", "lower_cut_um")},
    {"missing seed", 2, {"/seed", "missing"}, drop("", "seed")},
    {"negative seed", 2, {"/seed"}, set("/seed", -3)},
    {"number in quotes", 2, {"/belt_speed_m_s", "must be a number"}, set("/belt_speed_m_s", "0.1")},
    {"unit in the value", 2, {"/slab/fired_width_mm", "must be a number"}, set("/slab/fired_width_mm", "600 mm")},
    {"wrong unit in the key",
     2,
     {"/slab/fired_width_m", "did you mean 'fired_width_mm'"},
     [](Json& c) { c["slab"]["fired_width_m"] = 0.6, c["slab"].erase("fired_width_mm"); }},
    {"negative size", 2, {"/slab/fired_width_mm", "-600", "50", "mm"}, set("/slab/fired_width_mm", -600)},
    {"zero thickness", 2, {"/slab/fired_thickness_mm", "3"}, set("/slab/fired_thickness_mm", 0)},
    {"metres given as millimetres", 2, {"/slab/fired_length_mm", "1.2"}, set("/slab/fired_length_mm", 1.2)},
    {"fractional integer", 2, {"/grid/layers"}, set("/grid/layers", 10.5)},
    {"object instead of number", 2, {"/belt_speed_m_s", "must be a number"}, set("/belt_speed_m_s", Json::object())},
    {"list instead of object", 2, {"/slab"}, set("/slab", Json::array())},
    {"wrong enum", 2, {"/powders/1/role", "body", "vein"}, set("/powders/1/role", "veins")},
    {"two bodies", 2, {"/powders", "one powder with role body and one with role vein"}, set("/powders/1/role", "body")},
    {"one powder", 2, {"/powders"}, [](Json& c) { c["powders"].erase(1); }},
    {"two powders of one name", 2, {"two powders are called 'white'"}, set("/powders/1/name", "white")},
    {"name that is no file name", 2, {"/powders/1/name"}, set("/powders/1/name", "../grey")},
    {"different granule densities", 2, {"granule densities differ"}, set("/powders/1/granule_density_kg_m3", 1700)},
    {"cuts swapped", 2, {"/powders/0/upper_cut_um", "below the lower cut"}, set("/powders/0/upper_cut_um", 60)},
    {"bad colour", 2, {"/powders/0/colour", "#rrggbb"}, set("/powders/0/colour", "#12345")},
    {"two inks of one name", 2, {"two inks are called 'blue'"}, set("/graphic/inks/1/name", "blue")},
    {"too many inks",
     2,
     {"/graphic/inks", "15"},
     [](Json& c) {
       for (int k = 0; k < 10; ++k) c["graphic"]["inks"].push_back({{"name", "ink" + std::to_string(k)}, {"solid", "#101010"}});
     }},
    {"image and layers",
     2,
     {"/graphic", "both image and layers"},
     [](Json& c) {
       c["graphic"]["layers"] = {{{"image", c["graphic"]["image"]}}};
     }},
    {"neither image nor layers", 2, {"/graphic", "neither image nor layers"}, drop("/graphic", "image")},
    {"no layer that warps",
     2,
     {"no layer has warp = true"},
     [](Json& c) {
       c["graphic"]["layers"] = {{{"image", c["graphic"]["image"]}, {"warp", false}}}, c["graphic"].erase("image");
     }},
    {"resolution beyond print heads", 2, {"/graphic/print_dpi", "1200"}, set("/graphic/print_dpi", 36000)},
    {"pitch that does not divide the module", 2, {"/grid/pitch_mm", "whole number of columns"}, set("/grid/pitch_mm", 2)},
    {"prongs that do not fill the bed", 2, {"/chain/0", "whole number of prongs"}, set("/chain/0/prong_pitch_mm", 7)},
    {"polishing through the slab", 2, {"takes off the whole slab"}, set("/vein_map/polish_depth_mm", 12)},
    {"belt that stretches too much", 2, {"/belt_jitter/amplitude_mm"}, set("/belt_jitter", {{"amplitude_mm", 20}, {"correlation_mm", 100}})},
    {"cut beyond the strip", 2, {"/cut", "beyond its nominal outline"}, set("/cut", {{"offset_x_mm", 40}})},
    {"press beyond its rating", 2, {"/chain/3/peak_pressure_mpa", "450", "60", "press rating"}, set("/chain/3/peak_pressure_mpa", 450)},
    {"unknown stage", 2, {"/chain/0/stage", "piezo_discharge"}, set("/chain/0/stage", "piezo_discharg")},
    {"press first", 2, {"/chain/0/stage", "press needs a full bed", "starts with commands"}, chain({"press", "piezo_discharge"})},
    {"belt before the feeder",
     2,
     {"/chain/1/stage", "belt_transport needs a full bed", "powder_feeder"},
     chain({"piezo_discharge", "belt_transport", "powder_feeder", "press"})},
    {"no press", 2, {"/chain", "not a slab"}, chain({"piezo_discharge", "powder_feeder"})},
    {"press twice", 2, {"/chain/4/stage", "press needs a full bed"}, chain({"piezo_discharge", "powder_feeder", "belt_transport", "press", "press"})},
    {"empty chain", 2, {"/chain"}, set("/chain", Json::array())},
    {"other format", 2, {"/format", "venato-line"}, set("/format", "venato-dem")},
    {"other version", 2, {"/version"}, set("/version", 2)},

    {"missing picture", 2, {"/design/image", "nowhere.png"}, set("/design/image", "nowhere.png")},
    {"picture is a folder", 2, {"/design/image"}, set("/design/image", "/tmp")},
    {"empty PNG", 2, {"/design/image", "empty.png"}, nullptr, picture("empty.png", [] { return std::string(); })},
    {"PNG of which only the header is there", 2, {"/design/image", "cut.png"}, nullptr, picture("cut.png", png_header_only)},
    {"truncated JPEG", 2, {"/design/image", "cut.jpg"}, nullptr, picture("cut.jpg", [] { return start_of("pov_calacatta_1600x3200.jpg", 600); })},
    {"truncated TIFF", 2, {"/design/image", "cut.tif"}, nullptr, picture("cut.tif", truncated_tiff)},
    {"text called PNG",
     2,
     {"/design/image", "text.png"},
     nullptr,
     picture("text.png", [] { return std::string("not a picture at all, only words\n"); })},
    {"slab larger than the picture", 2, {"/design/image", "1600 mm x 3200 mm", "check pitch_mm"}, set("/design/origin_x_mm", 1200)},

    {"truncated config", 2, {"c.json", "line"}, nullptr, nullptr, "run @/c.json -o @/out", [](const Json& c) { return c.dump().substr(0, 200); }},
    {"empty config", 2, {"c.json"}, nullptr, nullptr, "run @/c.json -o @/out", [](const Json&) { return std::string(); }},
    {"NaN in the config",
     2,
     {"c.json", "line 1"},
     nullptr,
     nullptr,
     "run @/c.json -o @/out",
     [](const Json&) { return std::string(R"({"belt_speed_m_s": NaN})"); }},
    {"number too large for a double",
     2,
     {"c.json"},
     nullptr,
     nullptr,
     "run @/c.json -o @/out",
     [](const Json& c) {
       auto t = c.dump();
       return t.replace(t.find("\"belt_speed_m_s\":0.1"), 20, "\"belt_speed_m_s\":1e999");
     }},
    {"duplicate key", 2, {"seed"}, nullptr, nullptr, "run @/c.json -o @/out", [](const Json& c) { return "{\"seed\":1," + c.dump().substr(1); }},
    {"text that is not UTF-8",
     2,
     {"c.json"},
     nullptr,
     nullptr,
     "run @/c.json -o @/out",
     [](const Json& c) {
       auto t = c.dump();
       return t.replace(t.find("Demo"), 4, "\xff\xfe\xff\xfe");
     }},
    {"config nested too deep", 2, {"c.json"}, nullptr, nullptr, "run @/c.json -o @/out", [](const Json&) { return std::string(100000, '['); }},
    {"config is missing", 2, {"nope.json"}, nullptr, nullptr, "run @/nope.json -o @/out"},
    {"config is a folder", 2, {"venato: "}, nullptr, nullptr, "run @ -o @/out"},
    {"a DEM case given as a line", 2, {"/format"}, nullptr, nullptr, "run '" VENATO_SOURCE_DIR "/configs/dem/slot_hopper.json' -o @/out"},
    {"a line given as a DEM case", 2, {"/format"}, nullptr, nullptr, "dem @/c.json -o @/out"},
    {"missing DEM case", 2, {"nope.json"}, nullptr, nullptr, "dem @/nope.json -o @/out"},

    {"no command", 2, {"venato: "}, nullptr, nullptr, ""},
    {"unknown command", 2, {"venato: "}, nullptr, nullptr, "runn @/c.json -o @/out"},
    {"unknown option", 2, {"--treads"}, nullptr, nullptr, "run @/c.json -o @/out --treads 2"},
    {"no output folder", 2, {"--out"}, nullptr, nullptr, "run @/c.json"},
    {"no threads", 2, {"--threads"}, nullptr, nullptr, "run @/c.json -o @/out --threads 0"},
    {"--set without value", 2, {"/belt_speed_m_s"}, nullptr, nullptr, "run @/c.json -o @/out --set /belt_speed_m_s"},
    {"--set of an unknown key", 2, {"/belt_sped_m_s"}, nullptr, nullptr, "run @/c.json -o @/out --set /belt_sped_m_s=0.2"},
    {"--set beyond a limit", 2, {"/belt_speed_m_s", "20"}, nullptr, nullptr, "run @/c.json -o @/out --set /belt_speed_m_s=20"},

    {"OUT is a file", 2, {"out"}, nullptr, [](const TempFolder& t, Json&) { spill(t / "out", "mine"); }},
    {"OUT below a file", 2, {"file"}, nullptr, [](const TempFolder& t, Json&) { spill(t / "file", "mine"); }, "run @/c.json -o @/file/out"},
    {"store is a file",
     2,
     {"store"},
     nullptr,
     [](const TempFolder& t, Json&) { spill(t / "store", "mine"); },
     "validate @/c.json",
     nullptr,
     "VENATO_STORE=@/store"},
    {"full disk behind standard output", 1, {"standard output"}, nullptr, nullptr, "describe-config >/dev/full"},

    {"report of no run", 2, {"run.json"}, nullptr, nullptr, "report @"},
    {"report of a damaged run",
     2,
     {"run.json"},
     nullptr,
     [](const TempFolder& t, Json&) { spill(t / "run.json", "{\"format\": \"venato-run\""), spill(t / "score.json", "{}"); },
     "report @"},
    {"report of another version",
     2,
     {"run.json", "venato-run version 1"},
     nullptr,
     [](const TempFolder& t, Json&) { spill(t / "run.json", R"({"format":"venato-run","version":9})"); },
     "report @"},
    {"sync of a missing picture", 2, {"nope.png"}, nullptr, nullptr, "sync --vein-map @/nope.png --graphic @/nope.png -o @/out"},
    {"sync of an empty picture",
     2,
     {"empty.png"},
     nullptr,
     [](const TempFolder& t, Json&) { spill(t / "empty.png", ""); },
     "sync --vein-map @/empty.png --graphic @/empty.png --vein-pitch-mm 1 --graphic-pitch-mm 1 -o @/out"},
    {"sync of a truncated TIFF",
     2,
     {"cut.tif"},
     nullptr,
     [](const TempFolder& t, Json&) { spill(t / "cut.tif", truncated_tiff()); },
     "sync --vein-map @/cut.tif --graphic @/cut.tif --vein-pitch-mm 1 --graphic-pitch-mm 1 -o @/out"},
    {"sync with a negative pitch",
     2,
     {"--vein-pitch-mm"},
     nullptr,
     nullptr,
     "sync --vein-map @/c.json --graphic @/c.json --vein-pitch-mm -1 -o @/out"},
    {"sync without graphic", 2, {"--graphic"}, nullptr, nullptr, "sync --vein-map @/c.json -o @/out"},
};

class Hostile : public testing::TestWithParam<Row> {};

TEST_P(Hostile, IsRefused) {
  const Row& row = GetParam();
  TempFolder t;
  Json config = demo_config();
  if (row.change) row.change(config);
  if (row.setup) row.setup(t, config);
  spill(t / "c.json", row.text ? row.text(config) : config.dump(1));
  const int files = t.file_count();
  std::string environment = row.environment;
  if (const auto at = environment.find('@'); at != std::string::npos) environment.replace(at, 1, t.path().string());
  const auto ran = run_venato(t, row.arguments, environment);
  EXPECT_EQ(ran.code, row.code) << ran.err;
  EXPECT_EQ(ran.err.rfind("venato: ", 0), 0u) << ran.err;
  for (const auto& fragment : row.says) EXPECT_NE(ran.err.find(fragment), std::string::npos) << "missing '" << fragment << "' in:\n" << ran.err;
  EXPECT_EQ(t.file_count(), files) << "left something behind";
  if (!fs::is_regular_file(t / "out")) {
    EXPECT_FALSE(fs::exists(t / "out")) << "made OUT";
  }
}

INSTANTIATE_TEST_SUITE_P(Inputs, Hostile, testing::ValuesIn(kRows), [](const auto& row) {
  std::string name = row.param.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

TEST(HostileInputs, ThereAreAtLeastForty) { EXPECT_GE(kRows.size(), 40u); }
}  // namespace
}  // namespace venato::e2e
