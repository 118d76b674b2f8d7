// SPDX-License-Identifier: Apache-2.0
#include "camera/models/natural_vignetting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "camera/models/aberrated_lens.h"
#include "camera/models/thin_lens.h"
#include "camera/models/thin_lens_optics.h"

namespace petzval::camera {
namespace {

constexpr double kThinFocal_mm = 50, kThinFocus_m = 1;
const double kFilm_mm = image_distance_mm(kThinFocal_mm, 1e3 * kThinFocus_m);

// Share of an even scene's radiance times pi that a film point off the axis gets from a round stop:
// Foote 1915, the illumination of an element parallel to a disk.
double foote(double radius_mm, double distance_mm, double off_axis_mm) {
    const double h2 = distance_mm * distance_mm, r2 = off_axis_mm * off_axis_mm;
    const double a2 = radius_mm * radius_mm, sum = h2 + r2 + a2;
    return 0.5 * (1 - (h2 + r2 - a2) / std::sqrt(sum * sum - 4 * r2 * a2));
}

Glass index_of_bk7() {  // Schott's catalogue of 2023
    return {"N-BK7", Sellmeier{{{1.03961212, 0.00600069867},
                                {0.231792344, 0.0200179144},
                                {1.01046945, 103.560653}}}};
}

// Mean weight of a film point, from 4,096 points of the stop.
double mean_weight(const Camera& camera, V2f film, const Bands& bands = Bands::rgb()) {
    constexpr uint32_t n = 4096;
    double sum = 0;
    for (uint32_t i = 0; i < n; ++i)
        for (const CameraPath& path :
             camera.sample({film, Sampler(SamplerKind::Owen, 3, {1, 2, i})}, bands))
            sum += hsum(path.weight) / double(lane_count(bands.on));
    return sum / n;
}

// Film points from the middle to a corner of a wide film, and their heights on it.
constexpr float kYfov_rad = 1.2f, kAspect = 1.5f;
const V2f kFilms[] = {{0.5f, 0.5f}, {0.5f, 0.1f}, {0.9f, 0.5f}, {0.f, 0.f}, {0.999f, 0.999f}};
double height_mm(V2f film) {
    const double half = std::tan(kYfov_rad / 2);
    return std::hypot((2 * film.x - 1) * half * kAspect, (1 - 2 * film.y) * half) * kFilm_mm;
}

TEST(NaturalVignetting, OfAPinholeIsCosToTheFourth) {
    ThinLens pinhole;
    pinhole.yfov_rad = kYfov_rad;
    pinhole.aspect = kAspect;
    const double plain = mean_weight(ThinLensCamera(pinhole), {0.f, 0.f});
    EXPECT_EQ(plain, 1.);
    pinhole.vignetting = NaturalVignetting();
    const ThinLensCamera camera(pinhole);
    for (const V2f& film : kFilms)
        EXPECT_NEAR(mean_weight(camera, film),
                    std::pow(std::cos(std::atan(height_mm(film) / kFilm_mm)), 4), 1e-5);
}

TEST(NaturalVignetting, OfThinLensAndSingletIsFootes) {
    for (const double fnumber : {1., 1.4, 2.8, 22.}) {
        const double radius_mm = kThinFocal_mm / (2 * fnumber);
        const NaturalVignetting vignetting(kFilm_mm,
                                           NaturalVignetting::axial_mean(radius_mm, kFilm_mm));
        ThinLens thin;
        thin.yfov_rad = kYfov_rad;
        thin.aspect = kAspect;
        thin.focus_m = kThinFocus_m;
        thin.iris = Iris(Disk{}, radius_mm);
        thin.exposure = 3;
        thin.vignetting = vignetting;
        std::vector<std::unique_ptr<Camera>> cameras;
        cameras.push_back(std::make_unique<ThinLensCamera>(thin));
        if (fnumber > 2) {
            AberratedLens glass{thin.to_world, Singlet::bent(index_of_bk7(), kThinFocal_mm, 0.7),
                                *thin.iris,    kThinFocus_m,
                                kYfov_rad,     kAspect};
            glass.exposure = 3;
            glass.vignetting = vignetting;
            cameras.push_back(std::make_unique<AberratedLensCamera>(std::move(glass)));
        }
        const double axial = foote(radius_mm, kFilm_mm, 0);
        for (const auto& camera : cameras)
            for (const V2f& film : kFilms) {
                const double expected = 3 * foote(radius_mm, kFilm_mm, height_mm(film)) / axial;
                EXPECT_NEAR(mean_weight(*camera, film) / expected, 1, 3e-4)
                    << "f/" << fnumber << " at " << height_mm(film) << " mm";
            }
    }
}

TEST(NaturalVignetting, AxialMeanOfADiskIsItsClosedForm) {
    for (const double radius_mm : {1., 12.5, 40.})
        EXPECT_NEAR(NaturalVignetting::axial_mean(Iris(Disk{}, radius_mm), kFilm_mm),
                    NaturalVignetting::axial_mean(radius_mm, kFilm_mm), 1e-4);
}

// A ray from the film's right half that crosses the stop's left half (as seen) is more oblique than
// one through its right half: the blur of a corner is brighter on one side.
TEST(NaturalVignetting, CountsEachRaysOwnAngle) {
    const NaturalVignetting vignetting(50, 1);
    EXPECT_LT(vignetting.factor({0.5f, 0.f}, {10.f, 0.f}),
              vignetting.factor({0.5f, 0.f}, {-10.f, 0.f}));
    const double tangent = 0.5 + 10. / 50;
    EXPECT_NEAR(vignetting.factor({0.5f, 0.f}, {10.f, 0.f}),
                std::pow(std::cos(std::atan(tangent)), 4), 1e-6);
}

// A hero ray weighs each lane by the fall-off where that lane lands.
TEST(NaturalVignetting, HasTheSameMeanInEachWayToCarryWavelengths) {
    Bands bands = Bands::rgb();
    bands.nm = f4{430.f, 520.f, 590.f, 680.f};
    bands.on = m4{-1, -1, -1, -1};
    bands.spectral = true;
    const double radius_mm = kThinFocal_mm / (2 * 2.8);
    const auto camera = [&](DispersionMode mode) {
        AberratedLens glass{M44f(),
                            Singlet::bent(index_of_bk7(), kThinFocal_mm, 0.7),
                            Iris(Disk{}, radius_mm),
                            kThinFocus_m,
                            kYfov_rad,
                            kAspect};
        glass.dispersion = mode;
        glass.vignetting =
            NaturalVignetting(kFilm_mm, NaturalVignetting::axial_mean(radius_mm, kFilm_mm));
        return std::make_unique<AberratedLensCamera>(std::move(glass));
    };
    const Filter box{FilterKind::Box, 0.5f};
    const auto mean = [&](DispersionMode mode) {
        const auto lens = camera(mode);
        constexpr uint32_t n = 1u << 14;
        double sum = 0;
        for (uint32_t i = 0; i < n; ++i) {
            const Sampler sampler(SamplerKind::Owen, 3, {1, 2, i});
            const V2f offset = box.sample(sampler.get2(Dim::Film)), size(60, 40);
            const FilmPoint at{(V2f(3.5f, 3.5f) + offset) / size, sampler, {&box, offset, size}};
            for (const CameraPath& path : lens->sample(at, bands)) sum += hsum(path.weight) / 4;
        }
        return sum / n;
    };
    EXPECT_NEAR(mean(DispersionMode::Hero) / mean(DispersionMode::Split), 1, 5e-3);
}

}  // namespace
}  // namespace petzval::camera
