// SPDX-License-Identifier: Apache-2.0
// Things that a plan must not miss, where their light lands, and how far cameras differ there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "apps/plan/displacement.h"
#include "camera/models/thin_lens.h"
#include "camera/setup/film_region.h"
#include "tests/support/scenes.h"

namespace petzval::apps {
namespace {

using test::diffuse_material, test::emitter_material, test::place, test::quad;

constexpr V2i kFrame_px{320, 180};

camera::ThinLensCamera camera(float radius_m, float focus_m) {
    camera::ThinLens lens{camera::look_at(V3f(0.f), V3f(0, 0, -1)), 0.6f, 320 / 180.f, {}};
    if (radius_m > 0) lens.iris.emplace(camera::ApertureShape(), 1e3 * double(radius_m));
    lens.focus_m = focus_m;
    return camera::ThinLensCamera(lens);
}

/// A square across the axis, with its centre there.
Mesh square(V3f centre, float side) {
    return quad(centre - V3f(side / 2, side / 2, 0), V3f(side, 0, 0), V3f(0, side, 0));
}

Scene lamps(const std::vector<V3f>& centres, float side) {
    Scene scene;
    for (const V3f& centre : centres) place(scene, square(centre, side), emitter_material(100.f));
    finish_scene(scene);
    return scene;
}

TEST(Things, LampsThatLieApartAreSeveral) {
    const std::vector<V3f> centres{{-0.5f, 0, -2}, {0.5f, 0.1f, -3}, {0, -0.3f, -4}};
    const Scene scene = lamps(centres, 0.01f);
    const std::vector<SmallFeature> features = small_features_of(scene);
    ASSERT_FALSE(features.empty());
    for (const V3f& centre : centres) {
        const auto near =
            std::count_if(features.begin(), features.end(), [&](const SmallFeature& t) {
                return (t.centre - centre).length() < 0.01f && t.radius_m < 0.01f;
            });
        EXPECT_GE(near, 1) << centre.x;
    }
    double area = 0;
    for (const SmallFeature& t : features) {
        EXPECT_TRUE(t.is_lamp());
        EXPECT_NEAR(t.radiance, 100, 1);
        area += t.area_m2;
    }
    EXPECT_NEAR(area, 3 * 0.01 * 0.01 / 2, 1e-8);
}

TEST(Things, WhatNeitherShinesNorDependsOnWavelengthIsNone) {
    Scene scene;
    place(scene, square({0, 0, -4}, 4.f), diffuse_material(0.5f));
    finish_scene(scene);
    EXPECT_TRUE(small_features_of(scene).empty());
}

// A lamp that nobody sees, be it as bright as it likes, does not hide others; nor do big dim ones.
TEST(Things, LampsAreFoundBesideMuchBrighterAndMuchDarkerOnes) {
    std::vector<V3f> centres;
    for (int i = 0; i < 30; ++i)
        centres.emplace_back(-1.2f + 0.5f * float(i / 5), -0.6f + 0.3f * float(i % 5), -4.f);
    Scene scene;
    for (const V3f& centre : centres) place(scene, square(centre, 0.001f), emitter_material(100.f));
    place(scene, square({0, 0, 3}, 0.5f), emitter_material(1e6f));
    place(scene, test::sphere({0, 0, -20}, 15, 16, false), emitter_material(0.1f));
    finish_scene(scene);
    const std::vector<SmallFeature> features = small_features_of(scene);
    for (const V3f& centre : centres)
        EXPECT_TRUE(std::any_of(features.begin(), features.end(),
                                [&](const SmallFeature& t) {
                                    return (t.centre - centre).length() < 0.01f &&
                                           t.radius_m < 0.01f;
                                }))
            << centre.x << ' ' << centre.y;
}

TEST(Things, AFinelyTessellatedLampIsOne) {
    for (const int rows : {8, 60}) {
        Scene scene;
        place(scene, test::sphere({0.2f, 0.1f, -2}, 0.05f, rows, true), emitter_material(10.f));
        finish_scene(scene);
        const std::vector<SmallFeature> features = small_features_of(scene);
        ASSERT_EQ(features.size(), 1u) << rows;
        EXPECT_NEAR(features[0].area_m2, 2 * 3.14159 * 0.05 * 0.05, 0.1 * 0.0157);
        EXPECT_NEAR(features[0].radiance, 10, 1e-3);
    }
}

// One triangle of two is taken: many small lamps are not counted twice.
TEST(Things, ManyLampsKeepTheirArea) {
    constexpr int kLamps = 300'000;
    Scene scene;
    Mesh mesh;
    mesh.positions = {V3f(0.f), V3f(0.01f, 0, 0), V3f(0, 0.01f, 0)};
    mesh.triangles = {{0, 1, 2}};
    place(scene, mesh, emitter_material(1.f));
    scene.instances.resize(kLamps, scene.instances[0]);
    finish_scene(scene);
    double area = 0;
    for (const SmallFeature& t : small_features_of(scene)) area += t.area_m2;
    const double truth = kLamps * 0.01 * 0.01 / 4;
    EXPECT_NEAR(area, truth, 0.01 * truth);
}

// Textures: an even one shines like a colour; bright texels of another count by themselves too.
TEST(Things, TexturesThatGlowAreLamps) {
    for (const bool spot : {false, true}) {
        Scene scene;
        constexpr uint32_t kSide = 64;
        std::vector<float> texels(size_t{kSide} * kSide * 4, spot ? 0.01f : 1.f);
        if (spot) std::fill_n(&texels[4 * (10 * kSide + 20)], 4, 1.f);
        scene.images = {{"picture", kSide, kSide, texels}};
        place(scene, square({0, 0, -2}, 1.f), emitter_material(100.f));
        scene.materials[0].emissive_texture.image = 0;
        finish_scene(scene);
        const std::vector<SmallFeature> features = small_features_of(scene);
        ASSERT_FALSE(features.empty());
        const auto& smallest = *std::min_element(
            features.begin(), features.end(),
            [](const SmallFeature& a, const SmallFeature& b) { return a.radius_m < b.radius_m; });
        if (spot) {
            EXPECT_LT(smallest.radius_m, 0.05f);
            EXPECT_NEAR(double(smallest.centre.x), (20.5 / kSide - 0.5), 0.03);
        } else {
            EXPECT_NEAR(smallest.radiance, 100, 1);
            EXPECT_NEAR(smallest.area_m2, 0.5, 0.01);
        }
    }
}

TEST(Things, GlassThatDispersesIsOne) {
    Scene scene;
    Material glass = diffuse_material(1.f);
    glass.transmission = 1;
    glass.has_volume = true;
    place(scene, square({0.2f, 0, -2}, 0.1f), glass);
    EXPECT_TRUE(small_features_of(scene).empty());
    scene.materials.back().glass.emplace();
    const auto features = small_features_of(scene);
    ASSERT_FALSE(features.empty());
    EXPECT_EQ(features[0].kind, SmallFeature::Kind::Wavelength);
    EXPECT_NEAR(double(features[0].centre.x), 0.2, 0.05);
}

TEST(Things, AMeasuredReflectanceIsOne) {
    Scene scene;
    place(scene, square({0.2f, 0, -2}, 0.1f), diffuse_material(0.5f));
    scene.materials.back().reflectance = 0;
    scene.reflectances.emplace_back();
    const auto features = small_features_of(scene);
    ASSERT_FALSE(features.empty());
    EXPECT_EQ(features[0].kind, SmallFeature::Kind::Wavelength);
    EXPECT_NEAR(double(features[0].centre.x), 0.2, 0.05);
}

TEST(Things, ASunOfASkyIsALamp) {
    constexpr int kWidth = 256, kHeight = 128, kColumn = 40, kRow = 50;
    std::vector<float> rgb(size_t{3} * kWidth * kHeight, 0.1f);
    for (size_t c = 0; c < 3; ++c) rgb[3 * (kRow * kWidth + kColumn) + c] = 1e5f;
    Scene scene;
    scene.sky = Sky::picture(rgb, kWidth, kHeight, 0, 1);
    finish_scene(scene);
    const std::vector<SmallFeature> features = small_features_of(scene);
    ASSERT_FALSE(features.empty());
    const float azimuth = ((kColumn + 0.5f) / kWidth - 0.5f) * 2 * kPi,
                polar = (kRow + 0.5f) / kHeight * kPi;
    const V3f sun(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                  std::sin(polar) * std::sin(azimuth));
    for (const SmallFeature& t : features) {
        EXPECT_TRUE(t.at_infinity);
        EXPECT_LT((t.centre - sun).length(), 0.05f);
    }
}

// Against rays without number: no pixel whose rays pass the lamp is outside, and not many are
// inside that none passes.
TEST(FilmRegions, HoldTheLightOfALampInFocusAndOutOfFocus) {
    for (const auto& [radius_m, focus_m] :
         {std::pair{0.f, 2.f}, std::pair{0.02f, 2.f}, std::pair{0.02f, 1.f}}) {
        const camera::ThinLensCamera seen = camera(radius_m, focus_m);
        const V3f centre(0.31f, -0.12f, -2.f);
        const Scene scene = lamps({centre}, 0.004f);
        const auto features = small_features_of(scene);
        const auto regions = camera::film_regions(seen, kFrame_px, features);
        const Bvh bvh(scene, Traversal::Robust);
        int64_t lit = 0, outside = 0;
        for (int y = 0; y < kFrame_px.y; ++y)
            for (int x = 0; x < kFrame_px.x; ++x) {
                bool met = false;
                for (uint32_t i = 0; i < 2000 && !met; ++i) {
                    const Sampler sampler(SamplerKind::Owen, 0, {x, y, i});
                    const V2f at = V2f(float(x), float(y)) + sampler.get2(Dim::Film);
                    const camera::CameraSample rays =
                        seen.sample({at / V2f(kFrame_px), sampler}, Bands::rgb());
                    // All pixels far from the lamp would take long.
                    const V3f d = rays[0].ray.direction, o = rays[0].ray.origin;
                    const V3f on_plane = o + d * ((centre.z - o.z) / d.z);
                    if (i == 0 && (on_plane - centre).length() > 0.12f) break;
                    met = bvh.intersect(rays[0].ray).has_value();
                }
                const bool inside = std::any_of(regions.begin(), regions.end(),
                                                [&](const auto& r) { return r.contains(x, y); });
                lit += met;
                outside += met && !inside;
            }
        EXPECT_GT(lit, 0);
        EXPECT_EQ(outside, 0) << radius_m << ' ' << focus_m;
        int64_t area = 0;
        for (const camera::FilmRegion& r : regions) area = std::max(area, r.area_px());
        EXPECT_LT(area, 6 * lit + 40) << radius_m << ' ' << focus_m;
    }
}

TEST(FilmRegions, WhatTheCameraDoesNotSeeHasNone) {
    const Scene scene = lamps({{0, 0, 2}}, 0.1f);
    for (const camera::FilmRegion& r :
         camera::film_regions(camera(0.02f, 1), kFrame_px, small_features_of(scene)))
        EXPECT_TRUE(r.rects.empty());
}

TEST(FilmRegions, PixelsAreCountedOff) {
    const camera::FilmRegion region{{{2, 3, 4, 5}, {10, 10, 11, 12}}};
    ASSERT_EQ(region.area_px(), 6);
    for (int64_t i = 0; i < 6; ++i) {
        const auto [x, y] = region.pixel(i);
        EXPECT_TRUE(region.contains(x, y));
    }
    EXPECT_EQ(region.pixel(3), (std::array<int, 2>{3, 4}));
    EXPECT_EQ(region.pixel(4), (std::array<int, 2>{10, 10}));
    EXPECT_FALSE(region.contains(4, 4));
}

// A pinhole in place of a thin lens: rays are off by the circle of confusion, whose mean square is
// half of its squared radius: r |1 / z - 1 / focus| in the tangent of the angle.
TEST(Displacement, IsTheCircleOfConfusion) {
    Scene scene;
    place(scene, square({0, 0, -4}, 20.f), diffuse_material(0.5f));
    finish_scene(scene);
    const Bvh bvh(scene, Traversal::Robust);
    const camera::ThinLensCamera lens = camera(0.02f, 2), pinhole = camera(0, 2);
    const Observer rgb;
    const Displacement found = displacement_of({pinhole, rgb}, {lens, rgb}, scene, bvh,
                                               {V3f(0.f), V3f(0, 0, -1), 2}, kFrame_px, 256, false);
    const double pixel = 2 * std::tan(0.3) / 180;
    const double radius_px = 0.02 * (1 / 2. - 1 / 4.) / pixel;
    const auto& squares = found.square_px.values;
    const double mean =
        std::accumulate(squares.begin(), squares.end(), 0.) / static_cast<double>(squares.size());
    EXPECT_NEAR(mean, radius_px * radius_px / 2, 0.1 * radius_px * radius_px / 2);
    for (const double b : found.brightness.values) EXPECT_NEAR(b, 0, 1e-6);
    // In focus they agree, and no error remains.
    Scene sharp;
    place(sharp, square({0, 0, -2}, 20.f), diffuse_material(0.5f));
    finish_scene(sharp);
    const Bvh sharp_bvh(sharp, Traversal::Robust);
    const FilmMap most =
        most_error(displacement_of({pinhole, rgb}, {lens, rgb}, sharp, sharp_bvh,
                                   {V3f(0.f), V3f(0, 0, -1), 2}, kFrame_px, 64, false),
                   0);
    for (const double m : most.values) EXPECT_LT(m, 1e-3);
}

}  // namespace
}  // namespace petzval::apps
