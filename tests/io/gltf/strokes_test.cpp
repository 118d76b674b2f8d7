// SPDX-License-Identifier: Apache-2.0
// Points and lines as spheres and cylinders.
#include <gtest/gtest.h>

#include "core/scene/coverage.h"
#include "core/shading/surface.h"
#include "core/traversal/bvh.h"
#include "tests/support/load_tiny_gltf.h"
#include "tests/support/refusal.h"
#include "tests/support/tiny_png.h"

namespace petzval::io {
namespace {

using nlohmann::json;

constexpr float kRadius_m = 0.1f;

GltfFile load_drawn(const TinyGltf& file) {
    const TempFolder folder;
    PictureBudget pictures;
    return load_gltf(file.save_glb(folder.path / "test.glb"), FileScope::Anywhere, pictures,
                     {.point_line_radius_m = kRadius_m});
}

/// Four corners of a square of side 1, drawn in a mode; more: of the primitive.
TinyGltf square(int mode, json more = json::object()) {
    TinyGltf file;
    more["attributes"]["POSITION"] = file.add_positions({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    more["mode"] = mode;
    file.add_mesh(std::move(more));
    file.add_root({{"mesh", 0}});
    return file;
}

/// Numbers of spheres and cylinders.
std::pair<size_t, size_t> shapes(const TinyGltf& file) {
    const Scene scene = load_drawn(file).scene;
    std::pair<size_t, size_t> count{0, 0};
    for (const Instance& i : scene.instances)
        ++(scene.meshes[i.mesh].positions.size() > 100 ? count.first : count.second);
    return count;
}

using Count = std::pair<size_t, size_t>;

TEST(GltfStrokes, WhatEachModeDraws) {
    EXPECT_EQ(shapes(square(0)), Count(4, 0));
    EXPECT_EQ(shapes(square(1)), Count(4, 2));
    EXPECT_EQ(shapes(square(2)), Count(4, 4));
    EXPECT_EQ(shapes(square(3)), Count(4, 3));
    TinyGltf indexed = square(3);
    indexed.json["meshes"][0]["primitives"][0]["indices"] =
        indexed.add_accessor<uint8_t>("SCALAR", {2, 0, 2, 2});  // there and back, and nowhere
    EXPECT_EQ(shapes(indexed), Count(2, 2));
    TinyGltf once = square(0);
    once.json["meshes"][0]["primitives"][0]["indices"] =
        once.add_accessor<uint8_t>("SCALAR", {1, 1, 3});
    EXPECT_EQ(shapes(once), Count(2, 0));
    EXPECT_TRUE(contains_line(load_drawn(square(1)).honoured, "points and lines, as spheres"));
    EXPECT_TRUE(load_drawn(square(1)).ignored.empty());
    EXPECT_TRUE(load(square(1)).scene.instances.empty());  // without the option
}

TEST(GltfStrokes, TheRadiusIsOfTheWorldWhateverTheNode) {
    TinyGltf file = square(2);
    file.json["nodes"][0]["scale"] = {10, -20, 0};  // even where it flattens
    file.json["nodes"][0]["translation"] = {0, 0, 7};
    GltfFile loaded = load_drawn(file);
    finish_scene(loaded.scene);
    const auto near = [](float a, float b) { return std::fabs(a - b) < 1e-5f; };
    const Box3f& b = loaded.scene.bounds;
    EXPECT_TRUE(near(b.min.x, -kRadius_m) && near(b.max.x, 10 + kRadius_m)) << b.min << b.max;
    EXPECT_TRUE(near(b.min.y, -20 - kRadius_m) && near(b.max.y, kRadius_m)) << b.min << b.max;
    EXPECT_TRUE(near(b.min.z, 7 - kRadius_m) && near(b.max.z, 7 + kRadius_m)) << b.min << b.max;
}

/// Surface that a ray along -z meets.
std::optional<Surface> below(const Scene& scene, const Bvh& bvh, float x, float y) {
    Ray ray;
    ray.origin = V3f(x, y, 5);
    ray.direction = V3f(0, 0, -1);
    const auto hit = bvh.intersect(ray);
    return hit ? std::optional(make_surface(scene, ray.direction, *hit)) : std::nullopt;
}

TEST(GltfStrokes, RaysMeetRoundFrontsOfThatRadius) {
    GltfFile loaded = load_drawn(square(2));
    finish_scene(loaded.scene);
    const Bvh bvh(loaded.scene, Traversal::Robust);
    EXPECT_FALSE(below(loaded.scene, bvh, 0.5f, 0.5f));
    for (int k = -9; k <= 9; ++k) {
        const float off = 0.01f * static_cast<float>(k);
        const float height = std::sqrt(kRadius_m * kRadius_m - off * off);
        // Along a line; across its end, where it is a sphere.
        for (const auto& [x, y, normal] : {std::tuple(0.4f, off, V3f(0, off, height)),
                                           std::tuple(off, 0.6f, V3f(off, 0, height)),
                                           std::tuple(-0.4f * std::fabs(off), off, V3f(0.f))}) {
            const auto s = below(loaded.scene, bvh, x, y);
            ASSERT_TRUE(s) << x << " " << y;
            EXPECT_TRUE(s->front);
            if (normal.length2() == 0) continue;
            const float radius_m = std::hypot(off, s->p.z);
            EXPECT_TRUE(radius_m > 0.98f * kRadius_m && radius_m < 1.0001f * kRadius_m)
                << x << " " << y << " " << radius_m;
            EXPECT_GT(s->ns.dot(normal.normalized()), 0.98f);
        }
    }
}

TEST(GltfStrokes, ColoursAreThoseOfTheVertices) {
    TinyGltf file = square(1);
    const int colours =
        file.add_accessor<float>("VEC4", {1, 0, 0, 1, 0, 0, 1, 1, 0, 1, 0, 0.5f, 1, 1, 1, 0.25f});
    file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colours;
    file.add("materials", {{"alphaMode", "BLEND"}});
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    // Without colours, of the same material: stays white among the others.
    json white = file.json["meshes"][0]["primitives"][0];
    white["attributes"].erase("COLOR_0");
    white["mode"] = 0;
    file.add_mesh(white);
    for (const int x : {-10, 10}) file.add_root({{"mesh", 1}, {"translation", {x, 0, 0}}});
    std::rotate(file.json["scenes"][0]["nodes"].begin(),
                file.json["scenes"][0]["nodes"].begin() + 1,
                file.json["scenes"][0]["nodes"].end());  // some before, some behind
    GltfFile loaded = load_drawn(file);
    finish_scene(loaded.scene);
    EXPECT_EQ(loaded.scene.meshes.size(), 2u);
    const Bvh bvh(loaded.scene, Traversal::Robust);
    const auto expect = [&](float x, float y, const f4& colour) {
        // BLEND lets some rays pass; all of them count here.
        Ray ray;
        ray.origin = V3f(x, y, 5);
        ray.direction = V3f(0, 0, -1);
        std::optional<Hit> hit;
        for (uint32_t seed = 0; seed < 1000 && !hit; ++seed) {
            ray.alpha_seed = seed;
            hit = bvh.intersect(ray);
            if (hit && make_surface(loaded.scene, ray.direction, *hit).ng.z < 0) hit.reset();
        }
        ASSERT_TRUE(hit) << x << " " << y;
        const f4 found = vertex_colour(make_surface(loaded.scene, ray.direction, *hit));
        for (int i = 0; i < 4; ++i) EXPECT_NEAR(found[i], colour[i], 0.02f) << x << " " << y;
        EXPECT_NEAR(coverage(loaded.scene, hit->instance, hit->triangle, hit->barycentric),
                    colour[3], 0.02f);
    };
    expect(0, -0.05f, f4{1, 0, 0, 1});
    expect(1.05f, 0.01f, f4{0, 0, 1, 1});
    expect(0.25f, 0.02f, f4{0.75f, 0, 0.25f, 1});
    expect(0.25f, 1.02f, f4{0.75f, 1, 0.75f, 0.3125f});
    expect(-9.97f, 0.02f, f4{1, 1, 1, 1});
    expect(10.97f, 0.02f, f4{1, 1, 1, 1});
}

TEST(GltfStrokes, BrokenOnesAreSkippedAndTooManyRefused) {
    TinyGltf file = square(3);
    const float nan = std::nanf("");
    std::memcpy(file.bin.data() + 12, &nan, sizeof nan);
    EXPECT_EQ(shapes(file), Count(2, 1));
    EXPECT_TRUE(contains_line(load_drawn(file).warnings,
                              "2 point or line segments without a finite place"));
    // A point at many places at many places.
    TinyGltf many = square(0);
    const int p = many.add_positions(std::vector<float>(300'000, 1.f));
    many.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = p;
    const json node = many.json["nodes"][0];
    for (int i = 0; i < 20'000; ++i) many.add_root(node);
    EXPECT_TRUE(has(refusal([&] { (void)load_drawn(many); }), "stands at 20001 places"));
}

TEST(GltfStrokes, TexturesAreReadAtZeroWhateverTheirCoordinates) {
    TinyGltf file = square(0);
    file.add("textures", {{"source", file.add_image(tiny_png(1, 1, {255, 0, 0, 255}))}});
    file.json["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 5}}}}},
         {"emissiveTexture", {{"index", 0}, {"texCoord", 3}}},
         {"emissiveFactor", {1, 1, 1}},
         {"alphaMode", "MASK"}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    GltfFile loaded = load_drawn(file);
    finish_scene(loaded.scene);
    const Bvh bvh(loaded.scene, Traversal::Robust);
    const auto s = below(loaded.scene, bvh, 0.02f, 0.02f);
    ASSERT_TRUE(s);
    const ShadingInput found = read_material(loaded.scene, *s, locate_material(loaded.scene, *s),
                                             V3f(0, 0, 1), Bands::rgb(), {});
    EXPECT_GT(found.emitted[0], 0.9f);
    EXPECT_EQ(found.emitted[1], 0.f);
}

TEST(GltfStrokes, AnUndefinedPlaceIsNone) {
    TinyGltf far = square(1);
    far.json["nodes"][0]["scale"] = {1e30, 1, 1};
    EXPECT_EQ(shapes(far), Count(4, 2));
    far.json["nodes"][0]["scale"] = {3e38, 1, 1};
    far.json["nodes"][0]["translation"] = {3e38, 1, 1};
    EXPECT_EQ(shapes(far), Count(2, 0));
}

}  // namespace
}  // namespace petzval::io
