// SPDX-License-Identifier: Apache-2.0
#include "integrator/prepass/highlights.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "camera/models/thin_lens.h"
#include "tests/support/scenes.h"

namespace petzval::integrator {
namespace {

using namespace test;

const V2i kGlint_px(96, 64);
constexpr float kRadius_m = 0.1f;
/// Of the ball's 50 mm: its facets lie up to 8 um below it, and the lens sees depth by 2 degrees.
constexpr float kDepth_m = 6e-4f;

Material mirror(float roughness = 0) {
    Material m;
    m.metallic = 1;
    m.roughness = roughness;
    return m;
}

SmallFeature lamp_at(const V3f& centre, float reach_m, bool at_infinity = false) {
    SmallFeature lamp{SmallFeature::Kind::Lamp, centre, reach_m, reach_m, at_infinity};
    lamp.area_m2 = double(kPi * reach_m * reach_m);
    lamp.radiance = 1000;
    return lamp;
}

/// From the origin along -z, through a lens 40 mm wide.
camera::ThinLensCamera camera() {
    camera::ThinLens lens;
    lens.yfov_rad = 0.4f;
    lens.iris = camera::Iris(camera::Disk{}, 20);
    lens.focus_m = 3;
    return camera::ThinLensCamera(lens);
}

std::vector<SmallFeature> seen_in(World& world, const std::vector<SmallFeature>& lamps) {
    world.finish();
    return highlights(camera(), world.scene, *world.bvh, kGlint_px, lamps);
}

std::vector<SmallFeature> seen_in_a_ball(const Material& material,
                                         const std::vector<SmallFeature>& lamps) {
    World world;
    place(world.scene, sphere(V3f(0, 0, -1), kRadius_m, 128, true), material);
    return seen_in(world, lamps);
}

/// Refuses to be asked for more points of the film than one for each 8 pixels.
struct BusyCamera : camera::Camera {
    camera::ThinLensCamera of = camera();
    mutable std::atomic<int> asked = 0;

    [[nodiscard]] camera::CameraSample sample(const camera::FilmPoint& at,
                                              const Bands& bands) const override {
        if (++asked > kGlint_px.x * kGlint_px.y / 8) throw std::runtime_error("asked too often");
        return of.sample(at, bands);
    }
};

// The search begins with few rays: a render waits for it.
TEST(Highlights, TakeFewRaysOfTheLens) {
    World world;
    place(world.scene, sphere(V3f(0, 0, -1), kRadius_m, 128, true), mirror());
    world.finish();
    const std::vector<SmallFeature> lamps{lamp_at(V3f(0, 0, 2), 0.006f)};
    EXPECT_EQ(highlights(BusyCamera(), world.scene, *world.bvh, kGlint_px, lamps).size(), 1u);
}

// Paraxial mirror: 1/s' = 1/s + 2/R, behind the vertex (Born and Wolf 1999, 4.4).
TEST(Highlights, AreWhereAConvexMirrorHasItsImage) {
    for (const float away_m : {0.5f, 2.f, 50.f}) {
        const auto found =
            seen_in_a_ball(mirror(), {lamp_at(V3f(0, 0, away_m), 0.002f * (1 + away_m))});
        ASSERT_EQ(found.size(), 1u) << away_m;
        const float s = away_m + 1 - kRadius_m, image = 1 / (1 / s + 2 / kRadius_m);
        EXPECT_LT((found[0].centre - V3f(0, 0, -(1 - kRadius_m) - image)).length(), kDepth_m)
            << found[0].centre;
        // As large as the image, and not much larger.
        const float size = 0.002f * (1 + away_m) * image / s;
        EXPECT_GT(found[0].reach_m, 0.9f * size);
        EXPECT_LT(found[0].reach_m, 2.5f * size);
        EXPECT_TRUE(found[0].is_lamp());
        EXPECT_GT(found[0].radiance, 150)
            << "a mirror takes little, and the disc is not much larger";
        EXPECT_LE(found[0].radiance, 1001);
    }
}

TEST(Highlights, OfASunLieHalfARadiusBehindABall) {
    const auto found = seen_in_a_ball(mirror(), {lamp_at(V3f(0, 0, 1), 0.005f, true)});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_FALSE(found[0].at_infinity);
    EXPECT_LT((found[0].centre - V3f(0, 0, -0.95f)).length(), kDepth_m) << found[0].centre;
}

TEST(Highlights, OfAFlatMirrorAreMirrored) {
    World world;
    place(world.scene, quad(V3f(-1, -1, -1), V3f(2, 0, 0), V3f(0, 2, 0)), mirror());
    const V3f lamp(0.1f, 0.15f, 0.5f);
    const auto found = seen_in(world, {lamp_at(lamp, 0.003f)});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_LT((found[0].centre - V3f(0.1f, 0.15f, -2.5f)).length(), 5e-3f) << found[0].centre;
    World again;
    place(again.scene, quad(V3f(-1, -1, -1), V3f(2, 0, 0), V3f(0, 2, 0)), mirror());
    const V3f sun = unit(V3f(0.05f, 0.1f, 1));
    const auto mirrored = seen_in(again, {lamp_at(sun, 0.004f, true)});
    ASSERT_EQ(mirrored.size(), 1u);
    EXPECT_TRUE(mirrored[0].at_infinity);
    EXPECT_LT((mirrored[0].centre - V3f(sun.x, sun.y, -sun.z)).length(), 1e-3f);
}

// Seen aslant the rays meet in no point, so the disc is larger than the image of a tiny lamp: it is
// as much darker, and what it sends goes by the size of the lamp.
TEST(Highlights, OfTinyLampsSendWhatTheirSizeSays) {
    const auto sent = [](float reach_m) {
        const auto found = seen_in_a_ball(mirror(), {lamp_at(V3f(0.6f, 0.5f, -0.5f), reach_m)});
        EXPECT_EQ(found.size(), 1u);
        return found.empty() ? 0. : found[0].radiance * found[0].area_m2;
    };
    EXPECT_NEAR(sent(0.002f) / sent(0.0005f), 16, 2);
}

// A block of glass shifts what lies behind it by its thickness times 1 - 1 / n.
TEST(Highlights, OfALampBehindABlockOfGlass) {
    World world;
    place(world.scene, box(V3f(-1, -1, -1.3f), V3f(1, 1, -1)), glass_material(1.5f));
    const V3f lamp(0.1f, 0.05f, -3);
    const auto found = seen_in(world, {lamp_at(lamp, 0.003f)});
    const auto shifted = std::find_if(found.begin(), found.end(), [&](const SmallFeature& f) {
        return (f.centre - (lamp + V3f(0, 0, 0.1f))).length() < 0.01f;
    });
    ASSERT_NE(shifted, found.end()) << found.size();
    EXPECT_LT(shifted->reach_m, 0.02f);
}

// Drops below the lens, smaller than a pixel: each shows the sun once as a mirror and once through
// the water, which the rays enter near the drop's edge.
TEST(Highlights, OfDropsAreFoundInEach) {
    World world;
    constexpr int kDrops = 25;
    for (int i = 0; i < kDrops; ++i) {
        const float away_m = 0.6f + 0.1f * float(i / 5), radius_m = 0.001f + 0.0003f * float(i % 4);
        place(world.scene,
              sphere(V3f(0.04f * away_m * float(i % 5 - 2), -0.1f, -away_m), radius_m, 32, true),
              glass_material(1.33f));
    }
    const auto found = seen_in(world, {lamp_at(unit(V3f(0.05f, 0.64f, -0.77f)), 0.0047f, true)});
    EXPECT_GE(found.size(), size_t(2 * kDrops - 2));
    EXPECT_LE(found.size(), size_t(2 * kDrops));
}

// In a ball, aslant, rays of the image meet in no point. Those that the image says are met, from
// any point of the lens, are mirrored to the lamp by a sphere.
TEST(Highlights, OfABallAreAstigmatic) {
    const V3f lamp = unit(V3f(0.3f, 1, -0.4f)), middle(0, 0, -1);
    const float reach = 0.005f;
    const auto found = seen_in_a_ball(mirror(), {lamp_at(lamp, reach, true)});
    ASSERT_EQ(found.size(), 1u);
    ASSERT_TRUE(found[0].image);
    const AstigmaticImage& image = *found[0].image;
    EXPECT_GT(image.passes_m.most(), 0.1f * kRadius_m);
    for (int i = 0; i < 16; ++i) {
        const float angle = 0.4f * float(i), off_m = 0.019f * float(i % 4 + 1) / 4;
        const V3f eye(off_m * std::cos(angle), off_m * std::sin(angle), 0);
        V3f seen = unit(found[0].centre - eye);
        for (int step = 0; step < 4; ++step) {
            const V2f by = image.passes_m(V2f(seen.dot(image.x), seen.dot(image.y)));
            seen = unit(found[0].centre + by.x * image.x + by.y * image.y - eye);
        }
        const float along = (middle - eye).dot(seen);
        const float to_sphere =
            along - std::sqrt(sqr(kRadius_m) - ((middle - eye).length2() - along * along));
        const V3f normal = unit(eye + to_sphere * seen - middle);
        const V3f mirrored = seen - 2 * seen.dot(normal) * normal;
        EXPECT_LT((mirrored - lamp).length(), reach) << i;
    }
}

/// Along x, a metre long, through (0, 0, -1).
Mesh bar(float radius_m) {
    constexpr uint32_t kSides = 256;
    Mesh out;
    for (uint32_t i = 0; i < kSides; ++i) {
        const float angle = 2 * kPi * float(i) / kSides;
        const V3f normal(0, std::cos(angle), std::sin(angle));
        for (const float x : {-0.5f, 0.5f}) {
            out.positions.push_back(V3f(x, 0, -1) + radius_m * normal);
            out.normals.push_back(normal);
        }
        const uint32_t a = 2 * i, b = 2 * ((i + 1) % kSides);
        out.triangles.push_back({a, b, b + 1});
        out.triangles.push_back({a, b + 1, a + 1});
    }
    return out;
}

// A thin bar stretches the image of a lamp a hundred times. Rays of the image, from any point of
// the lens, are mirrored to the lamp by a cylinder, or nearly: the lens is wider than the bar.
TEST(Highlights, OfAThinBarAreLong) {
    constexpr float kThin_m = 0.01f, kReach_m = 0.01f;
    World world;
    place(world.scene, bar(kThin_m), mirror());
    const V3f lamp(0.1f, 0.6f, 0.3f);
    const auto found = seen_in(world, {lamp_at(lamp, kReach_m)});
    ASSERT_EQ(found.size(), 1u);
    ASSERT_TRUE(found[0].image);
    const AstigmaticImage& image = *found[0].image;
    const float most = image.place_per_m.most(),
                least = std::fabs(image.place_per_m.determinant()) / most;
    EXPECT_GT(most, 50 * least);
    for (int i = 0; i < 16; ++i) {
        const float angle = 0.4f * float(i), off_m = 0.019f * float(i % 4 + 1) / 4;
        const V3f eye(off_m * std::cos(angle), off_m * std::sin(angle), 0);
        V3f seen = unit(found[0].centre - eye);
        for (int step = 0; step < 8; ++step) {
            const V2f by = image.passes_m(V2f(seen.dot(image.x), seen.dot(image.y)));
            seen = unit(found[0].centre + by.x * image.x + by.y * image.y - eye);
        }
        // Across the bar, in y and z.
        const V2f from(eye.y, eye.z + 1), by(seen.y, seen.z);
        const float along = -from.dot(by) / by.length2(),
                    half = std::sqrt(sqr(kThin_m) - (from + along * by).length2()) / by.length();
        const V3f at = eye + (along - half) * seen, normal = unit(V3f(0, at.y, at.z + 1)),
                  mirrored = seen - 2 * seen.dot(normal) * normal;
        const float to_lamp = (lamp - at).dot(mirrored);
        EXPECT_LT((at + to_lamp * mirrored - lamp).length(), 2 * kReach_m) << i;
    }
}

// One behind the other, as the lens sees them.
TEST(Highlights, OfTwoLampsOnALineAreTwo) {
    World world;
    place(world.scene, quad(V3f(-1, -1, -1), V3f(2, 0, 0), V3f(0, 2, 0)), mirror());
    const auto found = seen_in(
        world, {lamp_at(V3f(0.1f, 0.15f, 0.5f), 0.02f), lamp_at(V3f(0.15f, 0.225f, 1.75f), 0.02f)});
    EXPECT_EQ(found.size(), 2u);
}

// A camera sees through the back of a single-sided surface, as glTF culls it, but not its front.
TEST(Highlights, AreSeenThroughCulledBacks) {
    for (const bool front : {false, true}) {
        World world;
        place(world.scene, sphere(V3f(0, 0, -1), kRadius_m, 128, true), mirror());
        const V3f right(0.4f, 0, 0), up(0, 0.4f, 0);
        Material sheet = diffuse_material(0.5f);
        sheet.double_sided = false;
        place(world.scene, quad(V3f(-0.2f, -0.2f, -0.3f), front ? right : up, front ? up : right),
              sheet);
        const SmallFeature lamp = lamp_at(V3f(0.6f, 0.5f, -0.5f), 0.005f);
        EXPECT_EQ(seen_in(world, {lamp}).size(), front ? 0u : 1u);
    }
}

TEST(Highlights, OfUnlitSurfacesAreNone) {
    Material unlit = mirror();
    unlit.unlit = true;
    EXPECT_TRUE(seen_in_a_ball(unlit, {lamp_at(V3f(0, 0, 2), 0.005f)}).empty());
}

TEST(Highlights, OfRoughSurfacesAreWiderAndDarker) {
    const SmallFeature lamp = lamp_at(V3f(0, 0, 2), 0.004f);
    const auto smooth = seen_in_a_ball(mirror(), {lamp});
    const auto rough = seen_in_a_ball(mirror(0.1f), {lamp});
    ASSERT_EQ(smooth.size(), 1u);
    ASSERT_EQ(rough.size(), 1u);
    EXPECT_GT(rough[0].reach_m, 3 * smooth[0].reach_m);
    EXPECT_LT(rough[0].radiance, smooth[0].radiance / 3);
    EXPECT_TRUE(seen_in_a_ball(mirror(0.5f), {lamp}).empty()) << "no highlight that is small";
    EXPECT_TRUE(seen_in_a_ball(diffuse_material(0.5f), {lamp}).empty());
}

// A mirror does not show a light without size, a rough surface does.
TEST(Highlights, OfPunctualLights) {
    for (const bool rough : {false, true}) {
        World world;
        place(world.scene, sphere(V3f(0, 0, -1), kRadius_m, 128, true), mirror(rough ? 0.1f : 0));
        world.scene.lights.push_back(PointLight{V3f(0.3f, 0.2f, 1), Rgb(100.f)});
        world.scene.lights.push_back(SunLight{unit(V3f(0.2f, -0.3f, -1)), Rgb(100.f)});
        EXPECT_EQ(seen_in(world, {}).size(), rough ? 2u : 0u);
    }
}

TEST(Highlights, OfHiddenLampsAreNone) {
    World world;
    place(world.scene, sphere(V3f(0, 0, -1), kRadius_m, 128, true), mirror());
    place(world.scene, quad(V3f(-1, -1, 1), V3f(2, 0, 0), V3f(0, 2, 0)), diffuse_material(0.5f));
    EXPECT_TRUE(seen_in(world, {lamp_at(V3f(0, 0, 2), 0.005f)}).empty());
    EXPECT_TRUE(seen_in_a_ball(mirror(), {}).empty());
    EXPECT_TRUE(seen_in_a_ball(mirror(), {lamp_at(V3f(0, 0, -4), 0.005f)}).empty())
        << "behind the ball";
}

// Lamps of no size, infinite ones, and ones that are no numbers.
TEST(Highlights, OfImpossibleLampsAreNone) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(seen_in_a_ball(mirror(), {lamp_at(V3f(0, 0, 2), 0)}).empty());
    EXPECT_TRUE(seen_in_a_ball(mirror(), {lamp_at(V3f(0, 0, 2), kInfinity)}).empty());
    EXPECT_TRUE(seen_in_a_ball(mirror(), {lamp_at(V3f(kNan), 0.01f)}).empty());
    SmallFeature infinite = lamp_at(V3f(0, 0, 2), 0.01f);
    infinite.radiance = INFINITY;
    EXPECT_TRUE(seen_in_a_ball(mirror(), {infinite}).empty());
}

}  // namespace
}  // namespace petzval::integrator
