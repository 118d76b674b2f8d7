// SPDX-License-Identifier: Apache-2.0
// Rays to targets: whatever the targets are, the mean is that of ordinary rays.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "camera/models/aberrated_lens.h"
#include "camera/models/thin_lens.h"
#include "camera/targets/make_target_camera.h"
#include "core/spectrum/observer.h"
#include "tests/support/lens_cameras.h"
#include "tests/support/observers.h"
#include "tests/support/targets.h"

namespace petzval::camera {
namespace {

using test::Mean;
using test::PixelLight;

const M44f kPose = look_at(V3f(0.1f, 0.2f, 0.3f), V3f(0.3f, 0.1f, -2));
const V2i kFrame_px(320, 200);
/// Of rays to targets, which are noisy less, and of ordinary ones alone, which are cheap.
constexpr uint32_t kSamples = 2048, kOrdinary = 1 << 17;

/// A lamp on a ray of a film point.
struct TestLamp {
    V2f film;
    float distance_m, radius_m;
    bool pays;          ///< it is much smaller than the circle of confusion
    uint32_t draw = 1;  ///< number of the draw whose ray it lies on
};

/// Light of a lamp before a soft background, in the pixel of its film point.
PixelLight light(const TargetCamera& camera, const Observer& observer, const TestLamp& lamp,
                 const V3f& at, const TargetCell& cell, uint32_t seed, uint32_t samples) {
    const Filter filter(FilterKind::Box, 0.5f);
    return test::light_of(
        camera, cell, {&filter, V2f(kFrame_px), lamp.film}, seed, samples,
        [&](const Sampler& sampler) {
            return observer.spectral() ? observer.draw(sampler.get1(Dim::Wavelength))
                                       : Bands::rgb();
        },
        [&](const Ray& ray) {
            return (test::passes(ray, at, lamp.radius_m) ? 300.f : 0.f) + 1 + ray.direction.x;
        });
}

/// Targets of the right place and size, and wrong ones: the mean must be the same with all, with
/// so many rays of a sample to its targets.
void expect_same_mean(const TargetCamera& camera, const Observer& observer, const TestLamp& lamp,
                      uint32_t rays = 1) {
    const Ray ray = test::ray_of(camera, lamp.film, lamp.draw);
    const V3f at = ray.origin + lamp.distance_m * ray.direction, axis = ray.direction;
    const float radius = lamp.radius_m;
    const auto ball = [&](const V3f& beside, float radius_m) {
        return Target{at + beside, radius_m, false};
    };
    const V3f beside = unit(axis.cross(V3f(0, 1, 0))) * (0.75f * radius);
    const std::vector<std::vector<Target>> cases{
        {ball(V3f(0.f), radius)},
        {ball(V3f(0.f), radius / 3)},
        {ball(V3f(0.f), radius * 5)},
        // Together they hold all of the lamp: what they left out, few ordinary rays would find.
        {ball(beside, 1.8f * radius), ball(-beside, radius / 2),
         ball(beside + axis * 0.1f, 1.8f * radius)},
        {{axis, 0.003f, true}, ball(beside * 9.f, radius)}};
    const test::Moments ordinary = light(camera, observer, lamp, at, {}, 3, kOrdinary).light;
    double least = INFINITY;
    for (size_t i = 0; i < cases.size(); ++i) {
        TargetCell cell =
            test::listed_in(camera, test::cell_about(lamp.film, kFrame_px), kFrame_px, cases[i]);
        cell.rays = rays;
        ASSERT_TRUE(cell.map);
        EXPECT_FALSE(i < 4 && cell.empty()) << "targets " << i;
        const PixelLight found = light(camera, observer, lamp, at, cell, 4, kSamples);
        EXPECT_TRUE(test::agrees(Mean(found.light) - Mean(ordinary), 0))
            << "targets " << i << ", lamp at " << lamp.distance_m << " m: " << Mean(found.light)
            << ", " << Mean(ordinary);
        EXPECT_TRUE(i > 0 || found.sent > 0);
        least = std::min(least, found.light.variance());
    }
    if (lamp.pays) {
        EXPECT_LT(least, ordinary.variance() / 9)
            << "the right target pays, lamp at " << lamp.distance_m;
    }
}

std::shared_ptr<const ThinLensCamera> thin_lens() {
    ThinLens lens{kPose, 0.5f, 1.6f, Iris(ApertureShape(), 20), 1.f};
    lens.vignetting.emplace(50, 1);
    return std::make_shared<ThinLensCamera>(lens);
}

TEST(Targets, ThinLensKeepsItsMean) {
    for (const float distance_m : {0.6f, 4.f})
        for (const uint32_t rays : {1u, TargetCell::kMostRays})
            expect_same_mean(*target_camera(thin_lens()), Observer(),
                             {V2f(0.5f), distance_m, 0.004f, distance_m > 1}, rays);
}

// Strongly aberrated, so that the pencil folds near its caustic, with each way of wavelengths.
TEST(Targets, SingletKeepsItsMean) {
    const Glass glass{"crown", IndexTable{{{400, 1.53}, {587, 1.517}, {700, 1.513}}}};
    for (const auto mode : {DispersionMode::Shared, DispersionMode::Split, DispersionMode::Hero})
        for (const float distance_m : {0.7f, 0.9f, 3.f}) {
            AberratedLens lens{
                kPose, Singlet::bent(glass, 50, 0.8), Iris(ApertureShape(), 9), 1, 0.5f, 1.6f,
                mode};
            const auto camera = target_camera(std::make_shared<AberratedLensCamera>(lens));
            SCOPED_TRACE(int(mode));
            expect_same_mean(*camera, test::plain_observer(),
                             {V2f(0.5f), distance_m, 0.001f, distance_m > 1},
                             distance_m > 1 ? TargetCell::kMostRays : 1);
        }
}

// As many rays are sent to a target and get there as the density says of the ordinary rays that
// pass it: beside caustics, at them, and where the pupil itself folds.
TEST(Targets, DensitiesOfTracedLensesAreThoseOfTheDraws) {
    struct Case {
        const char* lens;
        V2f film;
        float distance_m, radius_m;
        uint32_t draw;
        uint32_t rays = 1;
    };
    const V2f middle(0.5f), corner(0.12f, 0.9f);
    const std::vector<Case> cases{{"takumar-50mm-f1.2", middle, 3, 0.016f, 1},
                                  {"takumar-50mm-f1.2", middle, 3, 0.016f, 3, 3},
                                  {"takumar-50mm-f1.2", corner, 1, 0.016f, 1},
                                  {"double-gauss-100mm-f2", corner, 20, 0.02f, 1},
                                  {"double-gauss-100mm-f2", middle, 3, 0.01f, 1, 4},
                                  {"double-gauss-100mm-f2", middle, 3, 1e4f, 1},
                                  {"minolta-fisheye-16mm-f2.8", corner, 0.3f, 0.002f, 1},
                                  {"schneider-anamorphic-31mm", V2f(0.06f, 0.95f), 0.7f, 0.01f, 1}};
    const Filter filter(FilterKind::Box, 0.5f);
    for (const Case& c : cases) {
        const auto camera = target_camera(
            std::make_shared<LensCamera>(test::input_of(c.lens, DispersionMode::Shared)));
        const Ray ray = test::ray_of(*camera, c.film, c.draw);
        const Target target = c.radius_m > 1e3f
                                  ? Target{ray.direction, 0.004f, true}
                                  : Target{ray.origin + ray.direction * c.distance_m, c.radius_m};
        TargetCell cell =
            test::listed_in(*camera, test::cell_about(c.film, kFrame_px), kFrame_px, {target});
        ASSERT_FALSE(cell.empty()) << c.lens << ' ' << c.distance_m;
        cell.rays = c.rays;
        const TargetCell* const of_point = &cell;
        const test::Pixel pixel{&filter, V2f(kFrame_px), c.film};
        test::Moments expected, found;
        const Bands bands = Bands::rgb();
        for (uint32_t i = 0; i < 8192; ++i) {
            const FilmPoint at = pixel.draw(Sampler(SamplerKind::Independent, 4, {0, 0, i}));
            CameraSample ordinary, sent;
            camera->sample_beside({&at, 1}, {&bands, 1}, {&of_point, 1}, {&ordinary, 1});
            // The share is p / (p + q), with the densities p of ordinary rays and q.
            const double share = ordinary.empty() ? 1 : double(ordinary[0].mis_weight);
            expected.add((1 - share) / share);
            camera->sample_targets({&at, 1}, {&bands, 1}, {&of_point, 1}, {&sent, 1});
            found.add(double(sent.size()));
        }
        EXPECT_TRUE(test::agrees(Mean(expected) - Mean(found), 0))
            << c.lens << ' ' << c.distance_m << ": " << Mean(expected) << ", " << Mean(found);
        EXPECT_LT(expected.standard_error(), 0.05 * found.mean()) << c.lens << ' ' << c.distance_m;
        EXPECT_GT(found.mean(), 0.1 * c.rays) << c.lens << ' ' << c.distance_m;
    }
}

using enum DispersionMode;
const V2f kMiddle(0.5f), kCorner(0.12f, 0.9f);
constexpr auto kFloat = Precision::Float, kDouble = Precision::Double;

/// A traced lens, a lamp, and how many rays of a sample its targets get.
struct LensCase {
    const char* lens;
    DispersionMode mode;
    Precision precision;
    TestLamp lamp;
    uint32_t rays = 1;
};
void expect_same_means(const std::vector<LensCase>& cases) {
    for (const LensCase& c : cases) {
        SCOPED_TRACE(testing::Message() << c.lens << ' ' << int(c.mode));
        LensCameraInput in = test::input_of(c.lens, c.mode);
        in.precision = c.precision;
        const auto camera = target_camera(std::make_shared<LensCamera>(in));
        expect_same_mean(*camera, test::plain_observer(), c.lamp, c.rays);
    }
}

TEST(Targets, TracedLensesKeepTheirMean) {
    const TestLamp near{kMiddle, 3, 0.002f, true}, aside{kCorner, 3, 0.002f, true};
    const char* const takumar = "takumar-50mm-f1.2";
    expect_same_means({{takumar, Shared, kFloat, near, 4},
                       {takumar, Split, kFloat, aside, 4},
                       {takumar, Hero, kFloat, aside, 4},
                       {takumar, Shared, kDouble, aside},
                       {takumar, Hero, kDouble, near},
                       {takumar, Split, kDouble, near}});
}

// Rays near the rim of the stop are next to the caustic that spherical aberration makes; the
// double Gauss folds its light in the corner.
TEST(Targets, TracedLensesKeepTheirMeanAtCaustics) {
    const TestLamp rim{kMiddle, 3, 0.002f, false, 3}, far{kCorner, 20, 0.003f, false};
    for (const auto mode : {Shared, Split, Hero})
        expect_same_means({{"takumar-50mm-f1.2", mode, kFloat, rim},
                           {"double-gauss-100mm-f2", mode, kFloat, far, mode == Hero ? 4u : 1u}});
}

// In focus film points are drawn.
TEST(Targets, TracedLensesKeepTheirMeanInFocus) {
    const TestLamp sharp{kMiddle, 500, 0.05f, false};
    for (const auto mode : {Shared, Split, Hero})
        expect_same_means({{"takumar-50mm-f1.2", mode, kFloat, sharp, mode == Shared ? 1u : 4u}});
}

TEST(Targets, LensesOfOtherShapesKeepTheirMean) {
    const char *const fisheye = "minolta-fisheye-16mm-f2.8", *const anamorphic =
                                                                 "schneider-anamorphic-31mm";
    expect_same_means({{fisheye, Split, kFloat, {V2f(0.1f, 0.5f), 0.3f, 4e-4f, true}},
                       {fisheye, Shared, kFloat, {kCorner, 0.3f, 4e-4f, true}},
                       {anamorphic, Split, kFloat, {kMiddle, 0.7f, 0.001f, false}},
                       {anamorphic, Shared, kFloat, {V2f(0.06f, 0.95f), 0.7f, 0.004f, false}}});
}

// Targets that no lamp has: the lamp beside them keeps its mean, and no weight is broken.
TEST(Targets, SenselessTargetsDoNoHarm) {
    const TestLamp lamp{V2f(0.5f), 3, 0.02f, false};
    const auto traced = std::make_shared<LensCamera>(test::input_of(test::kTakumar));
    for (const std::shared_ptr<const Camera>& plain :
         {std::shared_ptr<const Camera>(thin_lens()), std::shared_ptr<const Camera>(traced)}) {
        const auto camera = target_camera(plain);
        const Ray ray = test::ray_of(*camera, lamp.film, lamp.draw);
        const V3f at = ray.origin + lamp.distance_m * ray.direction, ahead = ray.direction;
        const std::vector<Target> cases{{at, 1e-7f},
                                        {at, 1e6f},
                                        {at, 1e-30f},
                                        {at, std::numeric_limits<float>::max()},
                                        {ray.origin - ahead, 0.01f},
                                        {ray.origin, 0.01f},
                                        {ray.origin, 1e-6f},
                                        {ray.origin + ahead * 1e-4f, 1e-3f},
                                        {ray.origin + ahead * 1e9f, 1e6f},
                                        {ahead, 1e-7f, true},
                                        {ahead, 1e6f, true},
                                        {-ahead, 0.1f, true},
                                        {unit(ahead.cross(V3f(0, 1, 0))), 0.1f, true}};
        const test::Moments ordinary = light(*camera, Observer(), lamp, at, {}, 3, kOrdinary).light;
        for (size_t i = 0; i < cases.size(); ++i) {
            const TargetCell cell = test::listed_in(*camera, test::cell_about(lamp.film, kFrame_px),
                                                    kFrame_px, {cases[i]});
            const test::Moments found =
                light(*camera, Observer(), lamp, at, cell, 4, kSamples).light;
            EXPECT_TRUE(std::isfinite(found.mean()) && std::isfinite(found.variance())) << i;
            EXPECT_TRUE(test::agrees(Mean(found) - Mean(ordinary), 0))
                << "target " << i << ": " << Mean(found) << ", " << Mean(ordinary);
        }
    }
}

}  // namespace
}  // namespace petzval::camera
