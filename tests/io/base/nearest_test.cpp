// SPDX-License-Identifier: Apache-2.0
#include "io/base/nearest.h"

#include <gmock/gmock.h>

namespace petzval::io {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Nearest, CountsSlipsOfTheFingers) {
    EXPECT_EQ(edit_distance("render", "render"), 0u);
    EXPECT_EQ(edit_distance("render", "rende"), 1u);
    EXPECT_EQ(edit_distance("redner", "render"), 1u) << "neighbours exchanged";
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
    EXPECT_EQ(edit_distance("", "abc"), 3u);
}

TEST(Nearest, SlipsComeBeforePartsAndPartsAtTheBeginningFirst) {
    const std::vector<std::string> known{"--focus", "--focus-by", "--focal-length", "--fov"};
    EXPECT_THAT(words_near("--fokus", known), ElementsAre("--focus"));
    EXPECT_THAT(words_near("--FOCUS", known), ElementsAre("--focus", "--focus-by"));
    EXPECT_THAT(words_near("--focus-distance", known), ElementsAre("--focus"));
    EXPECT_THAT(words_near("takumar", {"pen-50mm", "smc-takumar", "takumar-50mm"}),
                ElementsAre("takumar-50mm", "smc-takumar"));
}

TEST(Nearest, SaysNothingWhereNothingIsNear) {
    EXPECT_THAT(words_near("summicron", {"tessar-100mm-f2.8", "biotar-58mm-f1.4"}), IsEmpty());
    EXPECT_THAT(words_near("", {"a", "render"}), IsEmpty());
    EXPECT_EQ(did_you_mean("xyzzy", {"render", "plan"}), "");
    EXPECT_EQ(did_you_mean("rendr", {"render", "plan"}), "; did you mean render?");
    EXPECT_EQ(did_you_mean_or("there are", "xyzzy", {"render", "plan"}),
              "; there are render, plan");
    EXPECT_THAT(words_near(std::string(1 << 20, 'x'), {"render"}), IsEmpty());
}

}  // namespace
}  // namespace petzval::io
