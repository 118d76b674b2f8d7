// SPDX-License-Identifier: Apache-2.0
// Wavefronts of real lenses: against Seidel sums, Zernike's and Strehl's theory, and Huygens.
#include "camera/waves/wavefront.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/camera/waves/stigmatic_lens.h"
#include "tests/camera/waves/wave.h"
#include "tests/support/lens_json.h"

namespace petzval::camera {
namespace {

using test::read_lens;
using test::wave_of;

constexpr double kTurn = 2 * std::numbers::pi;

Prescription with_stop(Prescription file, double factor) {
    for (LensSurface& surface : file.surfaces)
        if (surface.stop) surface.semi_diameter_mm *= factor;
    return file;
}

// Opd of the rays through a point of the stop, in its radii, against the sphere about the Gaussian
// image point.
struct GaussianWave {
    AimedBundle bundle;
    ReferenceSphere sphere;

    GaussianWave(const Lens& lens, double field_deg)
        : bundle(*AimedBundle::aim(lens, {.field_deg = field_deg}, kLineD_nm)) {
        const FirstOrder first = first_order(lens, kLineD_nm);
        const double film_mm = lens.vertex_mm(lens.last()) + first.back_focus_mm;
        const double height_mm = first.focal_length_mm * std::tan(field_deg * kTurn / 360);
        sphere = reference_sphere(bundle, film_mm, {0, height_mm});
    }
    // By Newton's method; x, y in radii of the stop.
    [[nodiscard]] double opd_mm(double x, double y) const {
        double s = bundle.chief()[0], t = bundle.chief()[1];
        const double width = (bundle.most()[0] - bundle.least()[0]) / 2;
        for (int i = 0; i < 20; ++i) {
            const auto at = [&](double ds, double dt) {
                return meet_reference<d4>(bundle, sphere, broadcast<d4>(s + ds),
                                          broadcast<d4>(t + dt));
            };
            const double h = 1e-4 * width;
            const auto here = at(0, 0), by_s = at(h, 0), by_t = at(0, h);
            const double a = (by_s.stop_x[0] - here.stop_x[0]) / h,
                         b = (by_t.stop_x[0] - here.stop_x[0]) / h,
                         c = (by_s.stop_y[0] - here.stop_y[0]) / h,
                         d = (by_t.stop_y[0] - here.stop_y[0]) / h;
            const double off_x = x - here.stop_x[0], off_y = y - here.stop_y[0];
            if (std::hypot(off_x, off_y) < 1e-9) return here.opd_mm[0];
            s += (d * off_x - b * off_y) / (a * d - b * c);
            t += (a * off_y - c * off_x) / (a * d - b * c);
        }
        throw std::runtime_error("no ray there");
    }
};

// W = S1/8 r^4 + S2/2 r^3 cos + S3/2 r^2 cos^2 + (S3 + S4)/4 r^2 + S5/2 r cos: Welford 1986,
// Aberrations of Optical Systems, ch. 8. At a small aperture and field the traced opd has nothing
// else. Each is told from the others by its symmetry; the signs follow from a pupil that is
// upright.
TEST(Wavefront, ThirdOrderAberrationsAreSeidels) {
    for (const char* name : {"double-gauss-100mm-f2", "cooke-triplet-50mm-f5",
                             "kodak-petzval-100mm-f2", "takumar-50mm-f1.2"}) {
        const Lens whole(read_lens(name));
        const double fnumber = first_order(whole, kLineD_nm).fnumber;
        const Lens lens(with_stop(read_lens(name), fnumber / std::max(6 * fnumber, 16.)));
        constexpr double deg = 1;
        const SeidelSums sums = seidel(lens, std::tan(deg * kTurn / 360)).total;
        const GaussianWave axis(lens, 0), field(lens, deg);
        const auto of = [](const GaussianWave& wave, double r) {
            struct Parts {
                double even_y, odd_y, even_x;
            } parts{};
            const double up = wave.opd_mm(0, r), down = wave.opd_mm(0, -r);
            parts.even_y = (up + down) / 2;
            parts.odd_y = (up - down) / 2;
            parts.even_x = (wave.opd_mm(r, 0) + wave.opd_mm(-r, 0)) / 2;
            return parts;
        };
        const auto on_axis = of(axis, 1), full = of(field, 1), half = of(field, 0.5);
        const double w040 = on_axis.even_y;
        // Odd parts at r and r / 2 part coma from distortion.
        const double w131 = (full.odd_y - 2 * half.odd_y) / 0.75, w311 = full.odd_y - w131;
        const double sagittal = full.even_x - w040, tangential = full.even_y - w040;
        const struct {
            const char* what;
            double found, wanted;
        } rows[] = {{"W040", w040, sums[0] / 8},
                    {"W131", w131, sums[1] / 2},
                    {"W222", tangential - sagittal, sums[2] / 2},
                    {"W220", sagittal, (sums[2] + sums[3]) / 4},
                    {"W311", w311, sums[4] / 2}};
        for (const auto& row : rows) {
            EXPECT_NEAR(row.found, row.wanted, 0.04 * std::fabs(row.wanted) + 1.5e-8)
                << name << row.what;
        }
    }
}

TEST(Wavefront, ZernikePolynomialsAreOrthonormal) {
    constexpr int count = 28, side = 160;
    std::vector<double> sums(count * count);
    double cells = 0;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const double x = (2 * i + 1. - side) / side, y = (2 * j + 1. - side) / side;
            if (x * x + y * y > 1) continue;
            ++cells;
            std::vector<double> z;
            for (int k = 1; k <= count; ++k) z.push_back(zernike(k, x, y));
            for (size_t a = 0; a < count; ++a)
                for (size_t b = 0; b < count; ++b) sums[a * count + b] += z[a] * z[b];
        }
    for (size_t a = 0; a < count; ++a)
        for (size_t b = 0; b < count; ++b)
            EXPECT_NEAR(sums[a * count + b] / cells, a == b ? 1 : 0, 0.02) << a << ' ' << b;
    // Noll 1976, table I.
    const double x = 0.3, y = -0.6, r2 = x * x + y * y;
    EXPECT_NEAR(zernike(2, x, y), 2 * x, 1e-14);
    EXPECT_NEAR(zernike(3, x, y), 2 * y, 1e-14);
    EXPECT_NEAR(zernike(4, x, y), std::sqrt(3.) * (2 * r2 - 1), 1e-14);
    EXPECT_NEAR(zernike(5, x, y), std::sqrt(6.) * 2 * x * y, 1e-14);
    EXPECT_NEAR(zernike(6, x, y), std::sqrt(6.) * (x * x - y * y), 1e-14);
    EXPECT_NEAR(zernike(7, x, y), std::sqrt(8.) * (3 * r2 - 2) * y, 1e-14);
    EXPECT_NEAR(zernike(8, x, y), std::sqrt(8.) * (3 * r2 - 2) * x, 1e-14);
    EXPECT_NEAR(zernike(9, x, y), std::sqrt(8.) * (3 * x * x * y - y * y * y), 1e-14);
    EXPECT_NEAR(zernike(10, x, y), std::sqrt(8.) * (x * x * x - 3 * x * y * y), 1e-14);
    EXPECT_NEAR(zernike(11, x, y), std::sqrt(5.) * (6 * r2 * r2 - 6 * r2 + 1), 1e-14);
}

// Mahajan 1982: exp(-(2 pi sigma)^2). Small errors of lenses, and of a film that is out of focus.
TEST(Wavefront, StrehlIsMahajansBelowAFourteenthOfAWave) {
    int compared = 0;
    double worst = 0;
    for (const char* name :
         {"double-gauss-100mm-f2", "cooke-triplet-50mm-f5", "canon-14mm-f2.8-asph"})
        for (const double factor : {0.15, 0.25, 0.35, 0.5})
            for (const double deg : {0., 3.})
                for (const double shift : {-0.02, 0., 0.02}) {
                    const Lens lens(with_stop(read_lens(name), factor));
                    const auto wave = wave_of(lens, {.field_deg = deg}, shift, kFiguresPupilSide);
                    const WavefrontFigures figures = wavefront_figures(wave.pupil);
                    const double sigma = figures.rms_mm / wave.pupil.wavelength_mm();
                    if (sigma > 1 / 14.) continue;
                    ++compared;
                    const double wanted = std::exp(-std::pow(kTurn * sigma, 2));
                    worst = std::max(worst, std::fabs(figures.strehl / wanted - 1));
                    EXPECT_NEAR(figures.strehl, wanted, 0.01 * wanted) << name << factor << deg;
                }
    EXPECT_GE(compared, 20);
}

// Coefficients that are put in come out, in a vignetted pupil too.
TEST(Wavefront, ZernikeCoefficientsAreFound) {
    const Lens lens(read_lens("takumar-50mm-f1.2"));
    auto wave = wave_of(lens, {.field_deg = 18}, 0, kFiguresPupilSide);
    constexpr int count = 28;
    std::vector<double> put;
    for (int j = 1; j <= count; ++j) put.push_back(1e-4 * std::sin(1.7 * j));
    for (size_t cell = 0; cell < wave.pupil.opd_mm.size(); ++cell) {
        wave.pupil.opd_mm[cell] = 0;
        for (int j = 1; wave.pupil.light[cell] > 0 && j <= count; ++j)
            wave.pupil.opd_mm[cell] +=
                put[size_t(j) - 1] * zernike(j, wave.pupil.stop[cell][0], wave.pupil.stop[cell][1]);
    }
    const auto found = zernike_coefficients_mm(wave.pupil, count);
    for (size_t i = 0; i < count; ++i) EXPECT_NEAR(found[i], put[i], 1e-9) << i + 1;
}

// Spherical aberration of the third and the fifth order in a pupil of even light: Noll's Z11 and
// Z22.
TEST(Wavefront, ZernikeCoefficientsOfALensAddUpToItsRms) {
    const Lens lens(with_stop(read_lens("double-gauss-100mm-f2"), 0.5));
    const auto wave = wave_of(lens, {}, 0, kFiguresPupilSide);
    const auto found = zernike_coefficients_mm(wave.pupil, 28);
    double sum = 0;
    for (size_t i = 3; i < found.size(); ++i) sum += found[i] * found[i];
    const double rms = wavefront_figures(wave.pupil).rms_mm;
    EXPECT_NEAR(std::sqrt(sum), rms, 0.01 * rms);
    for (const size_t j : {2, 3, 5, 6, 7, 8, 9, 10}) EXPECT_NEAR(found[j - 1], 0, 1e-3 * rms) << j;
}

// Stops before, in and behind the front focal plane: the exit pupil goes through infinity, and
// nothing jumps. Inside the sphere's sign changes.
TEST(Wavefront, AnExitPupilMayLieAtInfinity) {
    const auto lens_with = [](double stop_mm) {
        Prescription file = test::stigmatic_lens(50, 4);
        file.surfaces[0].thickness_mm = stop_mm;
        file.surfaces[1].semi_diameter_mm = file.surfaces[2].semi_diameter_mm = 30;
        return Lens(file);
    };
    const FirstOrder near = first_order(lens_with(1), kLineD_nm);
    // The stop's distance at which the exit pupil is at infinity: where the front focus lies.
    const double telecentric_mm = 1 - near.front_focus_mm;
    double last_rms = 0, last_strehl = 0;
    // The last one: a pupil behind the film, and near it.
    for (const double off_mm : {-0.1, -1e-9, 0., 1e-9, 0.1, 60.}) {
        const Lens lens = lens_with(telecentric_mm + off_mm);
        const auto wave = wave_of(lens, {.field_deg = 0.3}, 0.01, kFiguresPupilSide);
        const WavefrontFigures figures = wavefront_figures(wave.pupil);
        const bool far = std::fabs(off_mm) < 1;
        if (far)
            EXPECT_LT(std::fabs(wave.pupil.sphere.curvature_1_mm), 1e-4) << off_mm;
        else
            EXPECT_LT(wave.pupil.sphere.curvature_1_mm, -0.02) << off_mm;
        if (far && last_rms > 0) {
            EXPECT_NEAR(figures.rms_mm, last_rms, 0.01 * last_rms) << off_mm;
            EXPECT_NEAR(figures.strehl, last_strehl, 0.01) << off_mm;
        }
        last_rms = figures.rms_mm;
        last_strehl = figures.strehl;
        const std::vector<std::array<double, 2>> points{{0, 0}};
        const PointSpread spread = point_spread(wave.pupil, 2048);
        const auto huygens = huygens_spread(wave.bundle, wave.pupil.sphere.film_mm,
                                            wave.pupil.sphere.image_mm, points, 200);
        const double peak = spread.share[size_t(1024) * 2048 + 1024] / std::pow(spread.step_mm, 2);
        EXPECT_NEAR(huygens[0], peak, 0.01 * peak) << off_mm;
    }
}

// The fast transform of Debye's integral and wavelets at their true distances: aberrations of
// waves, fields, a near object, colours, vignetting, and exit pupils near and at infinity.
TEST(Wavefront, FastTransformAndHuygensAgree) {
    struct Case {
        const char* name;
        double stop, field_deg, shift_mm, distance_mm = INFINITY;
        Section section = Section::Y;
    };
    for (const Case& c : {Case{"cooke-triplet-50mm-f5", 1, 0, 0},
                          {"cooke-triplet-50mm-f5", 1, 14, 0.05},
                          {"double-gauss-100mm-f2", 0.5, 10, -0.1},
                          {"takumar-50mm-f1.2", 0.4, 15, 0},
                          {"canon-14mm-f2.8-asph", 1, 30, 0},
                          {"minolta-fisheye-16mm-f2.8", 0.5, 60, 0},
                          {"schneider-anamorphic-31mm", 0.3, 8, 0.02, INFINITY, Section::X},
                          {"takumar-50mm-f1.2", 0.25, 0, 0.9, 3000}}) {
        const Lens lens(with_stop(read_lens(c.name), c.stop));
        const auto wave =
            wave_of(lens, {c.field_deg, c.distance_mm, c.section}, c.shift_mm, 0, kLineF_nm);
        EXPECT_TRUE(wave.pupil.grid.resolves());
        const PointSpread spread = point_spread(wave.pupil, 4 * wave.pupil.grid.side);
        const auto n = size_t(spread.side);
        const double peak = *std::max_element(spread.share.begin(), spread.share.end());
        std::vector<std::array<double, 2>> points;
        std::vector<double> wanted;
        for (size_t i = 0; i < n * n; i += 1)
            if (spread.share[i] > 0.1 * peak && (i * 7919) % 5 == 0) {
                points.push_back({spread.offset_mm(i % n), spread.offset_mm(i / n)});
                wanted.push_back(spread.share[i] / std::pow(spread.step_mm, 2));
                if (points.size() == 24) break;
            }
        const auto found = huygens_spread(wave.bundle, wave.pupil.sphere.film_mm,
                                          wave.pupil.sphere.image_mm, points, 240);
        double worst = 0;
        for (size_t i = 0; i < found.size(); ++i)
            worst = std::max(worst,
                             std::fabs(found[i] - wanted[i]) * std::pow(spread.step_mm, 2) / peak);
        EXPECT_LT(worst, 0.01) << c.name << c.field_deg;
    }
}

}  // namespace
}  // namespace petzval::camera
