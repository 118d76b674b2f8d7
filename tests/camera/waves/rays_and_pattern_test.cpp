// SPDX-License-Identifier: Apache-2.0
// Rays and pattern together: against theory where all is known, and against point spreads.
#include "camera/waves/rays_and_pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "camera/bench/spot.h"
#include "camera/iris/iris.h"
#include "tests/camera/waves/stigmatic_lens.h"
#include "tests/camera/waves/wave.h"
#include "tests/support/lens_json.h"
#include "tests/support/nasty_lens.h"

namespace petzval::camera {
namespace {

using test::stigmatic_lens;
using test::wave_of;

constexpr double kFocal_mm = 50, kWhole = 2 * std::numbers::pi;

RaysAndPattern on_axis(const Lens& lens, double film_shift_mm = 0, double most_cycles_per_mm = 100,
                       const StopTransmission& iris = {}) {
    const auto bundle = AimedBundle::aim(lens, {}, kLineD_nm);
    const double weight = 1;
    const auto found = rays_and_pattern({&*bundle, 1}, {&weight, 1}, lens.film_mm() + film_shift_mm,
                                        most_cycles_per_mm, iris);
    if (!found) throw std::runtime_error("no light");
    return *found;
}

// Shift of the film after which the wave at the rim is so many wavelengths behind.
double defocus_mm(double waves, double fnumber) {
    return 8 * waves * kLineD_nm * 1e-6 * fnumber * fnumber;
}

// The stigmatic lens with an asphere that leaves spherical aberration of so many waves at its rim.
Lens spherical(double fnumber, double waves) {
    Prescription file = stigmatic_lens(kFocal_mm, fnumber);
    const double rim_mm = file.surfaces[0].semi_diameter_mm;
    file.surfaces[2].asphere = {{4, waves * kLineD_nm * 1e-6 / 0.5 / std::pow(rim_mm, 4)}};
    return Lens(file);
}

// Largest difference of the moduli, up to a share of the cut-off, for a wave with W waves r^2 + S
// waves r^4 in a round pupil: by waves the mean of exp(2 pi i difference of the wave) over where
// the pupil and its copy overlap, by rays that of exp(2 pi i slope times shift) over the pupil.
// Hopkins 1955, Proc. R. Soc. A 231, 91; Goodman 2005, sec. 6.4.
double difference_in_theory(double w, double s, double most, int steps = 20) {
    constexpr int side = 400;
    const auto wave = [&](double x, double y) {
        const double r2 = x * x + y * y;
        return w * r2 + s * r2 * r2;
    };
    double worst = 0;
    for (int step = 1; step <= steps; ++step) {
        const double shift = 2 * most * step / steps;  // in radii
        std::complex<double> waves, pattern, rays;
        double area = 0;
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const double x = (2 * i + 1.) / side - 1, y = (2 * j + 1.) / side - 1;
                const double r2 = x * x + y * y;
                if (r2 > 1) continue;
                ++area;
                rays += std::polar(1., kWhole * shift * (2 * w * x + 4 * s * r2 * x));
                if ((x - shift) * (x - shift) + y * y > 1) continue;
                pattern += 1;
                waves += std::polar(1., kWhole * (wave(x, y) - wave(x - shift, y)));
            }
        worst = std::max(worst, std::fabs(std::abs(waves / area) -
                                          std::abs(pattern / area) * std::abs(rays / area)));
    }
    return worst;
}

TEST(RaysAndPattern, AgreeWithoutAberrations) {
    for (const double fnumber : {2.8, 8., 22.}) {
        const Lens lens(stigmatic_lens(kFocal_mm, fnumber));
        const RaysAndPattern found = on_axis(lens);
        EXPECT_LT(found.contrast_error, 0.005) << fnumber;
        EXPECT_LT(found.error_of_pattern, 0.005) << fnumber;
        EXPECT_LT(found.rms_waves, 1e-3);
        EXPECT_TRUE(found.sharp_or_wide);
        // Goodman 2005, eq. 6-31, at 100 cycles per mm: what rays alone leave out.
        const double s = std::min(1., 100 * kLineD_nm * 1e-6 * fnumber);
        const double ideal = 1 - 4 / kWhole * (std::acos(s) - s * std::sqrt(1 - s * s));
        // The pupil is brighter in the middle than the formula's.
        EXPECT_NEAR(found.error_of_rays, ideal, 0.025) << fnumber;
    }
}

TEST(RaysAndPattern, DifferAsInTheoryOutOfFocus) {
    constexpr double fnumber = 16;
    const Lens lens(stigmatic_lens(10 * kFocal_mm, fnumber));  // a shift is small beside it
    const double cutoff = 1 / (kLineD_nm * 1e-6 * fnumber);
    for (const double waves : {0.1, 0.25, 0.5, 1., 2.}) {
        const RaysAndPattern found = on_axis(lens, defocus_mm(waves, fnumber), 0.9 * cutoff);
        EXPECT_NEAR(found.contrast_error, difference_in_theory(waves, 0, 0.9), 0.01) << waves;
        EXPECT_NEAR(found.rms_waves, waves / std::sqrt(12.), 0.01 * waves);
        // The spot's radius is 4 waves, its RMS radius that over the root of 2.
        EXPECT_NEAR(found.blur, 4 * waves * std::numbers::sqrt2, 0.02 * found.blur);
    }
}

// 8.5 wavelengths times f-number: past the rule of thumb twice over, and not yet exact.
TEST(RaysAndPattern, AreNearFarOutOfFocus) {
    const Lens lens(stigmatic_lens(kFocal_mm, 8));
    const RaysAndPattern some = on_axis(lens, defocus_mm(1.5, 8)),
                         much = on_axis(lens, defocus_mm(12, 8));
    EXPECT_GT(some.blur, 8);
    EXPECT_TRUE(some.sharp_or_wide);
    EXPECT_LT(some.contrast_error, 0.12);
    EXPECT_LT(much.contrast_error, 0.03);
}

// The measure is not blind, and the rule of thumb is: to it half a wave of spherical aberration is
// wide, a third sharp.
TEST(RaysAndPattern, DifferForHalfAWaveOfSphericalAberration) {
    constexpr double fnumber = 16;
    const double cutoff = 1 / (kLineD_nm * 1e-6 * fnumber);
    const RaysAndPattern found = on_axis(spherical(fnumber, 0.5), 0, 0.9 * cutoff);
    EXPECT_NEAR(found.rms_waves, 0.5 * 2 / std::sqrt(45.), 0.005);
    EXPECT_GT(found.contrast_error, 0.1);
    EXPECT_NEAR(found.contrast_error, difference_in_theory(0, 0.5, 0.9), 0.01);
    EXPECT_GT(found.blur, 4);
    const RaysAndPattern third = on_axis(spherical(fnumber, 0.33), 0, 0.9 * cutoff);
    EXPECT_LT(third.rms_waves, 0.1);
    EXPECT_TRUE(found.sharp_or_wide && third.sharp_or_wide);
    EXPECT_GT(third.contrast_error, 0.1);
}

// A wavelength of a field, its pupil on the grid that `lens mtf` takes.
struct FieldLine {
    LineSpread waves[2], pattern[2];  // along x, along y
    std::vector<BundleRay> rays;
    std::array<double, 2> middle_mm;
};

FieldLine field_line(const AimedBundle& bundle, double film_mm,
                     const std::array<double, 2>& image_mm) {
    const ReferenceSphere sphere = reference_sphere(bundle, film_mm, image_mm);
    PupilFunction pupil = pupil_function(bundle, sphere, *pupil_grid(bundle, sphere));
    FieldLine out;
    const auto set = [&](LineSpread(&lines)[2]) {
        const PointSpread spread = point_spread(pupil, 4 * pupil.grid.side);
        lines[0] = line_spread(spread, Section::X);
        lines[1] = line_spread(spread, Section::Y);
    };
    set(out.waves);
    std::fill(pupil.opd_mm.begin(), pupil.opd_mm.end(), 0.);
    set(out.pattern);
    out.rays = bundle.trace(bundle.grid(200), film_mm);
    for (BundleRay& ray : out.rays)
        for (size_t k = 0; k < 2; ++k) ray.film_mm[k] -= image_mm[k];
    out.middle_mm = spot_size(out.rays).centroid_mm;
    return out;
}

// All of a real field, lateral colour included: the same by point spreads, as `lens mtf` has them.
TEST(RaysAndPattern, ErrorsAreThoseOfPointSpreads) {
    const double weights[] = {0.5, 0.3, 0.2}, lines_nm[] = {kLineD_nm, kLineF_nm, kLineC_nm};
    Prescription file = test::read_lens("minolta-fisheye-16mm-f2.8");
    for (LensSurface& surface : file.surfaces)
        if (surface.stop) surface.semi_diameter_mm /= 4;
    const Lens lens(file);
    for (const double field_deg : {0., 60.}) {
        std::vector<AimedBundle> bundles;
        std::array<double, 2> image_mm{};
        for (size_t i = 0; i < 3; ++i) {
            bundles.push_back(*AimedBundle::aim(lens, {field_deg}, lines_nm[i]));
            for (size_t k = 0; k < 2; ++k)
                image_mm[k] += weights[i] * (*image_point(bundles[i], lens.film_mm()))[k];
        }
        std::vector<FieldLine> lines;
        for (const AimedBundle& bundle : bundles)
            lines.push_back(field_line(bundle, lens.film_mm(), image_mm));
        const auto found = rays_and_pattern(bundles, weights, lens.film_mm(), 100);
        ASSERT_TRUE(found);
        double both_error = 0, rays_error = 0, pattern_error = 0, unmoved_error = 0;
        for (double cycles = 5; cycles <= 100; cycles += 5)
            for (const size_t k : {0, 1}) {
                const Section along = k == 0 ? Section::X : Section::Y;
                std::complex<double> waves, both, rays, pattern, unmoved;
                for (size_t i = 0; i < 3; ++i) {
                    const FieldLine& line = lines[i];
                    const auto by_rays = geometric_transfer(line.rays, cycles, along);
                    const auto by_pattern = transfer(line.pattern[k], cycles);
                    waves += weights[i] * transfer(line.waves[k], cycles);
                    rays += weights[i] * by_rays;
                    both += weights[i] * by_rays * by_pattern;
                    pattern += weights[i] * by_pattern *
                               std::polar(1., -kWhole * cycles * line.middle_mm[k]);
                    unmoved += weights[i] * by_pattern;
                }
                const auto keep = [&](double& worst, const std::complex<double>& other) {
                    worst = std::max(worst, std::fabs(std::abs(waves) - std::abs(other)));
                };
                keep(both_error, both);
                keep(rays_error, rays);
                keep(pattern_error, pattern);
                keep(unmoved_error, unmoved);
                if (std::fabs(cycles - found->cycles_per_mm) > 1e-6 || along != found->along)
                    continue;
                EXPECT_NEAR(found->by_waves, std::abs(waves), 0.004) << field_deg;
                EXPECT_NEAR(found->by_rays_and_pattern, std::abs(both), 0.004) << field_deg;
            }
        EXPECT_NEAR(found->contrast_error, both_error, 0.005) << field_deg;
        EXPECT_NEAR(found->error_of_rays, rays_error, 0.005) << field_deg;
        EXPECT_NEAR(found->error_of_pattern, pattern_error, 0.005) << field_deg;
        EXPECT_GT(found->contrast_error, 0.05);
        if (field_deg > 0) {
            EXPECT_GT(unmoved_error - pattern_error, 0.1);
        }
        // Figures are of the worst wavelength.
        RaysAndPattern worst{.blur = INFINITY};
        for (const AimedBundle& bundle : bundles) {
            const double one = 1;
            const auto alone = rays_and_pattern({&bundle, 1}, {&one, 1}, lens.film_mm(), 100);
            worst.rms_waves = std::max(worst.rms_waves, alone->rms_waves);
            worst.blur = std::min(worst.blur, alone->blur);
            worst.sharp_or_wide &= alone->sharp_or_wide;
        }
        EXPECT_NEAR(found->rms_waves, worst.rms_waves, 0.003);
        EXPECT_NEAR(found->blur, worst.blur, 0.01 * worst.blur);
        EXPECT_EQ(found->sharp_or_wide, worst.sharp_or_wide);
    }
}

// An iris is in the waves, in the pattern and among the rays.
TEST(RaysAndPattern, AnIrisNarrowsAll) {
    const Lens lens(stigmatic_lens(kFocal_mm, 8));
    const double rim_mm = lens.prescription().surfaces[0].semi_diameter_mm;
    const Iris iris(regular_polygon(6, 0), rim_mm / 2, ApertureScale::Inscribed);
    const StopTransmission hexagon = [&](double x, double y) {
        return double(iris.transmits({float(x), float(y)}));
    };
    EXPECT_LT(on_axis(lens, 0, 100, hexagon).contrast_error, 0.005);
    const RaysAndPattern open = on_axis(lens, defocus_mm(1, 8)),
                         narrow = on_axis(lens, defocus_mm(1, 8), 100, hexagon);
    // A hexagon's mean r^2 and r^4 are 5/12 and 7/30 of its corners'.
    EXPECT_NEAR(narrow.rms_waves, std::sqrt(7. / 30 - 25. / 144) / 4, 0.01);
    EXPECT_NEAR(open.rms_waves, 1 / std::sqrt(12.), 0.01);
    // Spots are as wide as irises, f-numbers as the roots of their areas.
    const double spot = std::sqrt(5. / 12 / 0.5) / 2,
                 area = 1.5 * std::sqrt(3.) / 4 / std::numbers::pi;
    EXPECT_NEAR(narrow.blur / open.blur, spot * std::sqrt(area), 0.005);
}

// Sharp at a long wavelength and not at a short one; sharp in the middle and not beside it.
TEST(RaysAndPattern, OneThatIsNotSharpOrWideIsEnough) {
    EXPECT_FALSE(sharp_or_wide(0.11, 3.9));
    const Lens lens(stigmatic_lens(kFocal_mm, 8));
    const double film_mm = lens.film_mm() + defocus_mm(0.4, 8);
    const auto with = [&](std::initializer_list<WeighedWavelength> light) {
        return diffraction_limits(lens, film_mm, INFINITY, std::array{0.}, light, 50)
            ->sharp_or_wide;
    };
    EXPECT_FALSE(with({{kLineD_nm, 0.5}, {1000, 0.5}}));
    EXPECT_TRUE(with({{900, 0.5}, {1000, 0.5}}));
    Prescription file = test::read_lens("takumar-50mm-f1.2");
    for (LensSurface& surface : file.surfaces)
        if (surface.stop) surface.semi_diameter_mm /= 7;
    const Lens stopped(file);
    const auto of = [&](std::initializer_list<double> fields_deg) {
        const WeighedWavelength light[] = {{kLineD_nm, 1}};
        return diffraction_limits(stopped, stopped.film_mm(), INFINITY, fields_deg, light, 50)
            ->sharp_or_wide;
    };
    EXPECT_TRUE(of({0}));
    EXPECT_FALSE(of({18}));
    EXPECT_FALSE(of({18, 0}));
}

TEST(RaysAndPattern, FrequenciesFarTooLowAndTooHigh) {
    const Lens lens(test::read_lens("takumar-50mm-f1.2"));
    EXPECT_LT(on_axis(lens, 0, 0.01).cycles_per_mm, 10);
    EXPECT_LT(on_axis(lens, 0, 1e9).cycles_per_mm, 2000);
}

TEST(RaysAndPattern, NastyLensesHaveFiniteErrorsOrNone) {
    test::Random random(7);
    int told = 0;
    for (int i = 0; i < 40; ++i) {
        const std::optional<Lens> lens = test::some_lens(random, i);
        if (!lens) continue;
        const WeighedWavelength light[] = {{100, 0.4}, {kLineD_nm, 0.5}, {20000, 0.1}};
        const double fields_deg[] = {0, test::between(random, 0, 100)};
        const auto found = diffraction_limits(*lens, lens->film_mm(), i % 5 ? INFINITY : 700,
                                              fields_deg, light, i % 3 ? 100 : 2);
        if (!found) continue;
        ++told;
        // Cells at rims are counted by shares, so that all of the light may be a little more.
        ASSERT_LE(found->worst.contrast_error, 1.01) << i;
        ASSERT_GE(found->worst.contrast_error, 0) << i;
        ASSERT_TRUE(std::isfinite(found->worst.rms_waves)) << i;
        ASSERT_TRUE(std::isfinite(found->worst.blur)) << i;
    }
    EXPECT_GT(told, 8);
}

TEST(RaysAndPattern, LimitsAreThoseOfTheWorstField) {
    const Lens lens(test::read_lens("takumar-50mm-f1.2"));
    const WeighedWavelength light[] = {{kLineD_nm, 0.6}, {kLineF_nm, 0.4}};
    const auto of = [&](std::initializer_list<double> fields_deg) {
        return diffraction_limits(lens, lens.film_mm(), INFINITY, fields_deg, light, 50);
    };
    const auto all = of({0, 10, 20, 89});  // no light from there
    ASSERT_TRUE(all);
    double worst = 0;
    for (const double field_deg : {0., 10., 20.})
        worst = std::max(worst, of({field_deg})->worst.contrast_error);
    EXPECT_EQ(all->worst.contrast_error, worst);
    EXPECT_EQ(of({all->field_deg})->worst.contrast_error, worst);
    EXPECT_FALSE(of({89}));
    EXPECT_FALSE(of({}));
}

}  // namespace
}  // namespace petzval::camera
