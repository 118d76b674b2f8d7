// SPDX-License-Identifier: Apache-2.0
#include "core/film/film.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace petzval {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

FilmSample sample(float r, float g, float b, float alpha = 1.f) {
    FilmSample s;
    s.colour = Rgb(r, g, b);
    s.alpha = alpha;
    return s;
}

TEST(Film, AveragesColourAndAlpha) {
    Film film({8, 6}, {0, 0, 8, 6}, {});
    film.add(3, 2, 0, sample(1, 2, 3, 1));
    film.add(3, 2, 1, sample(3, 4, 8, 0));
    EXPECT_EQ(film.colour(3, 2), V4f(2, 3, 5.5f, 0.5f));
    EXPECT_EQ(film.sample_count(3, 2), 2u);
    EXPECT_EQ(film.colour(4, 2), V4f(0, 0, 0, 0));
    EXPECT_EQ(film.sample_count(4, 2), 0u);
}

TEST(Film, CropKeepsFullFrameCoordinates) {
    Film film({100, 50}, {90, 40, 100, 50}, {Aov::Depth});
    film.add(99, 49, 0, sample(1, 0, 0));
    film.add(90, 40, 0, sample(0, 1, 0));
    EXPECT_EQ(film.colour(99, 49), V4f(1, 0, 0, 1));
    EXPECT_EQ(film.colour(90, 40), V4f(0, 1, 0, 1));
    EXPECT_EQ(film.full_size(), V2i(100, 50));
    EXPECT_EQ(film.crop(), (Rect{90, 40, 100, 50}));
}

TEST(Film, LayersAverageOverHitsOnly) {
    Film film({2, 2}, {0, 0, 2, 2}, {Aov::Depth, Aov::Normal});
    FilmSample hit = sample(1, 1, 1);
    hit.hit = true;
    hit.aov[static_cast<size_t>(Aov::Depth)] = V3f(4, 0, 0);
    hit.aov[static_cast<size_t>(Aov::Normal)] = V3f(0, 1, 0);
    film.add(1, 0, 0, hit);
    film.add(1, 0, 1, sample(1, 1, 1, 0));
    hit.aov[static_cast<size_t>(Aov::Depth)] = V3f(6, 0, 0);
    film.add(1, 0, 2, hit);
    EXPECT_EQ(film.aov(1, 0, 0).x, 5.f);
    EXPECT_EQ(film.aov(1, 0, 1), V3f(0, 1, 0));
    EXPECT_EQ(film.aov(0, 0, 0), V3f(0, 0, 0));
    EXPECT_EQ(film.sample_count(1, 0), 3u);
}

TEST(Film, WhatIsNotFiniteIsCountedAndLeftOut) {
    Film film({4, 4}, {0, 0, 4, 4}, {Aov::Position});
    EXPECT_EQ(film.left_out().count(), 0u);
    film.add(2, 3, 7, sample(kNan, 0, 0));
    film.add(1, 2, 9, sample(0, 0, kInfinity));
    film.add(1, 2, 5, sample(0, 0, 0, -kInfinity));
    FilmSample bad_layer = sample(1, 1, 1);
    bad_layer.hit = true;
    bad_layer.aov[static_cast<size_t>(Aov::Position)].z = kNan;
    film.add(3, 3, 0, bad_layer);
    film.add(1, 2, 6, sample(2, 2, 2));
    EXPECT_EQ(film.left_out().not_finite, 4u);
    EXPECT_EQ(film.left_out().too_large, 0u);
    EXPECT_EQ(film.left_out().x, 1);
    EXPECT_EQ(film.left_out().y, 2);
    EXPECT_EQ(film.left_out().index, 5u);
    EXPECT_EQ(film.colour(1, 2), V4f(2, 2, 2, 1));
    EXPECT_EQ(film.sample_count(1, 2), 1u);
    EXPECT_EQ(film.sample_count(3, 3), 0u);
}

TEST(Film, WhatIsTooLargeIsCountedByItself) {
    Film film({2, 1}, {0, 0, 2, 1}, {Aov::Position});
    FilmSample far = sample(1, 1, 1);
    far.hit = true;
    far.aov[static_cast<size_t>(Aov::Position)] = V3f(-2e14f, 0, 0);
    film.add(0, 0, 4, far);
    film.add(0, 0, 3, sample(0, 1.5e14f, 0));
    film.add(0, 0, 5, sample(1e14f, 0, 0));
    far.colour = Rgb(kNan);
    film.add(1, 0, 1, far);  // both: it is not finite
    film.add(1, 0, 2, sample(3e38f, 0, kInfinity));
    const Film::LeftOut left_out = film.left_out();
    EXPECT_EQ(left_out.too_large, 2u);
    EXPECT_EQ(left_out.not_finite, 2u);
    EXPECT_EQ(left_out.x, 0);
    EXPECT_EQ(left_out.index, 3u);
    EXPECT_EQ(film.left_out(0, 0), 2u);
    EXPECT_EQ(film.taken_count(0, 0), 3u);
    EXPECT_EQ(film.colour(0, 0).x, 1e14f);
}

TEST(Film, UnaskedLayersMayHoldAnything) {
    Film film({1, 1}, {0, 0, 1, 1}, {Aov::Depth});
    FilmSample s = sample(1, 1, 1);
    s.hit = true;
    s.aov[static_cast<size_t>(Aov::Depth)] = V3f(1);
    s.aov[static_cast<size_t>(Aov::Position)] = V3f(kNan);
    film.add(0, 0, 0, s);
    EXPECT_EQ(film.left_out().count(), 0u);
    EXPECT_EQ(film.sample_count(0, 0), 1u);
}

TEST(Film, SmallSamplesAreNotLostInALargeSum) {
    Film film({1, 1}, {0, 0, 1, 1}, {});
    film.add(0, 0, 0, sample(1e8f, 0, 0));
    for (uint32_t i = 1; i < 1000; ++i) film.add(0, 0, i, sample(1, 0, 0));
    EXPECT_FLOAT_EQ(film.colour(0, 0).x, 100000.999f);
    EXPECT_NE(film.colour(0, 0).x, 1e8f / 1000);
}

TEST(Aov, NamesAndChannels) {
    std::set<std::string_view> channels;
    for (size_t i = 0; i < static_cast<size_t>(Aov::Count); ++i) {
        const Aov aov = static_cast<Aov>(i);
        const AovInfo& info = aov_info(aov);
        EXPECT_EQ(aov_from_name(info.name), aov);
        for (int c = 0; c < info.channel_count; ++c) {
            EXPECT_TRUE(info.channels[c].starts_with(info.name));
            EXPECT_TRUE(channels.insert(info.channels[c]).second);
        }
    }
    EXPECT_EQ(aov_info(Aov::Depth).channels[0], "depth.Z");
    EXPECT_EQ(aov_info(Aov::Uv).channel_count, 2);
    EXPECT_EQ(aov_info(Aov::Cost).channels[0], "cost.N");
    EXPECT_FALSE(aov_from_name("colour"));
}

}  // namespace
}  // namespace petzval
