// SPDX-License-Identifier: Apache-2.0
// Findings about scenes, materials, lights, samples and films.
#include <cmath>
#include <numbers>

#include "io/lens/lens_file.h"
#include "tests/stability/findings.h"
#include "tests/support/statistics.h"

namespace petzval::stability {
namespace {

TEST_F(Findings, SceneScale) {
    take(scene_scale());
    // Where squares leave the range of floats, at about 1e-19 and 1e19 of something of the size of
    // the radius or of a triangle, Embree's kernels differ: two decades within nothing leaks, and
    // beyond nearly all does.
    for (size_t i = 0; i < rows(); ++i) {
        const double radius = value(i, "radius (m)");
        if (radius >= 1e-6 && radius <= 1e8) {
            EXPECT_EQ(cell(i, "leaks"), "0 %") << radius;
            EXPECT_EQ(cell(i, "self-hits"), "0 %") << radius;
        }
        if (radius <= 1e-12 || radius >= 1e13) {
            EXPECT_GT(value(i, "leaks"), 10) << radius;
        }
        const double away = value(i, "away (radii)");
        if (away <= 1e5) {
            EXPECT_EQ(cell(i, "leaks there"), "0 %") << away;
            EXPECT_EQ(cell(i, "self-hits there"), "0 %") << away;
        }
        if (away >= 1e7) {
            EXPECT_GT(value(i, "leaks there"), 50) << away;
        }
    }
    expect_where("7.04e-9 3.28e10 1.05e6", {.factor = 10});
}

TEST_F(Findings, CameraFarFromOrigin) {
    take(camera_far_from_origin());
    expect_column("off (px)", "0.00447 0.0137 0.123 0.962 14.6 112 1130 15700", kSizeOfRounding);
    expect_where("67.8 1000 1", kSizeOfRounding);
}

TEST_F(Findings, GgxEnergy) {
    take(ggx_energy());
    // 16384 evenly spread samples and three digits: 0.005 where all comes back, more where samples
    // weigh unequally.
    const Tolerance even{.absolute = 0.006}, uneven{.absolute = 0.012};
    expect_column("metal at cosine 1", "1 1 1 1 1 1 1 1 1 1", even);
    expect_column("0.1", "1 1 1 1 1 0.999 0.999 1 1 1", even);
    expect_column("0.01", "1 1 1 1.01 0.996 1 1 1 1 1", even);
    expect_column("1e-4", "1 1 1.01 1.02 1 1 1 1 1 1", uneven);
    expect_column("plastic at 0.1", "1 1 1 1 1 1 0.999 1 1 1", even);
    expect_column("plastic at 1e-4", "1 1 1.01 1.01 1 0.999 1 1 1 1", uneven);
    expect_column("glass at 1", "1 1 1 1 1 1 1 0.997 0.996 0.996", even);
    expect_column("glass at 0.1", "1 1 1 1 0.998 0.998 0.998 0.999 0.998 1", even);
    expect_column("glass at 1e-4", "1 1 0.995 1 1 0.998 0.997 0.998 0.998 0.998", even);
    // Where 1 % is first passed hangs on noise of half of that.
    expect_where("1 * 1.51 0.05 * 1.1 2.4 0.969 0.204 0.01 0.95 0.344 0",
                 {.relative = 0.3, .absolute = 0.02});
    EXPECT_TRUE(f.where.ends_with("not numbers: 0")) << f.where;
}

TEST_F(Findings, GgxDensity) {
    take(ggx_density());
    for (const char* column : {"cosine 1", "0.5", "0.1", "0.01", "1e-3", "1e-4"})
        expect_column(column, "1 1 1 1 1 1", {.absolute = 0.006});
    EXPECT_EQ(f.fails, "nothing");
}

/// Of a variance 1 / p - 1 that some thousands of samples found, or none: those that found light
/// are p of 65536, and a number of n independent ones is good to 1 / sqrt(n), 4.4 times at most.
Tolerance rare(double variance) {
    return {.factor = 1 + 4.4 / std::sqrt(std::fmax(65536 / (1 + variance), 2))};
}

TEST_F(Findings, TinySun) {
    take(tiny_sun());
    // What varies is the angle of light between the texel's neighbours, less for smaller texels.
    expect_column("both (as rendered)", "0.0272 6.75e-4 4.36e-5 1e-5 2.61e-6", {.relative = 0.05});
    expect_column("light samples only", "0.0218 6.03e-4 4.35e-5 1e-5 2.61e-6", {.relative = 0.05});
    const double variance[] = {19.9, 314, 3720, 22400};
    for (size_t i = 0; i < 4; ++i)
        EXPECT_TRUE(near(value(i, "surface samples only"), variance[i], rare(variance[i]))) << i;
    // In the last row less than one is to be expected.
    expect_where("10000 1 1e8 512 680 0.0272", {.factor = 2.1});
}

TEST_F(Findings, TinyLamp) {
    take(tiny_lamp());
    // What varies is the angle to a lamp of that side, 10 m away.
    expect_column("both (as rendered)", "0.00036 4.41e-6 * * * *", {.relative = 0.1});
    expect_column("light samples only", "0.000341 4.37e-6 * * * *", {.relative = 0.1});
    for (size_t i = 2; i < rows(); ++i)
        for (const char* column : {"both (as rendered)", "light samples only"})
            EXPECT_EQ(cell(i, column), "below 1e-9") << i;
    const double alone[] = {35.6, 313}, behind_glass[] = {65.2, 503};
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_TRUE(near(value(i, "surface samples only"), alone[i], rare(alone[i]))) << i;
        EXPECT_TRUE(
            near(value(i, "as rendered behind glass"), behind_glass[i], rare(behind_glass[i])))
            << i;
    }
    for (size_t i = 3; i < rows(); ++i)  // of the third row two are to be expected
        for (const char* column : {"surface samples only", "as rendered behind glass"})
            EXPECT_EQ(cell(i, column), "none of 65536 found it") << i;
    // Six hits and seven are to either side of it: in proportion to the side's square.
    expect_where("10000 1 1e8 0.18 0.215 65536 1", {.factor = 1.6});
}

TEST_F(Findings, DefocusedHighlights) {
    take(defocused_highlights());
    for (size_t i = 0; i < rows(); ++i) {
        const double side = value(i, "side (m)"), fstop = value(i, "f/");
        // A thin lens of 50 mm in focus at 1 m, 9 m before the highlight.
        const double there = 0.05 / fstop * 9;
        const double share = side * side / (std::numbers::pi / 4 * there * there);
        EXPECT_TRUE(near(value(i, "blur there (m)"), there, kAsPrinted)) << i;
        EXPECT_TRUE(near(value(i, "share"), share, kAsPrinted)) << i;
        EXPECT_TRUE(near(value(i, "blur (px)"), there / 10 * (50 / 0.95) / 0.006, kAsPrinted)) << i;
        const double variance = std::fmax(1 / share - 1, 0);
        // Hits among 131072 samples: at least as even as independent ones.
        const Tolerance chance{.relative = 0.01 + 4.4 / std::sqrt(131072 * std::fmin(share, 1))};
        EXPECT_TRUE(near(value(i, "variance"), variance, chance)) << i;
        EXPECT_TRUE(near(value(i, "samples for 10 %"), 100 * variance, chance)) << i;
    }
    // From 128 means: a variance is good to sqrt(2 / 128), 4.4 times at most.
    expect_column("gain of Owen", "7.86 4.17 - - - 11.2 8.56 -", {.relative = 0.55});
    // Where 1 / share is 100 and 1000.
    expect_where("1 1 1.4 0.321 99 0.0285 999 0.00907 2.82", {.relative = 0.08});
}

TEST_F(Findings, RenderedNoise) {
    take(rendered_noise());
    for (size_t i = 0; i < rows(); ++i) {
        const double chance = value(i, "share of paths"), samples = value(i, "samples");
        // Without the lamp 16 samples are enough, with all of it 1.083 / 0.1^2, less its light.
        EXPECT_GE(samples, 16) << i;
        EXPECT_LT(samples, 400) << i;
        if (chance > 0.02) EXPECT_EQ(value(i, "too noisy"), 0) << i;
        if (chance < 2e-6) EXPECT_GT(value(i, "too noisy"), 90) << i;
    }
}

// Seeds are fixed: what may change are roundings, and with them which pixels are alike.
TEST_F(Findings, DenoisedRareLight) {
    take(denoised_rare_light());
    for (size_t i = 0; i < rows(); ++i) {
        const double found = value(i, "found"), kept = value(i, "kept");
        EXPECT_LT(value(i, "squares"), 0.3) << i;
        if (found > 20000) EXPECT_GT(kept, 98) << i;
        if (found < 1000) EXPECT_LT(kept, 50) << i;
        if (found > 20) EXPECT_GE(value(i, "held"), 90) << i;
        if (found < 0.5) EXPECT_LE(value(i, "held"), 50) << i;
    }
    expect_where("0.01 1e-6");
}

TEST_F(Findings, DenoisedDetail) {
    take(denoised_detail());
    for (size_t i = 0; i < rows(); ++i) {
        const double noise = value(i, "noise over detail"), kept = value(i, "kept");
        EXPECT_LT(value(i, "squares"), 0.4) << i;
        EXPECT_GE(value(i, "held"), 90) << i;
        if (noise < 0.2) EXPECT_GT(kept, 98) << i;
        if (noise > 0.9) EXPECT_LT(kept, 50) << i;
    }
    expect_where("1");
}

TEST_F(Findings, PlannedNoise) {
    take(planned_noise());
    for (size_t i = 0; i < rows(); ++i) {
        const double side = value(i, "side (m)"), there = 0.05 / 1.4 * 9;
        const double share = side * side / (std::numbers::pi / 4 * there * there);
        const double paths = 64 * 36 * 4 * 32 * share;
        EXPECT_TRUE(near(value(i, "share"), share, kAsPrinted)) << i;
        EXPECT_TRUE(near(value(i, "expected"), paths, kAsPrinted)) << i;
        EXPECT_TRUE(near(value(i, "variance"), 1 / share - 1, kAsPrinted)) << i;
        // 4.4 standard errors of a number of hits.
        EXPECT_NEAR(value(i, "met"), paths, 4.4 * std::sqrt(paths) + 0.01 * paths) << i;
        // A lamp is found by few of the samples that scale its noise: to a factor, down to none.
        const double planned = value(i, "planned") * share;
        EXPECT_GT(planned, 0.4) << i;
        EXPECT_LT(planned, 2.5) << i;
        if (paths > 64) EXPECT_EQ(cell(i, "says"), "about") << i;
        if (paths < 4) EXPECT_EQ(cell(i, "says"), "at least") << i;
    }
}

TEST_F(Findings, ChainsOfGlass) {
    take(chains_of_glass());
    // 8192 fixed samples: roundings change few of their choices.
    const Tolerance few{.relative = 0.02, .absolute = 0.1};
    expect_column("panes", "1 2 4 8 16 32 64 128");
    expect_column("lost at depth 16", "0 0 0.806 23.6 76 76 76 76", few);
    expect_column("lost at depth 64", "0 0 0 0.0366 6.97 39.5 46.6 46.6", few);
    expect_column("lost at depth 256", "0 0 0 0 0 1.32 16.7 24.2", few);
    expect_where("256 0.1 25 1 31", {.relative = 0.05});
}

TEST_F(Findings, NestedVolumes) {
    take(nested_volumes());
    ASSERT_EQ(rows(), 12u);
    for (size_t i = 0; i < 8; ++i) {
        const double a = value(i, "a");
        EXPECT_EQ(cell(i, "slabs"), i < 4 ? "closed" : "open");
        // The way from the inner slab's back to the lamp is half a metre.
        const double ratio = i < 4 ? 1 : 1 / std::sqrt(a);
        EXPECT_TRUE(near(value(i, "should"), std::pow(a, 2.5), kAsPrinted)) << a;
        EXPECT_TRUE(near(value(i, "ratio"), ratio, kAsPrinted)) << a;
    }
    // Light across slabs that lie apart, what goes to and fro included: (1 - R) / (1 + R) each for
    // the odds 2 R / (1 - R) of its two faces, and odds add up (Stokes 1862).
    const auto odds = [](double a, double b) {
        const double r = std::pow((a - b) / (a + b), 2);
        return r / (1 - r);
    };
    const double touching = 1 / (1 + odds(1, 1.5) + odds(1.5, 1.33) + odds(1.33, 1));
    const double apart = 1 / (1 + 2 * odds(1, 1.5) + 2 * odds(1, 1.33));
    for (size_t i = 8; i < 12; ++i) {
        EXPECT_TRUE(near(value(i, "should"), touching, kAsPrinted));
        // 65536 samples: the standard error is 0.001.
        const double ratio = value(i, "gap (m)") > 0 ? apart / touching : 1;
        EXPECT_NEAR(value(i, "ratio"), ratio, 0.004) << value(i, "gap (m)");
    }
    expect_where("0.001 10 0.01 " + number(100 - 100 * apart / touching), {.relative = 0.05});
}

TEST_F(Findings, StacksOfCards) {
    take(stacks_of_cards());
    expect_column("cards", "1 2 4 8 9 16 32 100 1000");
    // 4096 fixed samples: roundings change few of their choices.
    expect_column("variance", "0.098 0.144 0.157 0.16 0.55 0.57 0.58 0.59 0.59", {.relative = 0.1});
    for (size_t i = 0; i < rows(); ++i) {
        const double error = std::sqrt(value(i, "variance") / 4096);
        EXPECT_NEAR(value(i, "seen / closed form"), 1, 4 * error) << i;
        EXPECT_LT(value(i, "rays"), 7) << i;
        EXPECT_LT(value(i, "to the sun"), 3.2) << i;
    }
}

TEST_F(Findings, ManySamples) {
    take(many_samples());
    ASSERT_EQ(rows(), 11u);
    double n = 256;
    for (size_t i = 0; i < 8; ++i, n *= 4) {
        // Hits of independent points are binomial; their squared errors over 4 seeds, chi-square.
        const double p = std::numbers::pi / 4, variance = p * (1 - p) / n;
        const double squares = 4 * std::pow(value(i, "independent"), 2) / variance;
        EXPECT_GE(test::chi_square_p(squares, 4), test::sidak()) << n;
        EXPECT_LE(test::chi_square_p(squares, 4), 1 - test::sidak()) << n;
    }
    // Of four seeds; a point at the disk's edge is rounded to either side.
    expect_column("Owen", "0.00536 0.000944 0.000611 0.0003 0.000162 4.35e-5 1.42e-5 4.8e-6 - - -",
                  {.factor = 1.5});
    expect_column("Sobol", "0.00489 0.00152 0.000753 7.39e-5 0.00012 4.26e-5 1.27e-5 2.24e-6 - - -",
                  {.factor = 1.5});
    for (size_t i = 4; i < rows(); ++i) {
        EXPECT_EQ(cell(i, "empty by Owen"), "0") << i;
        EXPECT_EQ(cell(i, "empty by Sobol"), "0") << i;
        // Each of N cells is empty with the chance 1 / e; the variance of their number is
        // N (1 / e - 2 / e^2).
        const double cells = 65536, e = std::numbers::e;
        const double error = std::sqrt(cells * (1 / e - 2 / (e * e)));
        EXPECT_TRUE(test::agrees({value(i, "empty by independent"), error}, cells / e)) << i;
    }
    EXPECT_EQ(f.fails, "nothing");
}

TEST_F(Findings, FilmSums) {
    take(film_sums());
    for (size_t i = 0; i < rows(); ++i)  // exact sums: half a float's spacing at 1
        EXPECT_LE(value(i, "error of the mean"), 0x1p-24 * 1.01) << i;
    expect_column("stated / exact standard error", "1 1 1 1 1 1 1 1 1", {.relative = 1e-3});
    EXPECT_EQ(f.fails, "nothing");
}

}  // namespace
}  // namespace petzval::stability
