// SPDX-License-Identifier: Apache-2.0
// Directions that the Bsdf draws: their density, and the mean of their weights.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/core/bsdf_inputs.h"
#include "tests/support/chi_square.h"
#include "tests/support/jacobian.h"

namespace petzval {
namespace {

using namespace test;

struct BsdfCase {
    const char* name;
    BsdfInput in;
    float cosine;
    int lane = 1;
    f4 throughput = splat(1.f);
    V3f up{0, 0, 1};
};

/// 60 degrees off the shading normal.
const V3f kTilted = from_cosine(0.5f, 2.2f);

class BsdfSampling : public testing::TestWithParam<BsdfCase> {};

TEST_P(BsdfSampling, DirectionsFollowTheDensity) {
    const Bsdf bsdf(GetParam().in, Bands::rgb(), from_cosine(GetParam().cosine, 0.7f),
                    GetParam().throughput, GetParam().up);
    const auto draw = [&](test::Random& random) -> std::optional<V3f> {
        const float u_lobe = random.next();
        const auto s = bsdf.sample(u_lobe, random.next2());
        return s ? std::optional(s->wi) : std::nullopt;
    };
    const auto pdf = [&](const V3f& wi) -> double { return bsdf.eval(wi).pdf; };
    EXPECT_TRUE(chi_square_sphere(draw, pdf, 11)) << GetParam().name;
}

// The integral of the value over uniform directions, which know nothing of the lobes, against the
// mean weight of the sampler's own.
TEST_P(BsdfSampling, WeightsIntegrateTheValue) {
    const Bsdf bsdf(GetParam().in, Bands::rgb(), from_cosine(GetParam().cosine, 0.7f),
                    GetParam().throughput, GetParam().up);
    const int lane = GetParam().lane;
    constexpr int n = 400000;
    test::Random random(5);
    test::Moments value, weight;
    for (int i = 0; i < n; ++i) {
        value.add(4 * std::numbers::pi * double(bsdf.eval(random.direction()).f_cos[lane]));
        const float u_lobe = random.next();
        const auto s = bsdf.sample(u_lobe, random.next2());
        weight.add(s ? double(s->weight[lane]) : 0);
    }
    EXPECT_TRUE(test::agrees(test::Mean(value) - test::Mean(weight), 0))
        << value.mean() << " and " << weight.mean();
}

INSTANTIATE_TEST_SUITE_P(
    All, BsdfSampling,
    testing::Values(BsdfCase{"diffuse", dielectric(1.f), 0.7f},
                    BsdfCase{"coat", dielectric(0.4f), 0.4f}, BsdfCase{"metal", metal(0.5f), 0.6f},
                    BsdfCase{"grazing metal", metal(0.7f), 0.1f},
                    BsdfCase{"glass in", glass(0.5f, 1.5f), 0.7f},
                    BsdfCase{"glass out", glass(0.5f, 1 / 1.5f), 0.8f},
                    BsdfCase{"thin", thin_glass(0.6f), 0.5f}, BsdfCase{"gold", gold(0.5f), 0.6f},
                    BsdfCase{"dispersing in", dispersing(0.5f, false), 0.7f, 0},
                    BsdfCase{"dispersing out", dispersing(0.5f, true), 0.8f, 2},
                    BsdfCase{"one lane left", dispersing(0.5f, true), 0.8f, 2, f4{0, 0, 1, 0}},
                    BsdfCase{"unequal lanes", dispersing(0.4f, false), 0.6f, 1, f4{1, 0.2f, 3, 0}},
                    BsdfCase{"metal and glass", half_metal(glass(1.f, 1 / 1.5f)), 0.6f},
                    BsdfCase{"metal and a rough pane", half_metal(thin_glass(0.6f)), 0.3f},
                    BsdfCase{"tilted metal and glass", half_metal(glass(0.7f, 1.5f)), 0.6f, 1,
                             splat(1.f), kTilted},
                    BsdfCase{"tilted diffuse", dielectric(1.f), 0.7f, 1, splat(1.f), kTilted},
                    BsdfCase{"tilted metal", metal(0.4f), 0.6f, 1, splat(1.f), kTilted},
                    BsdfCase{"tilted thin", thin_glass(0.5f), 0.5f, 1, splat(1.f), kTilted},
                    BsdfCase{"tilted glass", glass(0.5f, 1.5f), 0.7f, 1, splat(1.f), kTilted},
                    BsdfCase{"tilted dispersing", dispersing(0.5f, true), 0.8f, 2, splat(1.f),
                             kTilted}),
    [](const auto& case_info) {
        std::string name = case_info.param.name;
        for (char& c : name) c = c == ' ' ? '_' : c;
        return name;
    });

// Where one lobe answers alone, its density is the inverse of the area that u is spread over.
TEST(Bsdf, JacobianOfTheReflectionLobe) {
    const V3f wo = from_cosine(0.6f, 0.3f);
    for (const float roughness : {0.3f, 0.8f}) {
        const Bsdf bsdf(metal(roughness), Bands::rgb(), wo);
        const auto direction = [&](V2f u) -> std::optional<V3f> {
            const auto s = bsdf.sample(0.5f, u);
            return s ? std::optional(s->wi) : std::nullopt;
        };
        const auto pdf = [&](const V3f& wi) -> double { return bsdf.eval(wi).pdf; };
        EXPECT_TRUE(test::jacobian_matches(direction, pdf, 3)) << roughness;
    }
}

}  // namespace
}  // namespace petzval
