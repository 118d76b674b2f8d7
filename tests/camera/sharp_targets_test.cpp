// SPDX-License-Identifier: Apache-2.0
// Rays to targets that are in focus: film points of a pixel are drawn, so that a lamp far smaller
// than the pixel is met by each sample.
#include <gtest/gtest.h>

#include "camera/models/thin_lens.h"
#include "camera/targets/make_target_camera.h"
#include "camera/targets/target_grid.h"
#include "tests/support/lens_cameras.h"
#include "tests/support/observers.h"
#include "tests/support/targets.h"

namespace petzval::camera {
namespace {

using test::Mean;

const V2i kSharp_px(320, 200);
constexpr float kSharpYfov_rad = 0.5f, kSharpAspect = 1.6f, kSharpFocus_m = 2;

std::unique_ptr<TargetCamera> sharp_lens() {
    return target_camera(std::make_shared<ThinLensCamera>(
        ThinLens{M44f(), kSharpYfov_rad, kSharpAspect, Iris(Disk{}, 20), kSharpFocus_m}));
}
/// Width of a pixel, where a thin lens is in focus.
float pixel_m() {
    return 2 * std::tan(kSharpYfov_rad / 2) * kSharpFocus_m / float(kSharp_px.y);
}

/// Light of a lamp of radiance 1 in a pixel, some pixels right of its middle and below. Its targets
/// are as wide as it is and stand so many of its radii beside it.
test::PixelLight light_of(const TargetCamera& camera, const Filter& filter, V2f off_px,
                          float radius_m, uint32_t rays, const std::vector<float>& beside = {0}) {
    const V2f frame(kSharp_px), middle = V2f(160.5f, 100.5f) / frame;
    const V2f off = ((middle - V2f(0.5f)) * frame + off_px) * pixel_m();
    const V3f lamp(off.x, -off.y, -kSharpFocus_m);
    std::vector<Target> targets;
    for (const float radii : beside)
        targets.push_back({lamp + V3f(radii * radius_m, 0, 0), radius_m});
    TargetCell cell =
        test::listed_in(camera, test::cell_about(middle, kSharp_px), kSharp_px, targets);
    EXPECT_EQ(cell.targets.size(), targets.size());
    for (const ListedTarget& target : cell.targets) EXPECT_TRUE(target.is_sharp);
    cell.rays = rays;
    return test::light_of(
        camera, cell, {&filter, frame, middle}, 3, 1 << 13,
        [](const Sampler&) { return Bands::rgb(); },
        [&](const Ray& ray) { return test::passes(ray, lamp, radius_m) ? 1 / 3.f : 0.f; });
}

// A lamp with a 10,000th of the pixel's area brings its area over the pixel's, times the filter
// there.
TEST(SharpTargets, BringTheLightOfALampInClosedForm) {
    const auto camera = sharp_lens();
    const float radius_m = pixel_m() * 0.0056f;
    const double area_px2 = double(kPi) * sqr(double(radius_m) / double(pixel_m()));
    for (const auto& filter : {Filter(FilterKind::Box, 0.5f), Filter(FilterKind::BlackmanHarris, 2),
                               Filter(FilterKind::Gauss, 1.5f)})
        for (const V2f& off_px : {V2f(0.1f, 0.2f), V2f(0.4f, -0.45f), V2f(-0.8f, -0.6f)})
            for (const uint32_t rays : {1u, 4u}) {
                const double expected = area_px2 * double(filter.density_per_px2(off_px));
                const test::PixelLight found = light_of(*camera, filter, off_px, radius_m, rays);
                // The filter is not even over the lamp.
                EXPECT_TRUE(test::agrees(found.light, expected, 1e-3 * expected))
                    << int(filter.kind()) << ' ' << off_px << ": " << Mean(found.light) << ", "
                    << expected;
                // Each ray meets it, but for those that the reach of a target leaves beside it.
                EXPECT_LE(found.light.variance(), 0.2 / rays * sqr(expected));
                EXPECT_EQ(found.sent > 0, expected > 0);
            }
}

// What is drawn for one target and lands on another beside it has both densities.
TEST(SharpTargets, MayOverlap) {
    const auto camera = sharp_lens();
    const float radius_m = pixel_m() * 0.0056f;
    const double expected = double(kPi) * sqr(double(radius_m) / double(pixel_m()));
    const Filter filter(FilterKind::Box, 0.5f);
    for (const auto& beside : {std::vector{-0.5f, 0.5f}, std::vector{-0.98f, 0.f, 1.2f}}) {
        const test::PixelLight found =
            light_of(*camera, filter, V2f(0.1f, 0.2f), radius_m, 1, beside);
        EXPECT_TRUE(test::agrees(found.light, expected, 1e-3 * expected))
            << beside[0] << ": " << Mean(found.light) << ", " << expected;
    }
}

// The filter of a pixel beside the border of a cell reaches over it. Small cells have the least
// margin.
TEST(SharpTargets, AreListedForPixelsWhoseFilterReachesThem) {
    const auto camera = sharp_lens();
    const V2i frame_px(64, 40), corner_px(32, 20);  // of four cells
    const float side_m = pixel_m() * float(kSharp_px.y) / float(frame_px.y);
    for (const V2i& step : {V2i(1, 0), V2i(0, 1)})
        for (const float beyond_px : {0.1f, 0.6f}) {
            // Of the other direction it is within the cell.
            const V2f at_px = V2f(corner_px) + V2f(step) * beyond_px + V2f(V2i(1) - step);
            const V2f off = (at_px - V2f(frame_px) / 2.f) * side_m;
            const SmallFeature lamp{.kind = SmallFeature::Kind::Lamp,
                                    .centre = V3f(off.x, -off.y, -kSharpFocus_m),
                                    .radius_m = 1e-5f,
                                    .reach_m = 1e-5f,
                                    .radiance = 1};
            const auto grid = find_targets(*camera, frame_px, {&lamp, 1});
            ASSERT_NE(grid, nullptr);
            const auto cell = [&](V2i px) -> const TargetCell& {
                return grid->at((V2f(px) + V2f(0.5f)) / V2f(frame_px));
            };
            const TargetCell &own = cell(V2i(at_px)), &before = cell(V2i(at_px) - step);
            EXPECT_NE(&own, &before);
            EXPECT_EQ(own.targets.size(), 1u) << at_px;
            EXPECT_EQ(before.targets.size(), 1u) << at_px;
            EXPECT_TRUE(cell(V2i(at_px) - 10 * step).empty());
        }
}

/// Light of a lamp in focus through a traced lens, with and without rays to it.
struct Both {
    test::Moments with, without;
};
Both through_a_lens(DispersionMode mode, Precision precision, const Filter& filter, V2f film,
                    uint32_t rays) {
    LensCameraInput in = test::input_of(test::kTakumar, mode, 0.4);
    in.precision = precision;
    const auto camera = target_camera(std::make_shared<LensCamera>(std::move(in)));
    const V2i frame_px(72, 48);
    const Ray ray = test::ray_of(*camera, film, 1);
    const float away_m = 300, radius_m = 0.35f;
    const V3f lamp = ray.origin + away_m * ray.direction;
    TargetCell cell =
        test::listed_in(*camera, test::cell_about(film, frame_px), frame_px, {{lamp, radius_m}});
    EXPECT_TRUE(cell.targets.size() == 1 && cell.targets[0].is_sharp);
    cell.rays = rays;
    const Observer observer = test::plain_observer();
    const auto light = [&](const TargetCell& targets, uint32_t seed, uint32_t samples) {
        return test::light_of(
                   *camera, targets, {&filter, V2f(frame_px), film}, seed, samples,
                   [&](const Sampler& s) { return observer.draw(s.get1(Dim::Wavelength)); },
                   [&](const Ray& r) { return test::passes(r, lamp, radius_m) ? 1.f : 0.f; })
            .light;
    };
    return {light(cell, 4, 2048), light({}, 3, 1 << 16)};
}

TEST(SharpTargets, TracedLensesKeepTheirMean) {
    using enum DispersionMode;
    for (const auto mode : {Shared, Split, Hero})
        for (const auto& filter :
             {Filter(FilterKind::Box, 0.5f), Filter(FilterKind::BlackmanHarris, 2)})
            for (const V2f& film : {V2f(0.51f, 0.48f), V2f(0.15f, 0.2f)}) {
                SCOPED_TRACE(testing::Message()
                             << int(mode) << ' ' << int(filter.kind()) << ' ' << film);
                const bool middle = film.x > 0.5f;
                const Both found =
                    through_a_lens(mode, middle ? Precision::Float : Precision::Double, filter,
                                   film, middle ? 1 : 4);
                EXPECT_TRUE(test::agrees(Mean(found.with) - Mean(found.without), 0))
                    << Mean(found.with) << ", " << Mean(found.without);
                EXPECT_LT(found.with.variance(), found.without.variance() / 9);
            }
}

// Wide open, in focus: most of the stop sees a lamp from less than a pixel, its rim from several.
TEST(SharpTargets, ThoseOfALensThatIsNotSharpHaveACore) {
    LensCameraInput in = test::input_of(test::kTakumar, DispersionMode::Shared);
    const auto camera = target_camera(std::make_shared<LensCamera>(std::move(in)));
    const V2i frame_px(320, 213);
    const V2f film(0.51f, 0.48f);
    const float away_m = 300, radius_m = 0.05f;
    const Filter filter(FilterKind::BlackmanHarris, 1.5f);
    const Ray axis = test::ray_of(*camera, film, 1);
    for (const V2f& aside_px : {V2f(0.f), V2f(0.9f, 0.7f), V2f(-1.2f, 0.4f)}) {
        const V3f lamp = axis.origin + away_m * axis.direction;
        const V2f middle = film + aside_px / V2f(frame_px);
        TargetCell cell = test::listed_in(*camera, test::cell_about(film, frame_px), frame_px,
                                          {{lamp, radius_m}});
        ASSERT_EQ(cell.targets.size(), 1u);
        EXPECT_FALSE(cell.targets[0].is_sharp);
        ASSERT_TRUE(cell.targets[0].core);
        cell.rays = 2;
        const auto light = [&](const TargetCell& targets, uint32_t seed, uint32_t samples) {
            return test::light_of(
                       *camera, targets, {&filter, V2f(frame_px), middle}, seed, samples,
                       [](const Sampler&) { return Bands::rgb(); },
                       [&](const Ray& r) { return test::passes(r, lamp, radius_m) ? 1.f : 0.f; })
                .light;
        };
        const test::Moments with = light(cell, 4, 1 << 13), without = light({}, 3, 1 << 19);
        cell.targets[0].core.reset();
        const test::Moments by_stop = light(cell, 5, 1 << 15);
        EXPECT_TRUE(test::agrees(Mean(with) - Mean(without), 0))
            << aside_px << ": " << Mean(with) << ", " << Mean(without);
        EXPECT_LT(with.variance(), by_stop.variance() / 3) << aside_px;
    }
}

// A film point whose pixel nobody knows has ordinary rays alone, with their whole weight.
TEST(SharpTargets, NeedAPixel) {
    const auto camera = sharp_lens();
    camera->set_targets(test::grid_of(test::listed_in(
        *camera, test::cell_about(V2f(0.5f), kSharp_px), kSharp_px, {{V3f(0, 0, -2), 1e-5f}})));
    const Filter filter(FilterKind::Box, 0.5f);
    const Sampler sampler(SamplerKind::Independent, 1, {0, 0, 0});
    FilmPoint point{V2f(0.5f), sampler, {&filter, V2f(0.f), V2f(kSharp_px)}};
    EXPECT_EQ(camera->sample(point, Bands::rgb()).size(), 2u);
    point.pixel.filter = nullptr;
    const CameraSample alone = camera->sample(point, Bands::rgb());
    ASSERT_EQ(alone.size(), 1u);
    EXPECT_EQ(alone[0].mis_weight, 1);
}

}  // namespace
}  // namespace petzval::camera
