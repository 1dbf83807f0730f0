#include "ros/text.h"

#include <gtest/gtest.h>

namespace self_awareness::ros1 {
namespace {

TEST(Text, TellsUtf8FromOtherBytes) {
  for (const char* text : {"", "/scan", "\xC3\xA4", "\xE2\x82\xAC", "\xF0\x9F\x98\x80",
                           "\xED\x9F\xBF", "\xF4\x8F\xBF\xBF"}) {
    EXPECT_TRUE(isPrintable(text)) << text;
  }
  // Latin-1, a cut character, overlong forms, a surrogate, above U+10FFFF.
  for (const char* text : {"\xE4", "\xC3", "\xE2\x82", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80",
                           "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\x80", "a\xFF"}) {
    EXPECT_FALSE(isPrintable(text));
  }
}

TEST(Text, TellsWhatReadsAsSomethingElse) {
  // U+202E (right to left), U+2066 (isolate), U+200F and U+061C (marks), U+2028 (line separator).
  for (const char* text : {"/a\xE2\x80\xAE", "\xE2\x81\xA6", "\xE2\x80\x8F", "\xD8\x9C",
                           "\xE2\x80\xA8", "a\x1B[2J", "a\nb", "\xC2\x9B"}) {
    EXPECT_FALSE(isPrintable(text)) << text;
  }
  // Hebrew and Arabic letters, quotation marks, and what lies beside them.
  for (const char* text :
       {"\xD7\xA9", "\xD8\xA9", "\xE2\x80\x9C", "\xE2\x80\xAF", "\xE2\x81\xA4", "\xE2\x81\xAA"}) {
    EXPECT_TRUE(isPrintable(text)) << text;
  }
  EXPECT_EQ(printable("/a\xE2\x80\xAE"), "/a\xEF\xBF\xBD") << "it is replaced";
  EXPECT_EQ(printable("/gr\xFC\xDF"), "/gr\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(printable("a\x1B[2J\n\x7F"), "a\xEF\xBF\xBD[2J\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(printable("\xC2\x9B"), "\xEF\xBF\xBD");
  EXPECT_EQ(printable("gr\xC3\xBC\xC3\x9F dich"), "gr\xC3\xBC\xC3\x9F dich");
}

TEST(Text, CutsBetweenCharacters) {
  const std::string text = "a\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80";  // of 1, 2, 3 and 4 bytes
  EXPECT_EQ(printable(text, 0), "");
  EXPECT_EQ(printable(text, 1), "a");
  EXPECT_EQ(printable(text, 2), "a");
  EXPECT_EQ(printable(text, 3), "a\xC3\xA4");
  EXPECT_EQ(printable(text, 5), "a\xC3\xA4");
  EXPECT_EQ(printable(text, 6), "a\xC3\xA4\xE2\x82\xAC");
  EXPECT_EQ(printable(text, 9), "a\xC3\xA4\xE2\x82\xAC");
  EXPECT_EQ(printable(text, 10), text);
  EXPECT_EQ(printable("\xC3x", 1), "\xEF\xBF\xBD") << "it was broken before the cut";
  EXPECT_EQ(shortened("/laser", 6), "/laser");
  EXPECT_EQ(shortened("/laser2", 6), "/laser...") << "it says so";
  EXPECT_EQ(shortened("/\x1B", 6), "/\xEF\xBF\xBD");
}

}  // namespace
}  // namespace self_awareness::ros1
