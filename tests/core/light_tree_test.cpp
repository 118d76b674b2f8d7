// SPDX-License-Identifier: Apache-2.0
#include "core/light/light_tree.h"

#include <algorithm>
#include <numbers>
#include <set>

#include "core/light/light_choice.h"
#include "core/light/light_sampling.h"
#include "tests/support/chi_square.h"
#include "tests/support/lamp.h"

namespace petzval {
namespace {

using test::Moments;
using test::Random;

constexpr float kScales[] = {1e-4f, 1.f, 1e6f};

// Clusters of small triangles that face alike, as on a lamp, of both kinds, among them point and
// spot lights: within a cube of half-width `scale` metres.
Scene random_scene(uint32_t seed, int clusters, float scale) {
    Random random(seed);
    const auto anywhere = [&] {
        return V3f(2 * random.next() - 1, 2 * random.next() - 1, 2 * random.next() - 1) * scale;
    };
    Scene scene;
    for (const bool two_sided : {false, true})
        scene.materials.push_back(test::glowing(Rgb(1.f + 9 * random.next()), two_sided));
    for (int i = 0; i < clusters; ++i) {
        const V3f at = anywhere(), facing = random.direction();
        const Frame frame = Frame::about(facing);
        const float size = scale * std::pow(10.f, -2 * random.next()) / 10;
        for (int k = 0; k < 12; ++k) {
            const auto corner = [&] {
                const V2f u = random.next2();
                return at + (frame.x * u.x + frame.y * u.y + random.direction() * 0.1f) * size;
            };
            const V3f a = corner(), b = corner(), c = corner();
            scene.meshes.push_back(test::one_triangle(a, b, c, i % 2));
            M44f mirror;
            mirror.setScale(V3f(-1, 1, 1));
            scene.instances.push_back(k % 3 == 0 ? test::placed(0, mirror) : Instance());
            scene.instances.back().mesh = static_cast<uint32_t>(scene.meshes.size() - 1);
        }
        const float candela = scale * scale * random.next();
        scene.lights.push_back(PointLight{anywhere(), Rgb(candela)});
        const float outer = 0.02f + 1.5f * random.next();
        scene.lights.push_back(SpotLight{anywhere(), random.direction(), Rgb(candela),
                                         std::cos(outer * random.next()), std::cos(outer)});
    }
    finish_scene(scene);
    return scene;
}

// Among the lights, far from them, on one of them, and at a corner of one.
std::vector<LightReceiver> receivers(const Scene& scene, uint32_t seed, float scale) {
    Random random(seed);
    std::vector<LightReceiver> all;
    const auto add = [&](V3f p) { all.push_back({p, random.direction(), all.size() % 3 == 0}); };
    for (int i = 0; i < 12; ++i)
        add(V3f(random.next() - 0.5f, random.next() - 0.5f, random.next() - 0.5f) * 2 * scale);
    for (const float far : {10.f, 1000.f}) add(random.direction() * far * scale);
    const auto corner = triangle_corners(scene, 5, 0);
    add((corner[0] + corner[1] + corner[2]) / 3);
    add(corner[0]);
    add(std::get<PointLight>(scene.lights[0]).position);
    return all;
}

double sum_of_probabilities(const Scene& scene, const LightChoice& choice,
                            const LightReceiver& receiver) {
    double sum = 0;
    for (uint32_t i = 0; i < scene.lights.size(); ++i) {
        const float p = choice.probability(i, receiver);
        EXPECT_TRUE(p >= 0 && p <= 1) << p;
        sum += p;
    }
    return sum;
}

// What is drawn is what is said to be drawn; what is left is drawn where a cluster might have
// reached the receiver and none of its lights does.
TEST(LightTree, PicksAgreeWithProbabilities) {
    for (const float scale : kScales) {
        const Scene scene = random_scene(1, 12, scale);
        const LightChoice choice(scene, LightChoiceKind::Tree);
        uint32_t seed = 2;
        for (const LightReceiver& receiver : receivers(scene, 3, scale)) {
            constexpr int draws = 40000;
            std::vector<double> observed(scene.lights.size() + 1), expected;
            double left = 1;
            for (uint32_t i = 0; i < scene.lights.size(); ++i) {
                const double p = choice.probability(i, receiver);
                expected.push_back(draws * p);
                left -= p;
            }
            ASSERT_GT(left, -1e-5);
            Random random(++seed);
            for (int i = 0; i < draws; ++i) {
                const auto pick = choice.pick(random.next(), receiver);
                ++observed[pick ? pick->light : scene.lights.size()];
                if (!pick) continue;
                const float said = choice.probability(pick->light, receiver);
                ASSERT_NEAR(pick->probability, said, 1e-5f * said);
            }
            expected.push_back(left > 1e-5 || observed.back() > 0 ? draws * std::max(left, 0.) : 0);
            const bool one = *std::max_element(expected.begin(), expected.end()) > draws - 5.;
            if (one) continue;  // on a point light nothing else counts
            EXPECT_TRUE(test::chi_square(observed, expected)) << scale << ' ' << seed;
        }
    }
}

// Every light that a draw can find has a probability.
TEST(LightTree, LightsThatContributeAreNeverImpossible) {
    int contributing = 0, impossible = 0;
    for (const float scale : kScales) {
        for (uint32_t seed = 10; seed < 20; ++seed) {
            const Scene scene = random_scene(seed, 6, scale);
            const LightChoice choice(scene, LightChoiceKind::Tree);
            Random random(seed);
            for (const LightReceiver& receiver : receivers(scene, seed, scale))
                for (uint32_t i = 0; i < scene.lights.size(); ++i) {
                    const bool possible = choice.probability(i, receiver) > 0;
                    impossible += !possible;
                    for (int k = 0; k < 16; ++k) {
                        const auto drawn = sample_light(scene, scene.lights[i], receiver.p,
                                                        random.next2(), Bands::rgb());
                        if (!drawn) continue;
                        const float cosine = drawn->direction.dot(receiver.normal);
                        if (!receiver.both_sides && cosine <= 0) continue;
                        ++contributing;
                        ASSERT_TRUE(possible) << scale << ' ' << seed << ' ' << i;
                    }
                }
        }
    }
    EXPECT_GT(contributing, 100000);
    EXPECT_GT(impossible, 10000);  // or the bounds say nothing
}

// Irradiance without shadows, from a light chosen one way or another.
Moments irradiance(const Scene& scene, const LightChoice& choice, const LightReceiver& receiver,
                   int draws, uint32_t seed) {
    Random random(seed);
    Moments moments;
    for (int i = 0; i < draws; ++i) {
        const auto pick = choice.pick(random.next(), receiver);
        const V2f u = random.next2();
        std::optional<LightSample> drawn;
        if (pick)
            drawn = sample_light(scene, scene.lights[pick->light], receiver.p, u, Bands::rgb());
        float cosine = drawn ? drawn->direction.dot(receiver.normal) : 0.f;
        if (receiver.both_sides) cosine = std::fabs(cosine);
        moments.add(cosine > 0 ? double(drawn->radiance[1]) * cosine /
                                     (double(pick->probability) * drawn->pdf)
                               : 0);
    }
    return moments;
}

TEST(LightTree, DirectLightIsThatOfTheUniformChoice) {
    for (const float scale : kScales) {
        const Scene scene = random_scene(30, 8, scale);
        const LightChoice tree(scene, LightChoiceKind::Tree),
            uniform(scene, LightChoiceKind::Uniform);
        uint32_t seed = 31;
        for (LightReceiver receiver : receivers(scene, 32, scale)) {
            // Beside the lamps, not on them, where no mean would settle.
            receiver.p += receiver.normal * (0.3f * scale);
            const Moments a = irradiance(scene, tree, receiver, 20000, seed++);
            const Moments b = irradiance(scene, uniform, receiver, 100000, seed++);
            if (b.mean() == 0 && a.mean() == 0) continue;
            EXPECT_TRUE(test::agrees(test::Mean(a) - test::Mean(b), 0))
                << scale << ' ' << seed << ": " << a.mean() << " and " << b.mean();
        }
    }
}

// Alone in a node, a light counts for what it gives the receiver.
TEST(LightTree, SingleLightsAreWeighedByWhatTheyGive) {
    Scene scene;
    scene.materials = {test::glowing(Rgb(700.f))};
    scene.meshes = {test::one_triangle(V3f(1, 5, 1), V3f(1.04f, 5.02f, 1), V3f(1, 5, 1.05f))};
    scene.instances.resize(1);
    scene.lights = {PointLight{V3f(0, 2, 0), Rgb(1.f)}, PointLight{V3f(6, 1, 0), Rgb(9.f)},
                    PointLight{V3f(0, 30, 4), Rgb(90.f)}, PointLight{V3f(0, -1, 0), Rgb(9.f)},
                    SpotLight{V3f(-2, 3, 1), unit(V3f(2, -3, -1)), Rgb(2.f), 0.99f, 0.9f}};
    finish_scene(scene);
    const LightChoice choice(scene, LightChoiceKind::Tree);
    const LightReceiver receiver{V3f(0.f), V3f(0, 1, 0), false};
    std::vector<double> given;
    for (const Light& light : scene.lights) {
        const auto drawn = sample_light(scene, light, receiver.p, V2f(0.5f), Bands::rgb());
        given.push_back(std::max(0.f, drawn->direction.y) * drawn->radiance[1] / drawn->pdf);
    }
    // A spot light counts for its mean over its cone, wherever in it the receiver stands.
    given[4] *= light_power(scene, scene.lights[4]) / (2 * std::numbers::pi * (1 - 0.9) * 2);
    const double sum = std::accumulate(given.begin(), given.end(), 0.0);
    for (uint32_t i = 0; i < scene.lights.size(); ++i)
        EXPECT_NEAR(choice.probability(i, receiver), given[i] / sum, 0.02 * given[i] / sum) << i;
}

// The only lights whose reach is narrow: from within a cluster of them, too, none is out of reach
// that is not.
TEST(LightTree, SpotLightsSideBySide) {
    Random random(45);
    Scene scene;
    for (int i = 0; i < 100; ++i) {
        const V3f at(2 * random.next() - 1, 2 * random.next() - 1, 2 * random.next() - 1);
        scene.lights.push_back(
            SpotLight{at, unit(V3f(0, -1, 0) + random.direction() * 0.2f), Rgb(1.f), 0.95f, 0.9f});
    }
    const LightChoice choice(scene, LightChoiceKind::Tree);
    int reached = 0;
    for (int k = 0; k < 1000; ++k) {
        const V3f p = random.direction() * random.next();
        for (uint32_t i = 0; i < scene.lights.size(); ++i) {
            const auto drawn = sample_light(scene, scene.lights[i], p, V2f(0.5f), Bands::rgb());
            if (!drawn || drawn->direction.y <= 0) continue;
            ++reached;
            ASSERT_GT(choice.probability(i, {p, V3f(0, 1, 0), false}), 0) << i;
        }
    }
    EXPECT_GT(reached, 1000);
}

// A street of lamps: near ones matter, those behind do not.
TEST(LightTree, HasLessVarianceThanPower) {
    Scene scene;
    scene.materials = {test::glowing(Rgb(100.f))};
    for (int i = 0; i < 400; ++i) {
        const V3f at(static_cast<float>(i) * 5, 4, i % 2 ? 3.f : -3.f);
        scene.meshes.push_back(
            test::one_triangle(at, at + V3f(0.2f, 0, 0), at + V3f(0, 0, 0.2f)));  // shines down
        Instance instance;
        instance.mesh = static_cast<uint32_t>(scene.meshes.size() - 1);
        scene.instances.push_back(instance);
    }
    finish_scene(scene);
    const LightChoice tree(scene, LightChoiceKind::Tree), power(scene, LightChoiceKind::Power);
    const auto ratio = [&](const LightReceiver& receiver) {
        return irradiance(scene, power, receiver, 100000, 41).variance() /
               irradiance(scene, tree, receiver, 100000, 42).variance();
    };
    EXPECT_GT(ratio({V3f(1000, 0, 0), V3f(0, 1, 0), false}), 50);   // the street
    EXPECT_GT(ratio({V3f(1000, 0, 9), V3f(-1, 0, 0), false}), 50);  // a wall that looks along it
    const LightReceiver above{V3f(1000, 9, 0), V3f(0, -1, 0), false};
    EXPECT_FALSE(tree.pick(0.5f, above));
}

TEST(LightTree, SidesOfEmitterAndReceiver) {
    const auto probability = [](bool two_sided, const LightReceiver& receiver) {
        Scene scene = test::lamp_scene(Rgb(5.f), two_sided);
        finish_scene(scene);
        const LightChoice choice(scene, LightChoiceKind::Tree);
        const auto pick = choice.pick(0.3f, receiver);
        const float p = choice.probability(0, receiver);
        EXPECT_EQ(pick.has_value(), p > 0);
        EXPECT_EQ(pick ? pick->probability : 0.f, p);
        return p;
    };
    const V3f up(0, 1, 0), below(0.f), above(0.3f, 9, 0.3f);
    EXPECT_EQ(probability(false, {below, up, false}), 1);
    EXPECT_EQ(probability(false, {below, -up, false}), 0);
    EXPECT_EQ(probability(false, {below, -up, true}), 1);
    EXPECT_EQ(probability(false, {above, -up, false}), 0);
    EXPECT_EQ(probability(true, {above, -up, false}), 1);
    EXPECT_EQ(probability(true, {above, up, false}), 0);
    EXPECT_EQ(probability(true, {above, up, true}), 1);
}

// Stretches of u go to neighbours: what was stratified stays so.
TEST(LightTree, EveryLightHasOneStretchOfU) {
    const Scene scene = random_scene(50, 10, 1.f);
    const LightChoice choice(scene, LightChoiceKind::Tree);
    const LightReceiver receiver{V3f(0.1f, 0.2f, -0.1f), V3f(0, 1, 0), true};
    std::set<uint32_t> seen;
    uint32_t last = ~0u;
    for (int i = 0; i < 100000; ++i) {
        const auto pick = choice.pick((static_cast<float>(i) + 0.5f) / 100000, receiver);
        if (!pick || pick->light == last) continue;
        last = pick->light;
        EXPECT_TRUE(seen.insert(last).second) << last;
    }
    EXPECT_GT(seen.size(), 50u);
}

TEST(LightTree, ManyLights) {
    Scene scene;
    scene.materials = {test::glowing(Rgb(5.f), true)};
    Mesh mesh;
    Random random(60);
    for (uint32_t i = 0; i < 100000; ++i) {
        const V3f at = random.direction() * 10.f;
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(at + random.direction() * 0.01f);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    scene.meshes = {std::move(mesh)};
    scene.instances.resize(1);
    finish_scene(scene);
    const LightChoice choice(scene, LightChoiceKind::Tree);
    for (const V3f& p : {V3f(0.f), V3f(0, 9.9f, 0), V3f(3e5f, 0, 0)})
        EXPECT_NEAR(sum_of_probabilities(scene, choice, {p, V3f(1, 0, 0), true}), 1, 1e-3);
}

// Lights in one point, of no area, black, and of powers at both ends of what a float can hold.
TEST(LightTree, OddLights) {
    Scene scene = test::lamp_scene(Rgb(3e38f));
    scene.meshes.push_back(test::one_triangle(V3f(1.f), V3f(2.f), V3f(3.f)));
    scene.instances.resize(2);
    scene.instances[1].mesh = 1;
    for (int i = 0; i < 100; ++i) scene.lights.push_back(PointLight{V3f(1, 2, 3), Rgb(3e38f)});
    scene.lights.push_back(PointLight{V3f(1, 2, 3), Rgb(1e-35f)});
    scene.lights.push_back(PointLight{V3f(1, 2, 3), Rgb(0.f)});
    scene.lights.push_back(SpotLight{V3f(1e6f), V3f(0, -1, 0), Rgb(1.f), 1.f, 1.f});
    scene.lights.push_back(SpotLight{V3f(2.f), V3f(0, -1, 0), Rgb(1.f), 1.f, 0.9999f});
    finish_scene(scene);
    const LightChoice choice(scene, LightChoiceKind::Tree);
    for (const V3f& p : {V3f(1, 2, 3), V3f(2, 1, 2), V3f(1e12f, 0, 0), V3f(0.f)}) {
        const LightReceiver receiver{p, V3f(0, 1, 0), true};
        EXPECT_NEAR(sum_of_probabilities(scene, choice, receiver), 1, 1e-4);
        EXPECT_TRUE(choice.pick(kOneMinus, receiver));
        EXPECT_TRUE(choice.pick(0.f, receiver));
    }
    EXPECT_GT(choice.probability(100, {V3f(0.f), V3f(0, 1, 0), false}), 0);  // the faint one
    EXPECT_EQ(choice.probability(101, {V3f(0.f), V3f(0, 1, 0), false}), 0);  // the black one
    EXPECT_EQ(choice.probability(105, {V3f(0.f), V3f(0, 1, 0), false}), 0);  // that of no area
}

}  // namespace
}  // namespace petzval
