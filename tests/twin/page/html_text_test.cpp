#include "twin/page/html_text.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {
namespace {

std::string base64_of(std::string_view text) {
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  return base64(bytes);
}

TEST(HtmlText, LeavesNothingThatCouldBeAnElement) {
  EXPECT_EQ(html_text("<b a=\"1\">&</b>"), "&lt;b a=&quot;1&quot;&gt;&amp;&lt;/b&gt;");
  EXPECT_EQ(html_text("G1 X1\tY2\n"), "G1 X1\tY2\n");
  EXPECT_EQ(html_text(std::string_view("\0\x1b[1m", 5)), "\xef\xbf\xbd\xef\xbf\xbd[1m");
}

TEST(HtmlText, MakesUtf8OfWhateverComes) {
  EXPECT_EQ(valid_utf8("Fr\xc3\xa4ser \xe2\x82\xac \xf0\x9f\x94\xa7"),
            "Fr\xc3\xa4ser \xe2\x82\xac \xf0\x9f\x94\xa7");
  EXPECT_EQ(valid_utf8("Fr\xe4ser"), "Fr\xef\xbf\xbdser");            // Latin-1
  EXPECT_EQ(valid_utf8("\xc0\xaf"), "\xef\xbf\xbd\xef\xbf\xbd");      // too long a form
  EXPECT_EQ(valid_utf8("\xed\xa0\x80").substr(0, 3), "\xef\xbf\xbd");  // a surrogate
  EXPECT_EQ(valid_utf8("a\xe2\x82"), "a\xef\xbf\xbd\xef\xbf\xbd");    // its end is missing
}

// RFC 4648, chapter 10.
TEST(Base64, IsThatOfTheStandard) {
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64_of("\xff\xfe\xfd"), "//79");
}

}  // namespace
}  // namespace kerf
