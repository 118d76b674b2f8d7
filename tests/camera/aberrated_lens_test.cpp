// SPDX-License-Identifier: Apache-2.0
#include "camera/models/aberrated_lens.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

namespace petzval::camera {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

Glass n_sf11() {  // Schott's catalogue of 2023
    return {"N-SF11",
            Sellmeier{
                {{1.73759695, 0.013188707}, {0.313747346, 0.0623068142}, {1.89878101, 155.23629}}}};
}
Glass glass_of_index(double n) {
    return {"constant", IndexTable{{{587, n}}}};
}

Bands wavelengths(f4 nm) {
    Bands bands = Bands::rgb();
    bands.nm = nm;
    bands.on = m4{-1, -1, -1, -1};
    bands.spectral = true;
    return bands;
}
const f4 kLines{486.1327f, 546.074f, 587.5618f, 656.2725f};

FilmPoint film_point(V2f film, uint32_t index) {
    return {film, Sampler(SamplerKind::Owen, 7, {3, 4, index})};
}

// A ray of the camera's space as a straight line over the distance ahead of the lens.
struct StraightLine {
    V2f start, slope;  // m, and m a metre
    explicit StraightLine(const Ray& ray)
        : start(ray.origin.x, ray.origin.y),
          slope(V2f(ray.direction.x, ray.direction.y) / -ray.direction.z) {}
};

// Where on the film, in mm from its centre towards the stop point of the ray, ends the light that
// comes through that stop point from z_m on the axis? To aim the ray there, its slope must change
// by as much as the slope through the lens's centre does, and the film stands upside down.
double landing_mm(const StraightLine& from_centre, double film_mm, double z_m) {
    const double h = from_centre.start.length();
    const double slope = from_centre.start.dot(from_centre.slope) / h;
    return (h / z_m + slope) * film_mm;
}

AberratedLens plain(Glass glass, double q, double radius_mm, double focus_m) {
    return {look_at({0, 0, 0}, {0, 0, -1}),
            Singlet::bent(std::move(glass), 50, q),
            Iris(Disk{}, radius_mm),
            focus_m,
            0.4f,
            1.5f};
}

TEST(AberratedLens, FilmAndPoseAreThoseOfTheThinLens) {
    const M44f pose = look_at({1, 2, 3}, {-2, 1, -4});
    AberratedLens lens = plain(glass_of_index(1.5), 0.7, 0.2, 2);
    lens.to_world = pose;
    const AberratedLensCamera aberrated(lens);
    const ThinLensCamera ideal({pose, 0.4f, 1.5f, Iris(Disk{}, 0.2), 2});
    for (uint32_t i = 0; i < 64; ++i) {
        const FilmPoint point = film_point({(i % 8) / 7.f, (i / 8) / 7.f}, i);
        const CameraSample a = aberrated.sample(point, Bands::rgb());
        const CameraSample b = ideal.sample(point, Bands::rgb());
        ASSERT_EQ(a.size(), 1u);
        EXPECT_LT((a[0].ray.origin - b[0].ray.origin).length(), 1e-6f);
        EXPECT_LT((a[0].ray.direction - b[0].ray.direction).length(), 1e-6f);
        for (int lane = 0; lane < 4; ++lane) {
            EXPECT_EQ(a[0].weight[lane], b[0].weight[lane]);
            EXPECT_EQ(a[0].lanes[lane], b[0].lanes[lane]);
        }
    }
    EXPECT_NEAR(aberrated.film_distance_mm(), image_distance_mm(50, 2000), 1e-9);
}

// What is in focus is a plane: near the axis of the lens, all rays of a film point meet there.
TEST(AberratedLens, FocusIsAPlane) {
    const AberratedLensCamera camera(plain(glass_of_index(1.5), 0.7, 0.5, 2));
    for (const V2f& film : {V2f(0, 0), V2f(0.9f, 0.3f)})
        for (uint32_t i = 0; i < 16; ++i) {
            const StraightLine line(camera.sample(film_point(film, i), Bands::rgb())[0].ray);
            const V2f met = line.start + line.slope * 2;
            EXPECT_NEAR(met.x, (2 * film.x - 1) * std::tan(0.2) * 1.5 * 2, 2e-6);
            EXPECT_NEAR(met.y, (1 - 2 * film.y) * std::tan(0.2) * 2, 2e-6);
        }
}

// Diameter on the film of the blur of a point at z_mm, for a stop of that diameter and a lens
// focused at S: diameter S' |1/S - 1/z|, by similar triangles from the stop to the film (Potmesil
// and Chakravarty 1982, "Synthetic Image Generation with a Lens and Aperture Camera Model").
double blur_diameter_mm(double focal_mm, double stop_diameter_mm, double object_mm, double z_mm) {
    return stop_diameter_mm * image_distance_mm(focal_mm, object_mm) *
           std::fabs(1 / object_mm - 1 / z_mm);
}

// The blur of a point on the axis, from the rays that the cameras draw, against the closed form,
// which knows no aberrations: hence the narrow stop of the camera that has them.
TEST(AberratedLens, BlurIsTheCircleOfConfusion) {
    const AberratedLensCamera aberrated(plain(glass_of_index(1.5), 5. / 7, 0.1, 2));
    const ThinLensCamera ideal({look_at({0, 0, 0}, {0, 0, -1}), 0.4f, 1.5f, Iris(Disk{}, 10), 2});
    const auto expect_blur = [&](const Camera& camera, double radius_mm, double z_m) {
        double widest = 0, square = 0;
        const int rays = 4096;
        for (uint32_t i = 0; i < rays; ++i) {
            const StraightLine line(
                camera.sample(film_point({0.5f, 0.5f}, i), Bands::rgb())[0].ray);
            const double mm = landing_mm(line, aberrated.film_distance_mm(), z_m);
            widest = std::max(widest, std::fabs(mm));
            square += mm * mm / rays;
        }
        const double expected = blur_diameter_mm(50, 2 * radius_mm, 2000, z_m * 1e3);
        EXPECT_NEAR(2 * widest / expected, 1, 0.01) << z_m;
        // Over an evenly lit disk the mean square of the radius is half the rim's.
        EXPECT_NEAR(std::sqrt(8 * square) / expected, 1, 0.01) << z_m;
    };
    for (const double z_m : {0.3, 1., 1.8, 2.2, 5., 1e9}) {
        expect_blur(aberrated, 0.1, z_m);
        expect_blur(ideal, 10, z_m);
    }
}

// Rays leave through the shape, upright and not mirrored, all over it.
TEST(AberratedLens, IrisShapesTheBundle) {
    const Iris iris(regular_polygon(3, 20), 8);
    AberratedLens lens = plain(glass_of_index(1.5), 0.5, 8, 2);
    lens.iris = iris;
    const AberratedLensCamera aberrated(lens);
    const ThinLensCamera ideal({look_at({0, 0, 0}, {0, 0, -1}), 0.4f, 1.5f, iris, 2});
    const auto expect_shape = [&](const Camera& camera) {
        V2f lowest(100), highest(-100);
        for (uint32_t i = 0; i < 4096; ++i) {
            const V3f from = camera.sample(film_point({0.5f, 0.5f}, i), Bands::rgb())[0].ray.origin;
            // A little smaller, as points on the very edge may fall on either side of it.
            const V2f mm = V2f(from.x, from.y) * 999.9f;
            EXPECT_EQ(iris.transmits(mm), 1) << mm.x << ' ' << mm.y;
            lowest = V2f(std::fmin(lowest.x, mm.x), std::fmin(lowest.y, mm.y));
            highest = V2f(std::fmax(highest.x, mm.x), std::fmax(highest.y, mm.y));
        }
        // Tips at 110, 230 and 350 degrees; of the area of a disk of 8 mm.
        const double r = 8 * std::sqrt(std::numbers::pi * 4 / (3 * std::sqrt(3.)));
        EXPECT_NEAR(highest.y, r * std::sin(110 * std::numbers::pi / 180), 0.3);
        EXPECT_NEAR(lowest.y, r * std::sin(230 * std::numbers::pi / 180), 0.3);
        EXPECT_NEAR(highest.x, r * std::cos(350 * std::numbers::pi / 180), 0.3);
        EXPECT_NEAR(lowest.x, r * std::cos(230 * std::numbers::pi / 180), 0.3);
    };
    expect_shape(aberrated);
    expect_shape(ideal);
}

// A point at the distance in focus, traced to the axis behind the lens at several h and lambda.
TEST(AberratedLens, AxisCrossingsShowTheFormulasAberration) {
    for (const double focus_m : {0.1, 0.4, kInf})
        for (const double q : {-1., 0., 5. / 7}) {
            const double s_mm = focus_m * 1e3;
            const AberratedLens lens = plain(n_sf11(), q, 5, focus_m);
            const AberratedLensCamera camera(lens);
            const double film_mm = camera.film_distance_mm();
            int seen = 0;
            for (uint32_t i = 0; i < 64; ++i) {
                const CameraSample rays =
                    camera.sample(film_point({0.5f, 0.5f}, i), wavelengths(kLines));
                ASSERT_EQ(rays.size(), 4u);
                for (int k = 0; k < 4; ++k) {
                    const StraightLine line(rays[k].ray);
                    const double h_mm = line.start.length() * 1e3;
                    if (h_mm < 0.5) continue;  // too little to measure in floats
                    const SingletOptics optics = lens.singlet.at(double(kLines[k]));
                    const double x_mm = landing_mm(line, film_mm, focus_m);
                    // The ray behind the lens goes from h at the lens to x on the film.
                    const double crossing_mm = film_mm * h_mm / (h_mm - x_mm);
                    const double image_mm = image_distance_mm(optics.focal_mm, s_mm);
                    const double aberration = spherical_aberration_mm(optics, s_mm, h_mm);
                    EXPECT_NEAR(crossing_mm, image_mm - aberration, 2e-5 * image_mm)
                        << focus_m << ' ' << q << ' ' << h_mm << ' ' << k;
                    if (h_mm < 2.5) {  // h = f / 20: the first-order law, and Snell's
                        const double law = std::pow(image_mm / optics.focal_mm, 2) *
                                           spherical_coefficient_per_mm(optics, s_mm) * h_mm *
                                           h_mm / 2;
                        EXPECT_NEAR(image_mm - crossing_mm, law, 0.02 * law + 2e-5 * image_mm);
                        EXPECT_NEAR(image_mm - crossing_mm,
                                    *traced_spherical_aberration_mm(optics, s_mm, h_mm),
                                    0.01 * law + 2e-5 * image_mm);
                    }
                    ++seen;
                }
            }
            EXPECT_GT(seen, 200);
        }
}

TEST(AberratedLens, WavelengthsPartOnlyWhereTheyDiffer) {
    const AberratedLensCamera dispersing(plain(n_sf11(), 0.5, 5, 1));
    const CameraSample parted = dispersing.sample(film_point({0.3f, 0.3f}, 1), wavelengths(kLines));
    ASSERT_EQ(parted.size(), 4u);
    for (int k = 0; k < 4; ++k)
        for (int lane = 0; lane < 4; ++lane) {
            EXPECT_EQ(parted[k].lanes[lane], k == lane ? -1 : 0);
            EXPECT_EQ(parted[k].weight[lane], k == lane ? 1 : 0);
        }
    const auto count = [](const Camera& camera, const Bands& bands) {
        return camera.sample(film_point({0.3f, 0.3f}, 1), bands).size();
    };
    EXPECT_EQ(count(dispersing, Bands::rgb()), 1);
    AberratedLens shared = plain(n_sf11(), 0.5, 5, 1);
    shared.dispersion = DispersionMode::Shared;
    EXPECT_EQ(count(AberratedLensCamera(shared), wavelengths(kLines)), 1);
    Bands one = wavelengths(kLines);
    one.on = m4{0, -1, 0, 0};
    EXPECT_EQ(count(dispersing, one), 1);
}

TEST(AberratedLens, RefusesWhatItCannotImage) {
    const auto refusal = [](Glass glass, double q, double radius_mm,
                            double focus_m) -> std::string {
        try {
            (void)AberratedLensCamera(plain(std::move(glass), q, radius_mm, focus_m));
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(refusal(glass_of_index(1.5), 0, 5, 0.05).find("focal length"), std::string::npos);
    EXPECT_NE(refusal(glass_of_index(1.5), 0, -1, 1).find("radius"), std::string::npos);
    EXPECT_NE(refusal(glass_of_index(1.5), 0, NAN, 1).find("radius"), std::string::npos);
    EXPECT_NE(refusal(glass_of_index(1.5), 0, 5, NAN).find("object distance"), std::string::npos);
    EXPECT_NE(refusal(glass_of_index(1.5), 0, 51, 1).find("too wide"), std::string::npos);
    EXPECT_NE(refusal(glass_of_index(1.5), 20, 3, 1).find("too wide"), std::string::npos);
    EXPECT_NE(refusal(glass_of_index(1.5), -1.5, 25, 1).find("too wide"), std::string::npos);
    // Past a surface's edge though f(h) is above f/2; f(h) below f/2 though within the surfaces.
    EXPECT_NE(refusal(glass_of_index(1.5), 5. / 7, 31, 1).find("too wide"), std::string::npos);
    EXPECT_NE(refusal(glass_of_index(4), 0, 50, 1).find("too wide"), std::string::npos);
    const Glass fades{"fades", IndexTable{{{400, 1.5}, {800, 1.0}}}};
    EXPECT_NE(refusal(fades, 0, 5, 1).find("gather"), std::string::npos);
}

// No NaN at any edge of what is allowed, over the film and beyond.
TEST(AberratedLens, RaysAreAlwaysNumbers) {
    const Glass gap{
        "gap",
        IndexTable{
            {{360, 1.5}, {546, 1.5}, {546.05, 1.0}, {546.1, 1.0}, {546.2, 1.5}, {830, 1.5}}}};
    for (const AberratedLens& lens :
         {plain(n_sf11(), 0, 1e-9, kInf), plain(n_sf11(), 0, 10, kInf),
          plain(n_sf11(), 2, 10, 0.0501), plain(glass_of_index(1 + 1e-6), 0, 1e-6, 1),
          plain(n_sf11(), 1e6, 1e-6, 1), plain(gap, 0, 5, 1)}) {
        const AberratedLensCamera camera(lens);
        for (uint32_t i = 0; i < 64; ++i) {
            const CameraSample rays =
                camera.sample(film_point({(i % 8) / 6.f, (i / 8) / 6.f}, i), wavelengths(kLines));
            EXPECT_GE(rays.size(), 1u);
            for (size_t k = 0; k < rays.size(); ++k) {
                EXPECT_NEAR(rays[k].ray.direction.length(), 1, 1e-5);
                EXPECT_TRUE(std::isfinite(rays[k].ray.origin.length()));
            }
        }
    }
    const CameraSample rays =
        AberratedLensCamera(plain(gap, 0, 5, 1)).sample(film_point({0, 0}, 1), wavelengths(kLines));
    ASSERT_EQ(rays.size(), 3u) << "where there is no lens there is no ray";
    for (size_t k = 0; k < rays.size(); ++k) EXPECT_EQ(rays[k].lanes[1], 0);
}

}  // namespace
}  // namespace petzval::camera
