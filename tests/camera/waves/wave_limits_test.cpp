// SPDX-License-Identifier: Apache-2.0
// Waves where something is extreme: irises, masks, pupils, fields; and where they meet rays.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "camera/bench/field_focus.h"
#include "camera/bench/spot.h"
#include "camera/iris/iris.h"
#include "camera/lens/focus.h"
#include "tests/camera/waves/stigmatic_lens.h"
#include "tests/camera/waves/wave.h"
#include "tests/support/lens_json.h"
#include "tests/support/nasty_lens.h"

namespace petzval::camera {
namespace {

using test::read_lens;
using test::stigmatic_lens;
using test::wave_of;

Prescription with_stop_mm(Prescription file, double radius_mm) {
    for (LensSurface& surface : file.surfaces)
        if (surface.stop) surface.semi_diameter_mm = radius_mm;
    return file;
}

double sum_of_shares(const PointSpread& spread) {
    double sum = 0;
    for (const double share : spread.share) sum += share;
    return sum;
}

// Area of direction cosines that rays of a bundle cover, from a sphere about the image point
// through the middle of the paraxial exit pupil: the sum over a fine net of those that pass.
double area_of_directions(const AimedBundle& bundle, double film_mm,
                          const std::array<double, 2>& image_mm) {
    constexpr int side = 400;
    const Lens& lens = bundle.lens();
    const double exit_mm =
        lens.vertex_mm(lens.last()) + first_order(lens, bundle.nm()).exit_pupil_mm;
    const double radius_mm = std::hypot(image_mm[0], image_mm[1], film_mm - exit_mm);
    const auto cosines = [&](const BundleRay& ray) {
        const V3d way = V3d(ray.slope[0], ray.slope[1], 1).normalized();
        const V3d film(ray.film_mm[0] - image_mm[0], ray.film_mm[1] - image_mm[1], 0);
        const double along = film.dot(way);
        const double back =
            along + std::sqrt(radius_mm * radius_mm - film.dot(film) + along * along);
        const V3d from = film - back * way;
        return std::array{-from.x / radius_mm, -from.y / radius_mm};
    };
    const double width = (bundle.most()[0] - bundle.least()[0]) / side,
                 height = (bundle.most()[1] - bundle.least()[1]) / side;
    double area = 0;
    for (const BundleRay& ray : bundle.trace(bundle.grid(side), film_mm)) {
        const PupilPoint at = ray.pupil_point, right{at[0] + width, at[1]},
                         above{at[0], at[1] + height};
        const auto next = bundle.trace(std::array{right, above}, film_mm, Clip::No);
        if (next.size() < 2) continue;
        const auto here = cosines(ray), by_s = cosines(next[0]), by_t = cosines(next[1]);
        area += std::fabs((by_s[0] - here[0]) * (by_t[1] - here[1]) -
                          (by_s[1] - here[1]) * (by_t[0] - here[0]));
    }
    return area;
}

// The Biotar's rays beyond its rims land far away, and more of them at some wavelengths.
TEST(WaveLimits, AnFnumberIsThatOfTheRaysThatPass) {
    const Lens lens(test::read_any_lens("biotar-58mm-f1.4"));
    for (const double field_deg : {0., 14.35})
        for (const double nm : {435., 500., 540., 587.5618, 656.}) {
            const auto wave = wave_of(lens, {field_deg}, 0, kFiguresPupilSide, nm);
            const double area =
                area_of_directions(wave.bundle, lens.film_mm(), wave.pupil.sphere.image_mm);
            const double fnumber = 0.5 / std::sqrt(area / std::numbers::pi);
            EXPECT_NEAR(wavefront_figures(wave.pupil).fnumber, fnumber, 0.002 * fnumber)
                << field_deg << " " << nm;
        }
}

// A hole of a micrometre is a pinhole camera: Airy's disc of its f-number, whatever the lens.
TEST(WaveLimits, AnIrisOfAMicrometre) {
    const Lens lens(with_stop_mm(read_lens("takumar-50mm-f1.2"), 5e-4));
    const auto wave = wave_of(lens);
    const WavefrontFigures figures = wavefront_figures(wave.pupil);
    EXPECT_NEAR(figures.strehl, 1, 1e-9);
    const double paraxial = first_order(lens, kLineD_nm).fnumber;
    EXPECT_NEAR(figures.fnumber, paraxial, 0.003 * paraxial);
    EXPECT_NEAR(sum_of_shares(point_spread(wave.pupil, 512)), 1, 0.005);
}

// A mask of 12 x 12 holes: its light is that of the holes, and orders appear where the grating
// equation puts them.
TEST(WaveLimits, AMaskOfManyHolesIsAGrating) {
    constexpr int holes = 12;
    const Lens lens(stigmatic_lens(50, 16));
    const double radius_mm = lens.prescription().surfaces[0].semi_diameter_mm;
    const double side_mm = radius_mm * std::numbers::sqrt2, pitch_mm = side_mm / holes;
    const StopTransmission mask = [&](double x, double y) {
        if (std::max(std::fabs(x), std::fabs(y)) > side_mm / 2) return 0.;
        const auto open = [&](double a) {
            const double place = (a + side_mm / 2) / pitch_mm;
            return place - std::floor(place) > 0.5;
        };
        return open(x) && open(y) ? 1. : 0.;
    };
    const auto wave = wave_of(lens);
    const PupilFunction pupil =
        pupil_function(wave.bundle, wave.pupil.sphere, wave.pupil.grid, mask);
    double light = 0, open = 0;
    for (size_t i = 0; i < pupil.light.size(); ++i)
        light += pupil.light[i], open += wave.pupil.light[i];
    EXPECT_NEAR(light / open, 0.25 * 2 / std::numbers::pi, 0.005);
    const PointSpread spread = point_spread(pupil, 1024);
    // Of a grating of half-open slits the first order has (2 / pi)^2 of the zeroth one's light.
    const double order_mm = pupil.wavelength_mm() * 50 / pitch_mm;
    const auto n = size_t(spread.side);
    const auto middle = size_t(n / 2 * n + n / 2);
    double best = 0, best_mm = 0;
    for (size_t i = n / 2 + size_t(0.6 * order_mm / spread.step_mm);
         i < n / 2 + size_t(1.4 * order_mm / spread.step_mm); ++i)
        if (const double here = spread.share[n / 2 * n + i]; here > best)
            best = here, best_mm = spread.offset_mm(i);
    EXPECT_NEAR(best_mm, order_mm, 0.015 * order_mm);
    EXPECT_NEAR(best / spread.share[middle], 4 / std::pow(std::numbers::pi, 2), 0.02);
}

// The iris of a render: a hexagon.
TEST(WaveLimits, AnIrisOfBladesHasSpikes) {
    const Lens lens(stigmatic_lens(50, 16));
    const double radius_mm = lens.prescription().surfaces[0].semi_diameter_mm;
    const Iris iris(regular_polygon(6, 0), radius_mm, ApertureScale::Inscribed);
    const auto wave = wave_of(lens);
    const PupilFunction pupil =
        pupil_function(wave.bundle, wave.pupil.sphere, wave.pupil.grid, [&](double x, double y) {
            return double(iris.transmits({float(x), float(y)}));
        });
    double light = 0, open = 0;
    for (size_t i = 0; i < pupil.light.size(); ++i)
        light += pupil.light[i], open += wave.pupil.light[i];
    EXPECT_NEAR(light / open, 1.5 * std::sqrt(3.) / std::numbers::pi, 0.003);
    const PointSpread spread = point_spread(pupil, 1024);
    // Light on a ring far out, by direction.
    std::array<double, 12> by_direction{};
    for (size_t cell = 0; cell < spread.share.size(); ++cell) {
        const double x = spread.offset_mm(cell % 1024), y = spread.offset_mm(cell / 1024);
        const double r = std::hypot(x, y) / airy_radius_mm(kLineD_nm, 16);
        if (r < 6 || r > 20) continue;
        const double turn = std::atan2(y, x) / (2 * std::numbers::pi) * 12 + 12.5;
        by_direction[size_t(turn) % 12] += spread.share[cell];
    }
    const double at_first = by_direction[0], beside = by_direction[1];
    for (size_t i = 0; i < 12; ++i)
        EXPECT_NEAR(by_direction[i], i % 2 ? beside : at_first, 0.05 * std::max(at_first, beside));
    EXPECT_GT(std::max(at_first, beside), 4 * std::min(at_first, beside));
}

// A plate has no image: against the sphere about the film's middle its flat wave is out of focus.
TEST(WaveLimits, ParallelRaysAreADefocus) {
    Prescription plate = stigmatic_lens(50, 40);
    plate.surfaces[2].curvature_1_mm = 0;
    plate.surfaces[2].conic = 0;
    const Lens flat(plate);
    const auto wave = wave_of(flat);
    EXPECT_NEAR(wavefront_figures(wave.pupil).rms_mm,
                std::pow(plate.surfaces[0].semi_diameter_mm, 2) / 2 *
                    wave.pupil.sphere.curvature_1_mm / std::sqrt(12.),
                1e-6);
    // Without a sphere no direction differs from another.
    ReferenceSphere plane = wave.pupil.sphere;
    plane.curvature_1_mm = 0;
    EXPECT_FALSE(pupil_grid(wave.bundle, plane));
}

TEST(WaveLimits, ADarkFieldHasNoGrid) {
    // The rear rim lets nothing of the field through.
    Prescription tube = stigmatic_lens(50, 8);
    tube.surfaces[0].thickness_mm = 100;
    const Lens dark(tube);
    const auto field = AimedBundle::aim(dark, {.field_deg = 20}, kLineD_nm);
    ASSERT_TRUE(field);
    EXPECT_FALSE(image_point(*field, dark.film_mm()));
    EXPECT_FALSE(pupil_grid(*field, reference_sphere(*field, dark.film_mm(), {0, 18})));
}

// An exit pupil in the film: the sphere becomes a plane.
TEST(WaveLimits, AnExitPupilMayLieInTheFilm) {
    const auto lens_with = [](double stop_mm) {
        Prescription file = stigmatic_lens(50, 8);
        file.surfaces[0].thickness_mm = stop_mm;
        file.surfaces[1].semi_diameter_mm = file.surfaces[2].semi_diameter_mm = 40;
        return file;
    };
    Prescription file = lens_with(200);
    // A film in the image of the stop is far from the focus.
    file.surfaces[2].thickness_mm = first_order(Lens(file), kLineD_nm).exit_pupil_mm + 1e-3;
    const Lens lens(file);
    const auto bundle = AimedBundle::aim(lens, {}, kLineD_nm);
    const ReferenceSphere sphere = reference_sphere(*bundle, lens.film_mm(), {});
    EXPECT_EQ(sphere.curvature_1_mm, 0);
    const auto wave = wave_of(lens);
    ASSERT_TRUE(wave.pupil.grid.resolves());
    const PointSpread spread = point_spread(wave.pupil, 2 * wave.pupil.grid.side);
    EXPECT_NEAR(sum_of_shares(spread), 1, 0.005);
    const auto rays = bundle->trace(bundle->grid(100), lens.film_mm());
    const double disc_mm = spot_size(rays).rms_mm;  // half of an even disc's light
    EXPECT_NEAR(radii_of_shares_mm({&spread, 1}, std::array{1.}, std::array{0.5})[0], disc_mm,
                0.02 * disc_mm);
}

// Where the wave is bent by many wavelengths, contrast by waves is that by rays.
TEST(WaveLimits, ManyWavesAreRays) {
    const Lens lens(with_stop_mm(read_lens("double-gauss-100mm-f2"), 12));
    const auto wave = wave_of(lens, {.field_deg = 5}, 0.6);
    ASSERT_TRUE(wave.pupil.grid.resolves());
    const auto rays = wave.bundle.trace(wave.bundle.grid(200), wave.pupil.sphere.film_mm);
    const PointSpread spread = point_spread(wave.pupil, 2 * wave.pupil.grid.side);
    for (const Section along : {Section::X, Section::Y}) {
        const LineSpread line = line_spread(spread, along);
        for (const double cycles : {1., 2., 4., 6., 8.}) {
            const std::complex<double> by_waves = transfer(line, cycles);
            EXPECT_NEAR(std::abs(by_waves), geometric_mtf(rays, cycles, along), 0.02) << cycles;
        }
    }
    // The middle of the light is that of the rays.
    double x = 0, y = 0;
    const auto n = size_t(spread.side);
    for (size_t i = 0; i < n * n; ++i) {
        x += spread.share[i] * spread.offset_mm(i % n);
        y += spread.share[i] * spread.offset_mm(i / n);
    }
    const double rms = spot_size(rays).rms_mm;
    EXPECT_NEAR(x, 0, 0.01 * rms);
    EXPECT_NEAR(y, 0, 0.02 * rms);
}

// A wave that is moved is the one that is traced to the other film, off the axis too.
TEST(WaveLimits, MovedWavesAreThoseOfTheOtherFilm) {
    const Lens lens(with_stop_mm(read_lens("takumar-50mm-f1.2"), 5));
    const auto here = wave_of(lens, {.field_deg = 15});
    for (const double shift_mm : {-0.1, 0.06}) {
        const auto there = wave_of(lens, {.field_deg = 15}, shift_mm);
        const PupilFunction by_moving = moved(here.pupil, shift_mm);
        for (size_t k = 0; k < 2; ++k)
            EXPECT_NEAR(by_moving.sphere.image_mm[k], there.pupil.sphere.image_mm[k], 2e-5);
        const double rms = wavefront_figures(there.pupil).rms_mm;
        EXPECT_NEAR(wavefront_figures(by_moving).rms_mm, rms, 0.005 * rms);
        const PointSpread spread = point_spread(by_moving, 1024),
                          wanted = point_spread(there.pupil, 1024);
        for (const Section along : {Section::X, Section::Y}) {
            const LineSpread line = line_spread(spread, along);
            const LineSpread as_traced = line_spread(wanted, along);
            for (const double cycles : {10., 30., 60.})
                EXPECT_LT(std::abs(transfer(line, cycles) - transfer(as_traced, cycles)), 0.01)
                    << shift_mm << ' ' << cycles;
        }
    }
}

// Focus by close rays is Seidel's: -2 f-number^2 (S3 + S4) sagittal and (3 S3 + S4) tangential.
TEST(WaveLimits, FieldCurvatureIsSeidels) {
    for (const char* name :
         {"double-gauss-100mm-f2", "cooke-triplet-50mm-f5", "takumar-50mm-f1.2"}) {
        const Lens lens(read_lens(name));
        constexpr double deg = 1.5;
        const auto bundle = AimedBundle::aim(lens, {.field_deg = deg}, kLineD_nm);
        const FirstOrder first = first_order(lens, kLineD_nm);
        const auto found = field_focus(*bundle, lens.vertex_mm(lens.last()) + first.back_focus_mm);
        ASSERT_TRUE(found);
        const SeidelSums sums = seidel(lens, std::tan(deg * std::numbers::pi / 180)).total;
        const double scale = -2 * first.fnumber * first.fnumber;
        const double sagittal = scale * (sums[2] + sums[3]);
        const double tangential = scale * (3 * sums[2] + sums[3]);
        EXPECT_NEAR(found->sagittal_mm, sagittal, 0.03 * std::fabs(sagittal)) << name;
        EXPECT_NEAR(found->tangential_mm, tangential, 0.05 * std::fabs(sagittal)) << name;
    }
}

TEST(WaveLimits, StoppingDownIsByTheTracedFnumber) {
    const Lens lens(read_lens("takumar-50mm-f1.2"));
    const auto stopped = stopped_down(lens, 8);
    ASSERT_TRUE(stopped);
    EXPECT_NEAR(fnumber_of(Lens(*stopped), stopped->surfaces[size_t(lens.stop())].semi_diameter_mm),
                8, 1e-6);
    EXPECT_NEAR(wavefront_figures(wave_of(Lens(*stopped)).pupil).fnumber, 8, 0.05);
    EXPECT_FALSE(stopped_down(lens, 0.5));
}

// Lenses that nobody would build: each has figures, or nothing.
TEST(WaveLimits, NastyLensesHaveFiniteFiguresOrNone) {
    test::Random random(48);
    int waves = 0;
    for (int i = 0; i < 800; ++i) {
        const std::optional<Lens> lens = test::some_lens(random, i);
        if (!lens) continue;
        const ObjectPoint object{.field_deg = i % 3 ? test::between(random, 0, 100) : 0,
                                 .distance_mm = i % 5 ? INFINITY : 700};
        const auto bundle = AimedBundle::aim(*lens, object, kLineD_nm);
        if (!bundle) continue;
        const auto image_mm = image_point(*bundle, lens->film_mm());
        if (!image_mm) continue;
        const ReferenceSphere sphere = reference_sphere(*bundle, lens->film_mm(), *image_mm);
        const auto grid = pupil_grid(*bundle, sphere);
        if (!grid) continue;
        const PupilFunction pupil = pupil_function(*bundle, sphere, grid->with_side(32));
        double light = 0;
        for (size_t cell = 0; cell < pupil.light.size(); ++cell) {
            ASSERT_TRUE(std::isfinite(pupil.amplitude[cell])) << i;
            ASSERT_TRUE(std::isfinite(pupil.opd_mm[cell])) << i;
            light += pupil.light[cell];
        }
        if (!(light > 0)) continue;
        ++waves;
        const WavefrontFigures figures = wavefront_figures(pupil);
        ASSERT_TRUE(std::isfinite(figures.rms_mm)) << i;
        ASSERT_GE(figures.strehl, 0) << i;
        ASSERT_LE(figures.strehl, 1 + 1e-9) << i;
        for (const double c : zernike_coefficients_mm(pupil, 11))
            ASSERT_TRUE(std::isfinite(c)) << i;
        ASSERT_LE(sum_of_shares(point_spread(pupil, 64)), 1 + 1e-9) << i;
    }
    EXPECT_GT(waves, 60);
}

}  // namespace
}  // namespace petzval::camera
