// SPDX-License-Identifier: Apache-2.0
#include "core/light/light_choice.h"

#include "core/light/light_sampling.h"
#include "tests/support/chi_square.h"
#include "tests/support/lamp.h"

namespace petzval {
namespace {

using test::Random;

const LightReceiver kAnywhere{V3f(0.3f, -1, 0.5f), V3f(0, 1, 0), true};

// Half of it shines: a sky that is the same all around is no light to pick.
Sky half_sky() {
    return Sky::picture({0, 0, 0, 0.2f, 0.2f, 0.2f}, 2, 1, 0.f, 1.f);
}

Scene mixed_scene() {
    Scene scene = test::lamp_scene();
    scene.lights = {PointLight{V3f(0.f), Rgb(2.f)}, PointLight{V3f(0.f), Rgb(0.f)},
                    SunLight{V3f(0, -1, 0), Rgb(0.5f)}};
    scene.sky = half_sky();
    finish_scene(scene);
    return scene;
}

void expect_consistent(const Scene& scene, const LightChoice& choice,
                       const std::vector<double>& weights, uint32_t seed) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<double> observed(weights.size()), expected;
    for (uint32_t i = 0; i < scene.lights.size(); ++i) {
        EXPECT_NEAR(choice.probability(i, kAnywhere), weights[i] / sum, 1e-6) << i;
        expected.push_back(100000 * weights[i] / sum);
    }
    Random random(seed);
    for (int i = 0; i < 100000; ++i) {
        const auto pick = choice.pick(random.next(), kAnywhere);
        ASSERT_TRUE(pick);
        const float said = choice.probability(pick->light, kAnywhere);
        ASSERT_NEAR(pick->probability, said, 1e-6f * said);
        ++observed[pick->light];
    }
    EXPECT_TRUE(test::chi_square(observed, expected));
}

TEST(LightChoice, PowerWeighs) {
    const Scene scene = mixed_scene();
    std::vector<double> weights;
    for (const Light& light : scene.lights) weights.push_back(light_power(scene, light));
    expect_consistent(scene, LightChoice(scene, LightChoiceKind::Power), weights, 1);
}

TEST(LightChoice, UniformTreatsThoseWithPowerAlike) {
    const Scene scene = mixed_scene();
    expect_consistent(scene, LightChoice(scene, LightChoiceKind::Uniform), {1, 0, 1, 1, 1}, 2);
}

TEST(LightChoice, NothingToChoose) {
    Scene scene;
    EXPECT_FALSE(LightChoice(scene, LightChoiceKind::Power).pick(0.5f, kAnywhere));
    scene.lights = {PointLight{V3f(0.f), Rgb(0.f)}};
    const LightChoice choice(scene, LightChoiceKind::Uniform);
    EXPECT_FALSE(choice.pick(0.5f, kAnywhere));
    EXPECT_EQ(choice.probability(0, kAnywhere), 0.f);
}

TEST(LightChoice, AFaintLightBesideManyStrongOnesKeepsAChance) {
    Scene scene;
    for (int i = 0; i < 200000; ++i)
        scene.lights.push_back(PointLight{V3f(0.f), Rgb(i == 777 ? 1e-9f : 1e6f)});
    const LightChoice choice(scene, LightChoiceKind::Power);
    EXPECT_GT(choice.probability(777, kAnywhere), 0.f);
    double sum = 0;
    for (uint32_t i = 0; i < scene.lights.size(); ++i) sum += choice.probability(i, kAnywhere);
    EXPECT_NEAR(sum, 1, 1e-6);
}

// What stands somewhere is chosen by the tree, the rest by power, and a scene without any of the
// former is not charged for a tree.
TEST(LightChoice, TreeSharesWithSkyAndSun) {
    const Scene scene = mixed_scene();
    const LightChoice choice(scene, LightChoiceKind::Tree);
    std::vector<double> weights;
    for (uint32_t i = 0; i < scene.lights.size(); ++i)
        weights.push_back(choice.probability(i, kAnywhere));
    expect_consistent(scene, choice, weights, 3);
    for (const uint32_t i : {0u, 2u, 3u, 4u}) EXPECT_GT(weights[i], 0) << i;
    EXPECT_EQ(weights[1], 0);

    Scene open;
    open.lights = {SunLight{V3f(0, -1, 0), Rgb(0.5f)}};
    open.sky = half_sky();
    finish_scene(open);
    weights = {light_power(open, open.lights[0]), light_power(open, open.lights[1])};
    expect_consistent(open, LightChoice(open, LightChoiceKind::Tree), weights, 4);
}

TEST(LightChoice, KeepsStrata) {
    Scene scene;
    for (int i = 0; i < 8; ++i) scene.lights.push_back(PointLight{V3f(0.f), Rgb(1.f)});
    const LightChoice choice(scene, LightChoiceKind::Power);
    for (uint32_t i = 0; i < 8; ++i)
        EXPECT_EQ(choice.pick((static_cast<float>(i) + 0.5f) / 8, kAnywhere)->light, i);
}

}  // namespace
}  // namespace petzval
