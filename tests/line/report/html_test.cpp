#include "line/report/html.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
namespace venato::line {
namespace {
TEST(Html, Base64IsRfc4648) {  // section 10 of the RFC
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}
TEST(Html, EscapesWhatCouldBecomeMarkup) { EXPECT_EQ(html_escape("<b a=\"x\">&'"), "&lt;b a=&quot;x&quot;&gt;&amp;&#39;"); }
TEST(Html, DataUriByKind) {
  EXPECT_EQ(data_uri("a.svg", "foo"), "data:image/svg+xml;base64,Zm9v");
  EXPECT_THROW(data_uri("a.exe", "foo"), UsageError);
}
TEST(Html, NumbersForPeople) {
  EXPECT_EQ(pretty_number(0.0012, "m"), "1.2 mm");
  EXPECT_EQ(pretty_number(0.0000034, "m"), "3.4 µm");
  EXPECT_EQ(pretty_number(0.012, "s"), "12 ms");
  EXPECT_EQ(pretty_number(0.00075, "kg/s"), "0.75 g/s");
  EXPECT_EQ(pretty_number(39.2e6, "Pa"), "39.2 MPa");
  EXPECT_EQ(pretty_number(2053.4, "kg/m³"), "2053 kg/m³");
  EXPECT_EQ(pretty_number(0.25, ""), "0.25");
  EXPECT_EQ(pretty_number(std::numeric_limits<double>::quiet_NaN(), "m"), "–");
  EXPECT_EQ(pretty_number(0, "m"), "0 µm");
}
}  // namespace
}  // namespace venato::line
