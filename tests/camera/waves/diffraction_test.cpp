// SPDX-License-Identifier: Apache-2.0
// Images by waves of lenses without aberrations, against their closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/camera/waves/stigmatic_lens.h"
#include "tests/camera/waves/wave.h"

namespace petzval::camera {
namespace {

using test::stigmatic_lens;
using test::wave_of;

constexpr double kOnePi = std::numbers::pi;

double jinc(double v) {
    return v == 0 ? 1 : 2 * std::cyl_bessel_j(1., v) / v;
}

// Sine of the angle under which the rim of the stop is seen from the film.
double rim_sine(const test::TestWave& wave) {
    const double radius = wave.bundle.lens().prescription().surfaces[0].semi_diameter_mm;
    const auto ray =
        meet_reference<d4>(wave.bundle, wave.pupil.sphere, d4{}, broadcast<d4>(radius));
    return std::fabs(ray.q[0]);
}

// Point spread by a coarse grid of the pupil, so that samples on the film are fine.
PointSpread fine_spread(const test::TestWave& wave, const StopTransmission& iris = {}) {
    return point_spread(
        pupil_function(wave.bundle, wave.pupil.sphere, wave.pupil.grid.with_side(64), iris), 2048);
}

// First zero of the field along x, between samples.
double first_zero_mm(const PointSpread& spread) {
    const auto n = size_t(spread.side);
    const auto field = [&](size_t i) { return std::sqrt(spread.share[n / 2 * n + i]); };
    size_t i = n / 2 + 1;
    while (field(i + 1) < field(i)) ++i;
    return spread.offset_mm(i - 1) +
           2 * spread.step_mm * field(i - 1) / (field(i - 1) + field(i + 1));
}

TEST(Diffraction, AStigmaticLensHasAFlatWavefront) {
    for (const double fnumber : {1.2, 4., 22.}) {
        const Lens lens(stigmatic_lens(50, fnumber));
        const auto wave = wave_of(lens);
        const WavefrontFigures figures = wavefront_figures(wave.pupil);
        EXPECT_LT(figures.peak_to_valley_mm, 1e-11) << fnumber;
        EXPECT_NEAR(figures.strehl, 1, 1e-9);
        EXPECT_NEAR(figures.fnumber, 0.5 / rim_sine(wave), 0.02 * figures.fnumber);
    }
}

TEST(Diffraction, AiryPatternAndItsFirstZero) {
    for (const double fnumber : {8., 22.}) {
        const Lens lens(stigmatic_lens(50, fnumber));
        const auto wave = wave_of(lens);
        const double sine = rim_sine(wave), k = 2 * kOnePi / wave.pupil.wavelength_mm();
        EXPECT_NEAR(wavefront_figures(wave.pupil).fnumber, 0.5 / sine, 2e-3 * fnumber);
        const PointSpread spread = fine_spread(wave);
        const auto n = size_t(spread.side);
        const double cell_mm2 = spread.step_mm * spread.step_mm;
        // Light per mm^2 at the middle: area of the pupil over the wavelength squared.
        const double peak = kOnePi * sine * sine / std::pow(wave.pupil.wavelength_mm(), 2);
        const double zero_mm = airy_radius_mm(kLineD_nm, 0.5 / sine);
        for (size_t i = n / 2; i < n / 2 + 400; ++i) {
            const double x = spread.offset_mm(i);
            const double found = spread.share[n / 2 * n + i] / cell_mm2;
            EXPECT_NEAR(found, peak * std::pow(jinc(k * sine * x), 2), 2e-3 * peak) << x;
        }
        const double zero = first_zero_mm(spread);
        EXPECT_NEAR(zero, zero_mm, 0.005 * zero_mm);
        // By Huygens's wavelets.
        double least = INFINITY, least_mm = 0;
        std::vector<std::array<double, 2>> points;
        for (int i = 0; i <= 40; ++i) points.push_back({zero_mm * (0.9 + 0.005 * i), 0});
        const auto huygens = huygens_spread(wave.bundle, lens.film_mm(), {}, points, 160);
        for (size_t i = 0; i < points.size(); ++i)
            if (huygens[i] < least) least = huygens[i], least_mm = points[i][0];
        EXPECT_NEAR(least_mm, zero_mm, 0.005 * zero_mm);
        const double middle = huygens_spread(wave.bundle, lens.film_mm(), {}, {{{}}}, 160)[0];
        EXPECT_NEAR(middle, peak, 0.005 * peak);
        // Half of the light: 1 - J0^2 - J1^2 (Rayleigh; Born and Wolf 1999, eq. 8.5-18).
        constexpr double half_v = 1.68022;
        EXPECT_NEAR(
            std::pow(std::cyl_bessel_j(0., half_v), 2) + std::pow(std::cyl_bessel_j(1., half_v), 2),
            0.5, 1e-4);
        EXPECT_NEAR(radii_of_shares_mm({&spread, 1}, std::array{1.}, std::array{0.5})[0],
                    half_v / (k * sine), 0.02 * zero_mm);
    }
}

// Born and Wolf 1999, sec. 8.6.2: a central obstruction of e times the radius.
TEST(Diffraction, AnAnnulusHasItsPattern) {
    constexpr double e = 0.5;
    const Lens lens(stigmatic_lens(50, 16));
    const double radius = lens.prescription().surfaces[0].semi_diameter_mm;
    const StopTransmission ring = [&](double x, double y) {
        return std::hypot(x, y) > e * radius ? 1. : 0.;
    };
    const auto wave = wave_of(lens);
    const double sine = rim_sine(wave), k = 2 * kOnePi / wave.pupil.wavelength_mm();
    const PointSpread spread = fine_spread(wave, ring);
    const auto n = size_t(spread.side);
    const double peak = spread.share[n / 2 * n + n / 2];
    for (size_t i = n / 2; i < n / 2 + 300; ++i) {
        const double v = k * sine * spread.offset_mm(i);
        const double wanted = std::pow((jinc(v) - e * e * jinc(e * v)) / (1 - e * e), 2);
        const double found = spread.share[i * n + n / 2] / peak;
        EXPECT_NEAR(found, wanted, 3e-3) << v;
    }
    const double zero = k * sine * first_zero_mm(spread);
    constexpr double wanted_zero = 3.1443;  // J1(v) = e J1(e v)
    EXPECT_NEAR(jinc(wanted_zero), e * e * jinc(e * wanted_zero), 1e-4);
    EXPECT_NEAR(zero, wanted_zero, 0.005 * wanted_zero);
}

// Born and Wolf 1999, sec. 8.8.2: on the axis (sin(u/4) / (u/4))^2, u = 2 pi / wavelength * z
// sin^2.
TEST(Diffraction, DefocusOnTheAxisIsASincSquared) {
    const Lens lens(stigmatic_lens(400, 16));
    const auto wave = wave_of(lens);
    const double sine = rim_sine(wave);
    const double wavelength = wave.pupil.wavelength_mm();
    for (const double waves : {0.25, 0.5, 0.9, 1., 1.5}) {  // of W020
        const double shift = waves * wavelength / (1 - std::sqrt(1 - sine * sine));
        const double wanted = std::pow(std::sin(kOnePi * waves) / (kOnePi * waves), 2);
        for (const double sign : {-1., 1.}) {
            // By moving the wave, and by tracing to the other film.
            EXPECT_NEAR(wavefront_figures(moved(wave.pupil, sign * shift)).strehl, wanted, 2e-3);
            const auto traced = wave_of(lens, {}, sign * shift);
            EXPECT_NEAR(wavefront_figures(traced.pupil).strehl, wanted, 2e-3) << waves;
            EXPECT_NEAR(wavefront_figures(traced.pupil).rms_mm, waves * wavelength / std::sqrt(12.),
                        2e-3 * wavelength);
            const double huygens =
                huygens_spread(traced.bundle, lens.film_mm() + sign * shift, {}, {{{}}}, 120)[0];
            EXPECT_NEAR(huygens * wavelength * wavelength / (kOnePi * sine * sine), wanted, 5e-3);
        }
    }
}

// Goodman 2005, Introduction to Fourier Optics, eq. 6-31.
TEST(Diffraction, MtfOfAnIdealLens) {
    for (const double fnumber : {2.8, 16.}) {
        const Lens lens(stigmatic_lens(50, fnumber));
        const auto wave = wave_of(lens);
        const double cutoff = 2 * rim_sine(wave) / wave.pupil.wavelength_mm();
        const PointSpread spread = point_spread(wave.pupil, 2 * wave.pupil.grid.side);
        double worst = 0;
        for (const Section along : {Section::X, Section::Y}) {
            const LineSpread line = line_spread(spread, along);
            for (double s = 0; s <= 1.1; s += 0.05) {
                const double wanted =
                    s < 1 ? 2 / kOnePi * (std::acos(s) - s * std::sqrt(1 - s * s)) : 0;
                const double found = std::abs(transfer(line, s * cutoff));
                worst = std::max(worst, std::fabs(found - wanted));
                // The lens is no aplanat: at f/2.8 its pupil is brighter in the middle.
                EXPECT_NEAR(found, wanted, fnumber > 10 ? 0.005 : 0.02) << s << ' ' << fnumber;
            }
        }
    }
}

}  // namespace
}  // namespace petzval::camera
