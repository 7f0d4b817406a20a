#include "io/write/html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Html, EscapesWhatTagsAndQuotesAreMadeOf) {
  EXPECT_EQ(EscapeHtml("</script><b a=\"1\" b='2'>&"),
            "&lt;/script&gt;&lt;b a=&quot;1&quot; b=&#39;2&#39;&gt;&amp;");
  EXPECT_EQ(EscapeHtml("\xC3\xBC\n\t"), "\xC3\xBC\n\t");
  EXPECT_EQ(EscapeHtml(std::string("a\0b\x1b", 4)),
            "a\xEF\xBF\xBD"
            "b\xEF\xBF\xBD");
}

TEST(Html, NoNameEndsAScript) {
  const nlohmann::ordered_json json = {{"</script><b>", "<!--<script>"},
                                       {"bytes", "\xff"}};
  const std::string text = ScriptJson(json);
  EXPECT_THAT(text, Not(HasSubstr("<")));
  const nlohmann::json back = nlohmann::json::parse(text);
  EXPECT_EQ(back.at("</script><b>"), "<!--<script>");
  EXPECT_EQ(back.at("bytes"), "\xEF\xBF\xBD");
}

}  // namespace
}  // namespace hindsight
