// SPDX-License-Identifier: Apache-2.0
#include "core/scene/sky.h"

#include <numbers>

#include "core/sampling/warp.h"
#include "tests/support/chi_square.h"

namespace petzval {
namespace {

using test::Random;

// The direction that looks at (u, v) of a picture that is not turned.
V3f direction_at(double u, double v) {
    const double azimuth = 2 * std::numbers::pi * (u - 0.5), polar = std::numbers::pi * v;
    return {static_cast<float>(std::sin(polar) * std::cos(azimuth)),
            static_cast<float>(std::cos(polar)),
            static_cast<float>(std::sin(polar) * std::sin(azimuth))};
}

// Texel (x, y) holds (x, y, 1), so that a lookup tells where it fell.
Sky coordinates(int width, int height, float rotate_deg = 0.f) {
    std::vector<float> rgb;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            rgb.push_back(static_cast<float>(x));
            rgb.push_back(static_cast<float>(y));
            rgb.push_back(1.f);
        }
    return Sky::picture(rgb, width, height, rotate_deg, 1.f);
}

Sky spiky(int width, int height, float rotate_deg, uint32_t seed) {
    std::vector<float> rgb;
    Random random(seed);
    for (int i = 0; i < 3 * width * height; ++i) rgb.push_back(std::pow(random.next(), 4.f));
    rgb[3 * ((width + 2) % (width * height))] = 40.f;
    return Sky::picture(rgb, width, height, rotate_deg, 2.f);
}

// The tests' cells are about +z.
V3f y_to_z(const V3f& w) {
    return {w.x, -w.z, w.y};
}
V3f z_to_y(const V3f& w) {
    return {w.x, w.z, -w.y};
}

TEST(Sky, TexelsStandWhereTheConventionSays) {
    const Sky sky = coordinates(16, 8);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x) {
            const Rgb found = sky.radiance(direction_at((x + 0.5) / 16, (y + 0.5) / 8));
            ASSERT_NEAR(found[0], x, 1e-4);
            ASSERT_NEAR(found[1], y, 1e-4);
            ASSERT_NEAR(found[2], 1, 1e-5);
        }
    // u = 0.5 looks along +x, 0.25 along -z, 0.75 along +z; v = 0 is up.
    EXPECT_NEAR(sky.radiance({1, 0, 0})[0], 7.5, 1e-4);
    EXPECT_NEAR(sky.radiance({0, 0, -1})[0], 3.5, 1e-4);
    EXPECT_NEAR(sky.radiance({0, 0, 1})[0], 11.5, 1e-4);
    EXPECT_NEAR(sky.radiance({0, 1, 0})[1], 0, 1e-4);
    EXPECT_NEAR(sky.radiance({0, -1, 0})[1], 7, 1e-4);
}

TEST(Sky, TurnsCounterClockwiseSeenFromAbove) {
    // From above, with x to the right, -z is up: a quarter turn takes +x there.
    const Sky sky = coordinates(16, 8, 90.f);
    EXPECT_NEAR(sky.radiance({0, 0, -1})[0], 7.5, 1e-4);
    EXPECT_NEAR(sky.radiance({1, 0, 0})[0], 11.5, 1e-4);
    const Sky back = coordinates(16, 8, -270.f), twice = coordinates(16, 8, 450.f);
    for (const V3f& w : {direction_at(0.1, 0.3), direction_at(0.7, 0.6)}) {
        EXPECT_NEAR(back.radiance(w)[0], sky.radiance(w)[0], 1e-4);
        EXPECT_NEAR(twice.radiance(w)[0], sky.radiance(w)[0], 1e-4);
    }
}

TEST(Sky, IsBilinearWithASeamThatCloses) {
    const Sky sky = coordinates(16, 8);
    EXPECT_NEAR(sky.radiance(direction_at(5.75 / 16, 3.25 / 8))[0], 5.25, 1e-4);
    EXPECT_NEAR(sky.radiance(direction_at(5.75 / 16, 3.25 / 8))[1], 2.75, 1e-4);
    EXPECT_NEAR(sky.radiance(direction_at(0.0, 0.5))[0], 7.5, 1e-4);  // between 15 and 0
    EXPECT_NEAR(sky.radiance(direction_at(0.25 / 16, 0.5))[0], 3.75, 1e-4);
    EXPECT_NEAR(sky.radiance(direction_at(0.3, 0.25 / 8))[1], 0, 1e-4);
    EXPECT_NEAR(sky.radiance(direction_at(0.3, 7.75 / 8))[1], 7, 1e-4);
}

TEST(Sky, AverageIsTheIntegralOfWhatLookupsFind) {
    for (const Sky& sky :
         {spiky(7, 5, 33.f, 1), spiky(1, 1, 0.f, 2), spiky(32, 3, 200.f, 3), spiky(5, 2, 0.f, 4)}) {
        const auto luminance_at = [&](double u, double v) {
            return luminance(sky.radiance(direction_at(u, v))) * std::sin(std::numbers::pi * v) *
                   std::numbers::pi / 2;
        };
        const double integral = test::integrate(luminance_at, 0, 1, 0, 1, 1e-7, 4);
        EXPECT_NEAR(sky.average_luminance(), integral, 4e-4 * integral);
    }
}

TEST(Sky, SamplesFollowTheDensity) {
    const Sky coarse = spiky(20, 10, 36.f, 5), narrow = spiky(1, 2, 0.f, 8);
    uint32_t seed = 6;
    for (const Sky* sky : {&coarse, &narrow})
        EXPECT_TRUE(test::chi_square_sphere(
            [&](Random& random) { return y_to_z(sky->sample(random.next2()).direction); },
            [&](const V3f& w) { return sky->pdf(z_to_y(w)); }, seed++));
}

TEST(Sky, DrawsHaveTheDensityThatLookupsFind) {
    const Sky sky = spiky(256, 128, 77.f, 9);
    Random random(10);
    for (int i = 0; i < 20000; ++i) {
        const auto drawn = sky.sample(random.next2());
        const auto there = sky.find(drawn.place), again = sky.find(drawn.direction);
        ASSERT_NEAR(drawn.direction.length(), 1, 1e-6);
        ASSERT_GT(there.pdf, 0);
        // A rounding of the direction moves the place by 1e-4 of a texel.
        ASSERT_NEAR(there.pdf, again.pdf, 1e-3f * there.pdf + 1e-4f);
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(there.radiance[c], again.radiance[c], 1e-3f * there.radiance[c] + 1e-3f);
    }
}

// What is drawn of a sky of any contrast is what of each texel is above the mean, looked up like
// radiance. Not next to the poles, where the sine is not linear from row to row.
TEST(Sky, TheDensityIsOfTheLightAboveTheMean) {
    std::vector<float> rgb;
    Random random(14);
    for (int i = 0; i < 512 * 256; ++i)
        rgb.insert(rgb.end(), 3, 0.1f + std::pow(random.next(), 8.f));
    std::fill_n(&rgb[3 * (512 * 70 + 20)], 3, 1000.f);
    const Sky sky = Sky::picture(rgb, 512, 256, 20.f, 1.f);
    for (float& c : rgb) c = std::max(c - sky.average_luminance(), 0.f);
    const Sky above = Sky::picture(rgb, 512, 256, 20.f, 1.f);
    EXPECT_NEAR(sky.drawn_luminance(), above.average_luminance(), 1e-3f);
    int drawn = 0;
    for (int i = 0; i < 20000; ++i) {
        const V3f w = uniform_sphere(random.next2());
        if (std::fabs(w.y) > 0.8f) continue;
        const float expected = luminance(above.radiance(w)) /
                               (4 * std::numbers::pi_v<float> * above.average_luminance());
        ASSERT_NEAR(sky.pdf(w), expected, 0.02f * expected + 1e-4f) << w;
        drawn += expected > 0;
    }
    EXPECT_GT(drawn, 4000);
}

TEST(Sky, EstimatesTheLightThatArrives) {
    const Sky sky = spiky(24, 12, 10.f, 11);
    double expected = 0;  // irradiance on a surface that faces up
    for (int i = 0; i < 1024 * 512; ++i) {
        const double u = (i % 1024 + 0.5) / 1024, v = (i / 1024 + 0.5) / 512;
        const V3f w = direction_at(u, v);
        if (w.y > 0)
            expected += luminance(sky.radiance(w)) * w.y * std::sin(std::numbers::pi * v) * 2 *
                        std::numbers::pi * std::numbers::pi / (1024.0 * 512);
    }
    // Where no direction is drawn, another way has to find the light: here, uniform directions.
    Random random(12);
    test::Moments moments;
    for (int i = 0; i < 200000; ++i) {
        const auto drawn = sky.sample(random.next2());
        const auto found = sky.find(drawn.place);
        const V3f other = uniform_sphere(random.next2());
        const auto rest = sky.find(other);
        moments.add(luminance(found.radiance) * std::max(drawn.direction.y, 0.f) / found.pdf +
                    (rest.pdf > 0 ? 0.f
                                  : luminance(rest.radiance) * std::max(other.y, 0.f) /
                                        uniform_sphere_pdf()));
    }
    EXPECT_TRUE(test::agrees(moments, expected))
        << moments.mean() << " +- " << moments.standard_error() << ", not " << expected;
}

TEST(Sky, StrengthScales) {
    std::vector<float> rgb(3 * 8 * 4, 2.f);
    rgb[40] = 5.f;
    const Sky sky = Sky::picture(rgb, 8, 4, 0.f, 1.5f), weaker = Sky::picture(rgb, 8, 4, 0.f, 0.5f);
    EXPECT_NEAR(sky.average_luminance(), 3 * weaker.average_luminance(), 1e-5);
    for (const V3f& w : {V3f(0, 0, 1), V3f(1, 0, 0), V3f(0, -1, 0)}) {
        EXPECT_NEAR(sky.radiance(w)[1], 3 * weaker.radiance(w)[1], 1e-6);
        EXPECT_NEAR(sky.pdf(w), weaker.pdf(w), 1e-6);
    }
}

TEST(Sky, EvenSkiesAreLeftToTheBsdf) {
    std::vector<float> rgb(3 * 64 * 32, 2.f);
    for (const Sky& sky : {Sky::uniform(Rgb(3.f)), Sky::picture(rgb, 64, 32, 0.f, 1.f)}) {
        EXPECT_TRUE(sky.even());
        EXPECT_FALSE(sky.black());
        EXPECT_EQ(sky.drawn_luminance(), 0.f);
        EXPECT_EQ(sky.pdf({0, 0, 1}), 0.f);
    }
    // A small lamp with a thousandth of the light: a BSDF sample finds it once in 2000 times, and
    // then it is a firefly.
    rgb[3 * 64 * 9] = 20.f;
    const Sky lamp = Sky::picture(rgb, 64, 32, 0.f, 1.f);
    EXPECT_FALSE(lamp.even());
    EXPECT_LT(lamp.drawn_luminance(), 2e-3f * lamp.average_luminance());
}

TEST(Sky, BlackSkies) {
    for (const Sky& sky : {Sky(), Sky::uniform(Rgb(0.f)),
                           Sky::picture(std::vector<float>(3 * 8 * 4), 8, 4, 0.f, 1.f)}) {
        EXPECT_TRUE(sky.black());
        EXPECT_EQ(sky.pdf({0, 1, 0}), 0.f);
        EXPECT_EQ(sky.radiance({0, 1, 0})[0], 0.f);
    }
    EXPECT_FALSE(Sky::uniform(Rgb(0, 0, 0.1f)).black());
}

TEST(Sky, PolesAndAxesAreFinite) {
    const Sky sky = spiky(64, 32, 123.f, 13);
    for (const V3f& w : {V3f(0, 1, 0), V3f(0, -1, 0), V3f(1, 0, 0), V3f(-1, 0, 0), V3f(-1, 0, -0.f),
                         V3f(0, 0, 1), V3f(0, 0, -1)}) {
        const auto found = sky.find(w);
        EXPECT_TRUE(std::isfinite(hsum(found.radiance.v)));
        EXPECT_GE(found.pdf, 0.f);
        EXPECT_LT(found.pdf, kInfinity);
    }
    for (const float x : {0.f, kOneMinus, 1.f})
        for (const float y : {0.f, kOneMinus, 1.f})
            EXPECT_NEAR(sky.sample({x, y}).direction.length(), 1, 1e-6);
}

}  // namespace
}  // namespace petzval
