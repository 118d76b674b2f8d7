// SPDX-License-Identifier: Apache-2.0
#include "core/light/light_shares.h"

#include "core/light/light_choice.h"
#include "tests/support/chi_square.h"
#include "tests/support/lamp.h"

namespace petzval {
namespace {

using test::Random;

// Records at random places of a unit cube; where x < 0.5 the lights outside bring nothing,
// elsewhere as much as is expected. Those inside bring half of it everywhere.
std::vector<LightRecord> half_shaded(int count) {
    std::vector<LightRecord> records;
    Random random(1);
    for (int i = 0; i < count; ++i) {
        const V3f p(random.next(), random.next(), random.next());
        const bool outside = random.next() < 0.5f;
        const float expected = 1.f + random.next();
        const float seen = !outside ? 0.5f : p.x < 0.5f ? 0.f : 1.f;
        records.push_back(
            {p, outside ? LightGroup::Outside : LightGroup::Inside, expected, expected * seen});
    }
    return records;
}

TEST(LightShares, FactorsFollowWhatWasFound) {
    const LightShares shares(half_shaded(8192));
    EXPECT_EQ(shares.levels(), 6);
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const V3f p(random.next(), random.next(), random.next());
        if (p.x > 0.2f && p.x < 0.55f) continue;  // its leaf may reach across the middle
        const float factor = shares.factor(p);
        if (p.x < 0.5f)
            EXPECT_LT(factor, 0.4f) << p;  // a little of what is true on average remains
        else
            EXPECT_NEAR(factor, 2.f, 0.3f) << p;
    }
}

TEST(LightShares, FewRecordsMakeOneLeafAndNoneMakesNone) {
    EXPECT_EQ(LightShares().factor(V3f(3.f)), 1.f);
    EXPECT_EQ(LightShares(std::span<const LightRecord>()).factor(V3f(3.f)), 1.f);
    const LightShares one(half_shaded(200));
    EXPECT_EQ(one.levels(), 0);
    EXPECT_EQ(one.factor(V3f(0.f)), one.factor(V3f(1.f)));
}

// Groups that nothing is known of, or that brought nothing, leave a number that can be used.
TEST(LightShares, OddRecords) {
    std::vector<LightRecord> records;
    for (int i = 0; i < 300; ++i) records.push_back({V3f(0.f), LightGroup::Inside, 1.f, 1.f});
    EXPECT_GT(LightShares(records).factor(V3f(0.f)), 0.f);
    for (LightRecord& r : records) r.group = LightGroup::Outside;
    EXPECT_GT(LightShares(records).factor(V3f(0.f)), 1.f);
    // The film leaves out what is no number; so does what is learned.
    const float factor = LightShares(records).factor(V3f(0.f));
    for (const float odd : {kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
        records.push_back({V3f(0.f), LightGroup::Inside, 1.f, odd});
        EXPECT_EQ(LightShares(records).factor(V3f(0.f)), factor);
        records.pop_back();
    }
    for (LightRecord& r : records) r.found = 0;
    EXPECT_GT(LightShares(records).factor(V3f(0.f)), 0.f);
    EXPECT_LT(LightShares(records).factor(V3f(0.f)), kInfinity);
}

Scene lamp_and_sun() {
    Scene scene = test::lamp_scene();
    scene.lights = {PointLight{V3f(0.f), Rgb(2.f)}, SunLight{V3f(0, -1, 0), Rgb(0.5f)}};
    finish_scene(scene);
    return scene;
}

const LightReceiver kBelow{V3f(0.3f, -1, 0.5f), V3f(0, 1, 0), false};

TEST(LightShares, APilotPicksBothGroupsEqually) {
    const Scene scene = lamp_and_sun();
    const LightChoice choice(scene, LightChoiceKind::Tree);
    ASSERT_TRUE(choice.divides());
    EXPECT_NEAR(choice.for_pilot().probability(1, kBelow), 0.5f, 1e-6f);
    Scene sun;
    sun.lights = {SunLight{V3f(0, -1, 0), Rgb(0.5f)}};
    finish_scene(sun);
    EXPECT_FALSE(LightChoice(sun, LightChoiceKind::Tree).divides());
    EXPECT_FALSE(LightChoice(scene, LightChoiceKind::Power).divides());
}

// What a pilot fitted stays within bounds, and picks agree with probabilities.
TEST(LightShares, NoGroupIsEverGivenUp) {
    const Scene scene = lamp_and_sun();
    const LightChoice choice(scene, LightChoiceKind::Tree), even = choice.for_pilot();
    for (const float sun_seen : {0.f, 1.f, 1e6f}) {
        std::vector<LightRecord> records;
        for (int i = 0; i < 500; ++i)
            for (const uint32_t light : {0u, 1u})
                records.push_back(even.record(light, kBelow, light == 1 ? sun_seen : 1.f));
        const LightChoice fitted = choice.fitted(records);
        const float sun = fitted.probability(1, kBelow);
        EXPECT_GE(sun, 0.0499f);
        EXPECT_LE(sun, 0.9501f);
        if (sun_seen == 0.f) {
            EXPECT_LT(sun, 0.051f);
        }
        if (sun_seen == 1e6f) {
            EXPECT_GT(sun, 0.949f);
        }
        // The same light by either way: shares in proportion to the root mean squares.
        if (sun_seen == 1.f) {
            EXPECT_NEAR(sun, 0.5f, 1e-3f);
        }
        double all = 0;
        for (uint32_t i = 0; i < scene.lights.size(); ++i) all += fitted.probability(i, kBelow);
        EXPECT_NEAR(all, 1, 1e-6);
        Random random(3);
        int suns = 0;
        for (int i = 0; i < 10000; ++i) {
            const auto pick = fitted.pick(random.next(), kBelow);
            ASSERT_TRUE(pick);
            const float said = fitted.probability(pick->light, kBelow);
            ASSERT_NEAR(pick->probability, said, 1e-5f * said);
            suns += pick->light == 1;
        }
        EXPECT_NEAR(suns, 10000 * sun, 5 * std::sqrt(10000 * sun * (1 - sun)));
    }
}

// The sun beside a candle: without a pilot, and with one that found it shaded.
TEST(LightShares, LightsOfVeryUnequalPower) {
    for (const float candle : {1e-2f, 1e-6f, 1e6f}) {
        Scene scene = test::lamp_scene();
        scene.lights = {PointLight{V3f(0.f), Rgb(candle)}, SunLight{V3f(0, -1, 0), Rgb(1e5f)}};
        finish_scene(scene);
        const LightChoice choice(scene, LightChoiceKind::Tree), even = choice.for_pilot();
        std::vector<LightRecord> records;
        for (int i = 0; i < 500; ++i)
            for (const uint32_t light : {0u, 1u})
                records.push_back(even.record(light, kBelow, light == 1 ? 0.f : candle));
        for (const LightChoice& one : {choice, even, choice.fitted(records)}) {
            double all = 0;
            for (uint32_t i = 0; i < scene.lights.size(); ++i) {
                const float p = one.probability(i, kBelow);
                EXPECT_TRUE(std::isfinite(p));
                all += p;
            }
            EXPECT_NEAR(all, 1, 1e-6);
            for (const float u : {0.f, 0.03f, 0.5f, kOneMinus}) {
                const auto pick = one.pick(u, kBelow);
                ASSERT_TRUE(pick);
                EXPECT_GT(pick->probability, 0.f);
                EXPECT_NEAR(pick->probability, one.probability(pick->light, kBelow),
                            1e-5f * pick->probability);
            }
        }
        EXPECT_NEAR(choice.fitted(records).probability(1, kBelow), 0.05f, 1e-3f);
    }
}

}  // namespace
}  // namespace petzval
