// SPDX-License-Identifier: Apache-2.0
// The lens furnace: what reaches the film under the same radiance everywhere, against figures that
// were found another way; and rays that must come back to the film point that they left.
//
// Estimates are means of 64 stratified ones, so that their standard errors are known; each must
// agree but for the tolerance that is named.
#include "camera/models/lens_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "camera/lens/paraxial.h"
#include "camera/lens/trace.h"
#include "tests/support/lens_cameras.h"
#include "tests/support/statistics.h"

namespace petzval::camera {
namespace {

using test::four_wavelengths;
using test::led_by;
using test::Mean;
using test::Moments;
using test::read_lens;
using test::read_oracle;

constexpr double kTolerance = 0.002;
const std::string kTakumar = "takumar-50mm-f1.2", kAnamorphic = "schneider-anamorphic-31mm";
/// Filed f-number of the Takumar.
constexpr double kTakumarFNumber = 1.2;

struct Setup {
    ApertureShape shape = Disk{};
    DispersionMode dispersion = DispersionMode::Shared;
    double stop_scale = 1;  ///< of the filed radius
};

LensCameraInput oracle_input(const std::string& name, const Setup& setup = {}) {
    const auto lens = std::make_shared<const Lens>(read_lens(name));
    const double radius =
        lens->prescription().surfaces[size_t(lens->stop())].semi_diameter_mm * setup.stop_scale;
    LensCameraInput in{.lens = lens, .iris = Iris(setup.shape, radius), .to_world = M44f()};
    in.film_mm = read_oracle(name).at("image_plane_z");
    in.entrance_pupil_mm = first_order(*lens, kLineD_nm).entrance_pupil_mm;
    in.dispersion = setup.dispersion;
    return in;
}

/// Irradiance over radiance at a film point, lane by lane.
using Estimate = std::array<Moments, 4>;
Estimate irradiance(const LensCamera& camera, V2f film_mm, const Bands& bands = Bands::rgb(),
                    int side = 24) {
    constexpr int kReplicates = 64;
    Estimate out;
    test::Random random(5);
    const auto stratum = [&](int i) {
        return std::min((float(i) + random.next()) / float(side), kOneMinus);
    };
    for (int k = 0; k < kReplicates; ++k) {
        d4 sum{};
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const float x = stratum(i), y = stratum(j);
                const auto drawn = camera.draw(film_mm, V2f(x, y), led_by(bands, random.next()));
                for (int lane = 0; lane < 4; ++lane) sum[lane] += drawn.weight[lane];
            }
        for (int lane = 0; lane < 4; ++lane) out[size_t(lane)].add(sum[lane] / (side * side));
    }
    return out;
}

/// Within a tolerance, and what chance may add.
testing::AssertionResult agree(const Moments& estimate, const Mean& expected) {
    const Mean off = Mean(estimate) - expected;
    const double tolerance = kTolerance * expected.value;
    if (!(off.error < tolerance))
        return testing::AssertionFailure()
               << "a test without power: " << off.error << " of " << expected.value;
    if (test::agrees(off, 0, tolerance)) return testing::AssertionSuccess();
    return testing::AssertionFailure() << estimate.mean() << " is not " << expected << ", error "
                                       << estimate.mean() / expected.value - 1;
}
testing::AssertionResult agree(const Moments& estimate, double expected) {
    return agree(estimate, Mean(expected, 0));
}

/// Integral of transmission over the direction cosines at a film point, in doubles: points of a
/// lattice, which no straight edge follows, in a box that is narrowed to the pupil and then to the
/// iris. It knows nothing of pupils.
double quadrature(const LensCameraInput& in, V2f film_mm, double nm = kLineD_nm) {
    constexpr double kFirst = 0.7548776662466927, kSecond = 0.5698402909980532;  // Roberts 2018: R2
    const Lens& lens = *in.lens;
    const LensIndices<d4> indices = lens.exact_indices(d4{} + nm);
    const double z = in.film_mm - lens.vertex_mm(lens.last());
    std::array<double, 4> box{-1, 1, -1, 1};
    double sum = 0;
    for (const int side : {120, 120, 120, 400}) {
        const bool whole_pupil = box[1] - box[0] == 2;
        const double size_l = box[1] - box[0], size_m = box[3] - box[2];
        std::array<double, 4> found{1, -1, 1, -1};
        sum = 0;
        for (int i = 0; i < side * side; i += 4) {
            d4 l{}, m{};
            for (int k = 0; k < 4; ++k) {
                l[k] = box[0] + size_l * std::fmod((i + k) * kFirst, 1);
                m[k] = box[2] + size_m * std::fmod((i + k) * kSecond, 1);
            }
            const d4 n2 = 1 - l * l - m * m;
            LensRay<d4> ray;
            ray.counted_from = lens.last();
            ray.origin = {d4{} + film_mm.x, d4{} + film_mm.y, d4{} + z};
            ray.direction = {l, m, -sqrt(n2)};  // NaN misses
            d4 open{};
            const auto at_stop = [&](const LensHit<d4>& hit) {
                if (hit.surface != lens.stop()) return;
                for (int k = 0; k < 4; ++k)
                    open[k] =
                        whole_pupil
                            ? 1
                            : in.iris.transmits({float(hit.point.x[k]), float(hit.point.y[k])});
            };
            const l4 passed = trace_lens<d4>({lens, Towards::Scene, {0, lens.last()}, Clip::Yes},
                                             indices, ray, at_stop);
            for (int k = 0; k < 4; ++k) {
                if (!passed[k] || !(open[k] > 0)) continue;
                sum += open[k] * size_l * size_m / (side * side);
                found = {std::min(found[0], l[k]), std::max(found[1], l[k]),
                         std::min(found[2], m[k]), std::max(found[3], m[k])};
            }
        }
        // Tips of a star are thinner than what lies between the points.
        const double margin_l = 4 * size_l / side, margin_m = 4 * size_m / side;
        box = {found[0] - margin_l, found[1] + margin_l, found[2] - margin_m, found[3] + margin_m};
    }
    return sum;
}

Polygon rotated(Polygon polygon, double degrees) {
    const double c = std::cos(degrees * std::numbers::pi / 180),
                 s = std::sin(degrees * std::numbers::pi / 180);
    for (auto& contour : polygon.contours)
        for (V2d& p : contour) p = {p.x * c - p.y * s, p.x * s + p.y * c};
    return polygon;
}
V2f at_azimuth(double mm, double degrees) {
    return {float(mm * std::cos(degrees * std::numbers::pi / 180)),
            float(mm * std::sin(degrees * std::numbers::pi / 180))};
}

TEST(LensCamera, IrradianceIsTheOracles) {
    for (const std::string name : test::kOracleLenses) {
        const LensCamera camera(oracle_input(name));
        const auto table = read_oracle(name).at("irradiance");
        ASSERT_FALSE(table.empty());
        for (const auto& row : table) {
            const double height = row.at(0), expected = row.at(1);
            EXPECT_TRUE(
                agree(irradiance(camera, V2f(0, float(height)), Bands::rgb(), 32)[0], expected))
                << name << ' ' << height;
        }
    }
}

// Widest ray that passes, by halving; it is round, the film point being on the axis.
TEST(LensCamera, IrradianceOnTheAxisIsPiSineSquared) {
    for (const std::string name : test::kOracleLenses) {
        if (name == kAnamorphic) continue;
        const LensCameraInput in = oracle_input(name);
        const Lens& lens = *in.lens;
        double passes = 0, fails = 1;
        while (fails - passes > 1e-9) {
            const double sine = (passes + fails) / 2;
            LensRay<d4> ray;
            ray.counted_from = lens.last();
            ray.origin.z = d4{} + (in.film_mm - lens.vertex_mm(lens.last()));
            ray.direction = {d4{}, d4{} + sine, d4{} - std::sqrt(1 - sine * sine)};
            const l4 passed = trace_lens<d4>({lens, Towards::Scene, {0, lens.last()}, Clip::Yes},
                                             lens.exact_indices(d4{} + kLineD_nm), ray);
            (passed[0] ? passes : fails) = sine;
        }
        const LensCamera camera(in);
        const double expected = std::numbers::pi * passes * passes;
        EXPECT_TRUE(agree(irradiance(camera, V2f(0.f))[0], expected)) << name;
        EXPECT_NEAR(camera.irradiance(V2f(0.f), 1024), expected, kTolerance * expected) << name;
        if (name == kTakumar) {
            EXPECT_NEAR(expected, 0.5784, 2e-4);
        }
    }
}

TEST(LensCamera, ARoundIrisIsTheSameAtEveryAzimuth) {
    const std::string fisheye = "minolta-fisheye-16mm-f2.8";
    for (const auto& [name, height, scale] :
         {std::tuple(kTakumar, 12., 1.), {kTakumar, 12., 0.4}, {fisheye, 19., 1.}}) {
        const LensCameraInput in = oracle_input(name, {.stop_scale = scale});
        const LensCamera camera(in);
        const double expected = quadrature(in, V2f(0, float(height)));
        for (const double azimuth : {0., 37., 90., 143., 200., 311.})
            EXPECT_TRUE(agree(irradiance(camera, at_azimuth(height, azimuth))[0], expected))
                << name << ' ' << scale << ' ' << azimuth;
    }
}

TEST(LensCamera, OtherShapesAreAsQuadratureSays) {
    const ApertureShape shapes[] = {Disk{}, square(), star(5), regular_polygon(3)};
    for (const std::string& name : {kTakumar, kAnamorphic})
        for (size_t i = 0; i < std::size(shapes); ++i)
            for (const double scale : {1., 0.4}) {
                const LensCameraInput in =
                    oracle_input(name, {.shape = shapes[i], .stop_scale = scale});
                const LensCamera camera(in);
                for (const V2f& film : {V2f(0.f), V2f(-5, 8), V2f(9, -3)})
                    EXPECT_TRUE(agree(irradiance(camera, film)[0], quadrature(in, film)))
                        << name << ' ' << i << ' ' << scale << ' ' << film;
            }
}

TEST(LensCamera, IrisAndFilmPointTurnTogether) {
    const auto turned = [](double degrees) {
        const LensCamera camera(
            oracle_input(kTakumar, {.shape = rotated(star(5), degrees), .stop_scale = 0.5}));
        return irradiance(camera, at_azimuth(14, 20 + degrees))[0];
    };
    const Moments still = turned(0);
    for (const double degrees : {10., 30., 45., 90.})
        EXPECT_TRUE(agree(turned(degrees), still)) << degrees;
}

// The stop is so small that its image moves by a tenth of its size between the wavelengths.
TEST(LensCamera, EachWavelengthHasItsOwnIrradiance) {
    const Bands bands = four_wavelengths();
    for (const std::string& name : {kTakumar, kAnamorphic})
        for (const double scale : {0.5, 0.03})
            for (const ApertureShape& shape : {ApertureShape(Disk{}), ApertureShape(star(5))}) {
                const LensCameraInput in = oracle_input(
                    name,
                    {.shape = shape, .dispersion = DispersionMode::Split, .stop_scale = scale});
                const V2f film(3, 11);
                const Estimate found = irradiance(LensCamera(in), film, bands);
                for (int lane = 0; lane < 4; ++lane)
                    EXPECT_TRUE(agree(found[size_t(lane)], quadrature(in, film, bands.nm[lane])))
                        << name << ' ' << scale << ' ' << bands.nm[lane];
            }
}

TEST(LensCamera, AtF4NearlyAllDrawsPassOnTheAxis) {
    for (const std::string& name : {kTakumar, std::string("double-gauss-100mm-f2")})
        for (const ApertureShape& shape :
             {ApertureShape(Disk{}), ApertureShape(square()), ApertureShape(star(5)),
              ApertureShape(regular_polygon(3)), ApertureShape(rhomboid()),
              ApertureShape(frame())}) {
            const double filed = first_order(Lens(read_lens(name)), kLineD_nm).fnumber;
            const LensCamera camera(oracle_input(
                name,
                {.shape = shape, .dispersion = DispersionMode::Split, .stop_scale = filed / 4}));
            test::Random random(3);
            int passed = 0;
            constexpr int kDraws = 2000;
            for (int i = 0; i < kDraws; ++i) {
                const V2f u = random.next2();
                passed +=
                    all(camera.draw(V2f(0.f), u, led_by(four_wavelengths(), random.next())).weight >
                        0.f);
            }
            EXPECT_GE(passed, 0.9 * kDraws) << name;
        }
}

// A stop so small that a ray cannot be aimed at it still lets through what its area says.
TEST(LensCamera, IrradianceGoesAsTheAreaOfASmallStop) {
    const auto found = [](double scale) {
        const LensCameraInput in = oracle_input(kTakumar, {.stop_scale = scale});
        return irradiance(LensCamera(in), V2f(2, 9))[0].mean() / in.iris.area_mm2();
    };
    const double at_f64 = found(kTakumarFNumber / 64);
    EXPECT_NEAR(found(1e-7), at_f64, kTolerance * at_f64);
}

// Where the lens itself has such a stop, its own tolerance is finer than what floats tell apart.
TEST(LensCamera, RaysReachAStopThatIsFiledAsTiny) {
    const auto found = [](double radius_mm) {
        LensCameraInput in = oracle_input(kTakumar);
        Prescription p = in.lens->prescription();
        p.surfaces[size_t(in.lens->stop())].semi_diameter_mm = radius_mm;
        in.lens = std::make_shared<const Lens>(p);
        in.iris = Iris(Disk{}, radius_mm);
        return irradiance(LensCamera(in), V2f(2, 9))[0].mean() / in.iris.area_mm2();
    };
    const double of_usual = found(0.3);
    for (const double radius_mm : {1e-2, 1e-3, 1e-4})
        EXPECT_NEAR(found(radius_mm), of_usual, kTolerance * of_usual) << radius_mm;
}

TEST(LensCamera, NothingIsNotANumber) {
    for (const std::string& name : {kTakumar, kAnamorphic})
        for (const double scale : {kTakumarFNumber / 64, 1e-7, 1.6, 100.})
            for (const DispersionMode dispersion :
                 {DispersionMode::Shared, DispersionMode::Split}) {
                const LensCamera camera(oracle_input(
                    name, {.shape = star(5), .dispersion = dispersion, .stop_scale = scale}));
                test::Random random(8);
                for (const float reach : {1.f, 20.f, 200.f, 1e6f, 1e30f})
                    for (int i = 0; i < 300; ++i) {
                        const V2f film = (random.next2() - V2f(0.5f)) * reach;
                        V2f u = random.next2();
                        if (i % 2) u = V2f(u.x < 0.5f ? 0 : kOneMinus, u.y < 0.5f ? 0 : kOneMinus);
                        const auto drawn =
                            camera.draw(film, u, led_by(four_wavelengths(), random.next()));
                        for (int lane = 0; lane < 4; ++lane) {
                            ASSERT_TRUE(drawn.weight[lane] >= 0 && drawn.weight[lane] < 1e30f);
                            if (!(drawn.weight[lane] > 0)) continue;
                            ASSERT_TRUE(std::isfinite(drawn.ray.origin.x[lane]) &&
                                        std::isfinite(drawn.ray.origin.y[lane]) &&
                                        std::isfinite(drawn.ray.origin.z[lane]));
                            const auto& d = drawn.ray.direction;
                            ASSERT_NEAR(d.x[lane] * d.x[lane] + d.y[lane] * d.y[lane] +
                                            d.z[lane] * d.z[lane],
                                        1, 1e-4);
                        }
                    }
            }
}

TEST(LensCamera, RaysComeBackToTheFilmPoint) {
    const Bands bands = four_wavelengths();
    const auto doubles = [](f4 a) { return __builtin_convertvector(a, d4); };
    for (const std::string name : test::kOracleLenses) {
        const LensCameraInput in = oracle_input(name, {.dispersion = DispersionMode::Split});
        const LensCamera camera(in);
        const Lens& lens = *in.lens;
        const LensIndices<d4> indices = lens.exact_indices(doubles(bands.nm));
        test::Random random(2);
        int checked = 0;
        for (int i = 0; i < 1000; ++i) {
            const V2f film = (random.next2() - V2f(0.5f)) * 16.f, u = random.next2();
            const auto drawn = camera.draw(film, u, led_by(bands, random.next()));
            LensRay<d4> ray;
            ray.counted_from = drawn.ray.counted_from;
            const auto &o = drawn.ray.origin, &d = drawn.ray.direction;
            ray.origin = {doubles(o.x), doubles(o.y), doubles(o.z)};
            ray.direction = {-doubles(d.x), -doubles(d.y), -doubles(d.z)};
            static_cast<void>(
                trace_lens<d4>({lens, Towards::Film, {0, lens.last()}, Clip::No}, indices, ray));
            const d4 t =
                (in.film_mm - lens.vertex_mm(lens.last()) - ray.origin.z) / ray.direction.z;
            for (int lane = 0; lane < 4; ++lane) {
                if (!(drawn.weight[lane] > 0)) continue;
                ASSERT_NEAR((ray.origin.x + t * ray.direction.x)[lane], film.x, 1e-3) << name;
                ASSERT_NEAR((ray.origin.y + t * ray.direction.y)[lane], film.y, 1e-3) << name;
                ++checked;
            }
        }
        EXPECT_GT(checked, 1000) << name;
    }
}

TEST(RayAimer, RaysMeetTheStopWhereTheyShould) {
    const f4 nm = four_wavelengths().nm;
    for (const std::string name : test::kOracleLenses) {
        const LensCameraInput in = oracle_input(name);
        const Lens& lens = *in.lens;
        const RayAimer aimer(lens, in.film_mm, 21.6);
        const auto radius =
            float(lens.prescription().surfaces[size_t(lens.stop())].semi_diameter_mm);
        test::Random random(4);
        int solved = 0;
        for (int i = 0; i < 1000; ++i) {
            const V2f film = (random.next2() - V2f(0.5f)) * 24.f;
            const V2f aim = uniform_disk(random.next2()) * radius;
            const int lane = i % 4;
            const f8 led = splat8(nm[lane]);
            const FoundRays c =
                aimer.aim(PlanePoint<f8>(film), PlanePoint<f8>(aim), lens.indices(led), led);
            if (!c.found[0]) continue;
            ++solved;
            const double l = c.l[0], m = c.m[0];
            LensRay<d4> ray;
            ray.counted_from = lens.last();
            ray.origin = {d4{} + film.x, d4{} + film.y,
                          d4{} + (in.film_mm - lens.vertex_mm(lens.last()))};
            ray.direction = {d4{} + l, d4{} + m, d4{} - std::sqrt(1 - l * l - m * m)};
            static_cast<void>(
                trace_lens<d4>({lens, Towards::Scene, {lens.stop(), lens.last()}, Clip::No},
                               lens.exact_indices(d4{} + nm[lane]), ray));
            ASSERT_LE(std::hypot(ray.origin.x[0] - aim.x, ray.origin.y[0] - aim.y), 1.1e-4 * radius)
                << name;
        }
        EXPECT_GT(solved, 950) << name;
    }
}

}  // namespace
}  // namespace petzval::camera
