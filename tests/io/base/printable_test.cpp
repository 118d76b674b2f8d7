// SPDX-License-Identifier: Apache-2.0
#include "io/base/printable.h"

#include <gtest/gtest.h>

namespace petzval::io {
namespace {

TEST(Printable, ShowsPlainTextAsItIs) {
    for (const char* text : {"", "lens 50mm f/1.2, \\ \"quoted\"", "Objektiv für 30 °C", "レンズ",
                             "نص عربي", "\xF0\x9F\x93\xB7", "\xE2\x9A\x99\xEF\xB8\x8F"})
        EXPECT_EQ(visible(text), text);
}

TEST(Printable, EscapesControls) {
    EXPECT_EQ(visible("a\nb\x1B[0m\x7F"), "a\\u000ab\\u001b[0m\\u007f");
    EXPECT_EQ(visible(std::string("\0", 1)), "\\u0000");
    EXPECT_EQ(visible("\u0080\u009b31m\u009f\u00a0"), "\\u0080\\u009b31m\\u009f\u00a0");
}

TEST(Printable, EscapesMarksOfDirection) {
    EXPECT_EQ(visible("\u061c\u200e\u200f"), "\\u061c\\u200e\\u200f");
    EXPECT_EQ(visible("\u202a\u202b\u202c\u202d\u202e"), "\\u202a\\u202b\\u202c\\u202d\\u202e");
    EXPECT_EQ(visible("\u2066\u2067\u2068\u2069"), "\\u2066\\u2067\\u2068\\u2069");
}

TEST(Printable, EscapesWhatHasNoWidth) {
    EXPECT_EQ(visible("a\u200bb\u200cc\u200dd\u2060e\ufeff"),
              "a\\u200bb\\u200cc\\u200dd\\u2060e\\ufeff");
    EXPECT_EQ(visible("\u00ad\u034f\u180e\u2028\u2029\u3164\ufff9"),
              "\\u00ad\\u034f\\u180e\\u2028\\u2029\\u3164\\ufff9");
    EXPECT_EQ(visible("\U000e0041\U0001d173"), "\\U000e0041\\U0001d173");
}

TEST(Printable, EscapesBytesThatAreNotUtf8) {
    EXPECT_EQ(visible("a\xFFz\x80"), "a\\xffz\\x80");
    EXPECT_EQ(visible("\xC0\xAF"), "\\xc0\\xaf");                    // overlong
    EXPECT_EQ(visible("\xE0\x80\xAF"), "\\xe0\\x80\\xaf");           // overlong
    EXPECT_EQ(visible("\xED\xA0\x80"), "\\xed\\xa0\\x80");           // a surrogate
    EXPECT_EQ(visible("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
    EXPECT_EQ(visible("x\xE2\x80"), "x\\xe2\\x80");                  // cut short
    EXPECT_EQ(visible("\xE2\x28\xA1"), "\\xe2(\\xa1");
}

TEST(Printable, CutsLongTextBetweenCharacters) {
    EXPECT_EQ(printable(std::string(100, 'x')), std::string(80, 'x') + "...");
    EXPECT_EQ(printable(std::string(80, 'x')), std::string(80, 'x'));
    EXPECT_EQ(printable(std::string(79, 'x') + "é!"), std::string(79, 'x') + "...");
    EXPECT_EQ(printable(std::string(78, 'x') + "\n"), std::string(78, 'x') + "...");
}

}  // namespace
}  // namespace petzval::io
