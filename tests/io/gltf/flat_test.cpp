// SPDX-License-Identifier: Apache-2.0
// Nodes that mirror and nodes that flatten: what rays meet there.
#include "io/gltf/meshes/flat.h"

#include <gtest/gtest.h>

#include "core/shading/surface.h"
#include "core/traversal/bvh.h"
#include "io/gltf/document/nodes.h"
#include "tests/support/load_tiny_gltf.h"
#include "tests/support/tiny_png.h"

namespace petzval::io {
namespace {

using nlohmann::json;

struct Traced {
    GltfFile file;
    std::unique_ptr<Bvh> bvh;

    explicit Traced(const TinyGltf& tiny) : file(load(tiny)) {
        finish_scene(file.scene);
        bvh = std::make_unique<Bvh>(file.scene, Traversal::Robust);
    }
    [[nodiscard]] std::optional<Surface> meet(const V3f& from, const V3f& direction) const {
        Ray ray;
        ray.origin = from;
        ray.direction = direction;
        const auto hit = bvh->intersect(ray);
        return hit ? std::optional(make_surface(file.scene, direction, *hit)) : std::nullopt;
    }
    /// Shading normal with the normal map.
    [[nodiscard]] V3f mapped(const Surface& s, const V3f& direction) const {
        return read_material(file.scene, s, locate_material(file.scene, s), -direction,
                             Bands::rgb(), {})
            .frame.z;
    }
};

/// A box of side 2 about the origin, single-sided, faces outwards.
TinyGltf box() {
    TinyGltf file;
    std::vector<float> positions;
    for (int k = 0; k < 8; ++k)
        for (const int bit : {1, 2, 4}) positions.push_back(k & bit ? 1.f : -1.f);
    const std::vector<uint16_t> indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                           2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    const int p = file.add_positions(positions), i = file.add_accessor("SCALAR", indices);
    file.add_mesh({{"attributes", {{"POSITION", p}}}, {"indices", i}});
    return file;
}

const std::vector<V2f> kSpots = {{0.1f, 0.2f}, {-0.7f, 0.4f}, {0.55f, -0.85f}, {-0.3f, -0.6f}};

// Rays from both sides of the plane y = 5 meet the front of a sheet there.
void expect_sheet(const Traced& traced) {
    for (const float side : {1.f, -1.f})
        for (const float distance : {1.f, 20.f, 500.f})
            for (const V2f& spot : kSpots) {
                const V3f down(0, -side, 0);
                const auto s = traced.meet(V3f(spot.x, 5 + side * distance, spot.y), down);
                ASSERT_TRUE(s) << side << " " << distance << " " << spot;
                EXPECT_TRUE(s->front) << side << " " << distance << " " << spot;
                EXPECT_LT((s->ng - V3f(0, side, 0)).length(), 1e-3f);
                EXPECT_NEAR(s->p.y, 5, 1e-3);
            }
}

TEST(GltfFlat, ABoxBecomesASheetWithTwoFronts) {
    TinyGltf file = box();
    file.add_root({{"mesh", 0}, {"scale", {1, 0, 1}}, {"translation", {0, 5, 0}}});
    const Traced traced(file);
    EXPECT_TRUE(traced.file.warnings.empty());
    EXPECT_TRUE(contains_line(traced.file.honoured, "flattened"));
    expect_sheet(traced);
    EXPECT_FALSE(traced.meet(V3f(1.1f, 9, 0), V3f(0, -1, 0)));
    // Once more, as one of many, and with all axes mixed by parents.
    file.json["nodes"][0] = {{"children", {1}}, {"scale", {1, 0, 1}}, {"translation", {0, 5, 0}}};
    file.add("nodes", {{"mesh", 0}, {"rotation", {0.5, 0.5, 0.5, 0.5}}});
    file.add_root({{"mesh", 0}, {"translation", {100, 0, 0}}});
    const Traced many(file);
    EXPECT_EQ(many.file.scene.instances.size(), 2u);
    EXPECT_FALSE(many.file.scene.instances[0].identity);
    expect_sheet(many);
}

// A negative zero, or a mirrored axis beside the one that is lost, mirrors nothing: the determinant
// is not negative.
TEST(GltfFlat, ItsSidesAreThoseOfTheFile) {
    TinyGltf file;
    file.add_triangle();  // in the plane z = 0, faces +z
    const auto front_from_above = [&](json node) {
        node["mesh"] = 0;
        file.json.erase("nodes"), file.json.erase("scenes");
        file.add_root(std::move(node));
        const Traced traced(file);
        const auto s = traced.meet(V3f(0.2f, 0.2f, 3), V3f(0, 0, -1));
        const auto t = traced.meet(V3f(-0.2f, 0.2f, 3), V3f(0, 0, -1));
        EXPECT_NE(s.has_value(), t.has_value());
        return s ? s->front : t && t->front;
    };
    EXPECT_TRUE(front_from_above({{"scale", {1, 1, 0}}}));
    EXPECT_TRUE(front_from_above({{"scale", {1, 1, -0.0}}}));
    EXPECT_TRUE(front_from_above({{"scale", {-1, 1, -1}}}) == false);  // turned about y
    EXPECT_TRUE(front_from_above({{"scale", {-1, 1, 1}}}));            // mirrored, faces +z still
    EXPECT_FALSE(front_from_above({{"scale", {-1, 1, 0}}}));
}

TEST(GltfFlat, ThickenedMatrices) {
    const Box3f box(V3f(-1, -2, 3), V3f(4, 5, 7));
    // Rank 2, with the lost direction across all axes, and far from the origin.
    const M44d flat(1, 0, 2, 0, 0, 1, 1, 0, 1, 1, 3, 0, 1000, -2000, 500, 1);
    EXPECT_EQ(dimensions_left(flat), 2);
    const M44d thick = thickened(flat, box);
    EXPECT_EQ(dimensions_left(thick), 3);
    EXPECT_GT(relative_determinant(thick), 0);
    for (int k = 0; k < 8; ++k) {  // moves corners by little
        const V3d p(k & 1 ? -1 : 4, k & 2 ? -2 : 5, k & 4 ? 3 : 7);
        const double off = (p * thick - p * flat).length();
        EXPECT_LT(off, 0.02);
    }
    EXPECT_EQ(dimensions_left(M44d(1, 2, 3, 0, 2, 4, 6, 0, 3, 6, 9, 0, 0, 0, 0, 1)), 1);
    EXPECT_EQ(dimensions_left(M44d(0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1)), 1);
    EXPECT_EQ(dimensions_left(M44d()), 3);
}

// A quad with a normal map whose texel leans along +u and +v.
TinyGltf mapped_quad() {
    TinyGltf file;
    file.add("textures", {{"source", file.add_image(tiny_png(1, 1, {200, 170, 220, 255}))}});
    file.add("materials", {{"normalTexture", {{"index", 0}}}, {"doubleSided", true}});
    const int p = file.add_positions({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0});
    const int uv = file.add_accessor<float>("VEC2", {0, 1, 1, 1, 1, 0, 0, 0});
    const int n = file.add_accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    const int i = file.add_accessor<uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3});
    file.add_mesh({{"attributes", {{"POSITION", p}, {"TEXCOORD_0", uv}, {"NORMAL", n}}},
                   {"indices", i},
                   {"material", 0}});
    return file;
}

// A mirrored mesh is what one sees in a mirror: its fronts, normals and normal maps too. Stored in
// the world, or as one of many instances.
TEST(GltfFlat, MirroredNodesAreMirrorImages) {
    const V3f from(0.3f, 0.2f, 4), down = V3f(0.05f, -0.02f, -1).normalized();
    TinyGltf plain = mapped_quad();
    plain.add_root({{"mesh", 0}});
    const Traced original(plain);
    const auto s = original.meet(from, down);
    ASSERT_TRUE(s && s->front);
    const V3f mapped = original.mapped(*s, down);
    EXPECT_GT(mapped.x, 0.3f);
    EXPECT_GT(mapped.y, 0.1f);
    for (int axis = 0; axis < 3; ++axis)
        for (const bool many : {false, true}) {
            V3f mirror(1.f);
            mirror[axis] = -1;
            TinyGltf file = mapped_quad();
            file.add_root({{"mesh", 0}, {"scale", {mirror.x, mirror.y, mirror.z}}});
            if (many) file.add_root({{"mesh", 0}, {"translation", {50, 0, 0}}});
            const Traced traced(file);
            EXPECT_EQ(traced.file.scene.instances[0].identity, !many);
            const V3f direction = down * mirror;
            const auto seen = traced.meet(from * mirror, direction);
            ASSERT_TRUE(seen) << axis << many;
            EXPECT_TRUE(seen->front) << axis << many;
            EXPECT_LT((seen->ng - s->ng * mirror).length(), 1e-5f) << axis << many;
            EXPECT_LT((seen->ns - s->ns * mirror).length(), 1e-5f) << axis << many;
            EXPECT_LT((traced.mapped(*seen, direction) - mapped * mirror).length(), 1e-4f)
                << axis << many << traced.mapped(*seen, direction) << mapped;
        }
}

}  // namespace
}  // namespace petzval::io
