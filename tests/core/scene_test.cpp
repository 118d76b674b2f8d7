// SPDX-License-Identifier: Apache-2.0
// A finished scene: its bounds, which must not cost a look at every triangle of a million
// instances.
#include "core/scene/scene.h"

#include <gtest/gtest.h>

#include "tests/support/lamp.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using test::Random;

// Turned, sheared and mirrored anyhow, from tiny to large, near the origin and far from it.
M44f any_matrix(Random& random) {
    M44f m;
    const float scale = std::pow(10.f, 6 * random.next() - 3);
    const float far = std::pow(10.f, 4 * random.next() - 1);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) m[i][j] = (2 * random.next() - 1) * scale;
    for (int j = 0; j < 3; ++j) m[3][j] = (2 * random.next() - 1) * far;
    return m;
}

Scene instances_of_a_sphere(size_t count) {
    Scene scene;
    test::place(scene, test::sphere(V3f(0.3f, -0.2f, 5), 1.f, 6, false),
                test::diffuse_material(0.5f));
    scene.instances.clear();
    Random random(7);
    for (size_t i = 0; i < count; ++i)
        scene.instances.push_back(test::placed(0, any_matrix(random)));
    return scene;
}

Box3f box_of(const Scene& scene, uint32_t instance) {
    Box3f box;
    for (uint32_t t = 0; t < scene.meshes[0].triangles.size(); ++t)
        for (const V3f& corner : triangle_corners(scene, instance, t)) box.extendBy(corner);
    return box;
}

TEST(Scene, BoundsAreThoseOfAllCorners) {
    for (const size_t count : {1u, 2u, 3u, 10u, 300u}) {
        Scene scene = instances_of_a_sphere(count);
        finish_scene(scene);
        Box3f all;
        for (uint32_t i = 0; i < count; ++i) all.extendBy(box_of(scene, i));
        EXPECT_EQ(scene.bounds, all) << count;
    }
}

TEST(Scene, APlacedBoxHoldsWhatIsPlaced) {
    const Scene scene = instances_of_a_sphere(2000);
    const Box3f of_mesh = mesh_boxes(scene)[0];
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Box3f box = placed_box(of_mesh, scene.instances[i].to_world),
                    exact = box_of(scene, i);
        EXPECT_TRUE(box.intersects(exact.min) && box.intersects(exact.max)) << i;
        EXPECT_LT((box.max - box.min).length(),
                  20 * (exact.max - exact.min).length() + 1e-5f * exact.max.length())
            << i;
    }
}

TEST(Scene, ColoursBelongToVerticesOrToInstances) {
    Mesh mesh;
    mesh.triangles = {{0, 1, 2}};
    mesh.colours = {V4f(1, 0, 0, 1), V4f(0, 1, 0, 1), V4f(0, 0, 1, 1)};
    EXPECT_EQ(mesh.colour_at(9, 0, V2f(1, 0)), V4f(0, 1, 0, 1));
    mesh.colours_from = 8;
    mesh.colours.push_back(V4f(1, 1, 1, 0.5f));
    EXPECT_EQ(mesh.colour_at(8, 0, V2f(1, 0)), V4f(0, 1, 0, 1));
    EXPECT_EQ(mesh.colour_at(9, 0, V2f(1, 0)), V4f(1, 1, 1, 0.5f));
    EXPECT_EQ(mesh.colour_at(9, 0, V2f(0, 0.5f)), V4f(0, 0, 1, 1));
}

}  // namespace
}  // namespace petzval
