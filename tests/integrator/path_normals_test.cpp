// SPDX-License-Identifier: Apache-2.0
// Paths on surfaces whose normals are mapped, or smooth over few triangles.

#include "tests/integrator/path_estimate.h"

namespace petzval::integrator {
namespace {

using test::bundle;
using test::diffuse_material;
using test::emitter_material;
using test::estimate;
using test::Mean;
using test::place;
using test::quad;
using test::ray_to;
using test::sphere;
using test::World;

// A quad before z = 0 whose every normal is mapped to one that is tilted towards +x.
void place_tilted(World& world, Material m, float tilt_deg) {
    Mesh mesh = quad(V3f(-2, -2, 0), V3f(4, 0, 0), V3f(0, 4, 0));
    mesh.normals.assign(4, V3f(0, 0, 1));
    mesh.tangents.assign(4, V4f(1, 0, 0, 1));
    const float tilt = tilt_deg * kPi / 180;
    Image image{"normals", 1, 1, {}};
    image.texels =
        std::vector<float>{std::sin(tilt) / 2 + 0.5f, 0.5f, std::cos(tilt) / 2 + 0.5f, 1.f};
    m.normal_texture.image = static_cast<int32_t>(world.scene.images.size());
    world.scene.images.push_back(std::move(image));
    place(world.scene, std::move(mesh), m);
}

TEST(Path, NormalMapsTakeNoLightAtAnyTilt) {
    struct Kind {
        float metallic, roughness, transmission;
    };
    for (const Kind kind : {Kind{1, 0, 0}, Kind{1, 0.3f, 0}, Kind{1, 1, 0}, Kind{0, 0, 0},
                            Kind{0, 0.5f, 0}, Kind{0, 1, 0}, Kind{0, 0, 1}, Kind{0, 0.3f, 1}})
        for (const float tilt_deg : {0.f, 40.f, 50.f, 75.f, 85.f})
            for (const float view_deg : {-85.f, -60.f, 0.f, 60.f, 85.f}) {
                World world;
                Material m;
                m.metallic = kind.metallic;
                m.roughness = kind.roughness;
                m.transmission = kind.transmission;
                place_tilted(world, m, tilt_deg);
                world.scene.sky = Sky::uniform(Rgb(1.f));
                world.finish();
                const float view = view_deg * kPi / 180;
                const V3f eye(std::sin(view), 0, std::cos(view));
                const Mean e =
                    estimate(world, PathOptions(), 16, [&](V2f) { return ray_to(eye, V3f(0.f)); });
                EXPECT_TRUE(test::agrees(e, 1, 0.05))
                    << "metallic " << kind.metallic << " roughness " << kind.roughness
                    << " transmission " << kind.transmission << " tilt " << tilt_deg << " view "
                    << view_deg << ": " << e;
            }
}

// A polished floor whose map is so steep that it would mirror the viewer into the floor shows what
// is at the horizon, not a lamp above it.
TEST(Path, ASteepNormalMapDoesNotMirrorTheLampsAbove) {
    for (const bool coat : {false, true}) {
        World world;
        Material m;
        m.metallic = coat ? 0.f : 1.f;
        m.roughness = 0.f;
        if (coat) {
            m.base_color = Rgb(0.f);
            m.specular = 0;
            m.coat = 1;
        }
        place_tilted(world, m, 60);
        if (coat) {
            Material& placed = world.scene.materials.back();
            std::swap(placed.normal_texture, placed.coat_normal_texture);
        }
        // Seen from above, a normal at 60 degrees sends the image 30 degrees below the horizon.
        // The lamp is 30 degrees above it.
        place(world.scene, quad(V3f(1.5f, -1, 0.5f), V3f(0, 2, 0), V3f(0, 0, 1)),
              emitter_material(5.f));
        world.finish();
        const Mean e =
            estimate(world, PathOptions(), 16, [](V2f) { return ray_to(V3f(0, 0, 3), V3f(0.f)); });
        EXPECT_EQ(e.value, 0) << coat;
    }
}

TEST(Path, TechniquesAgreeOnATiltedNormal) {
    World world;
    Material m;
    m.metallic = 0.5f;
    m.roughness = 0.4f;
    place_tilted(world, m, 65);
    place(world.scene, quad(V3f(1.5f, -1, 0.2f), V3f(0, 0, 1), V3f(0, 2, 0)),
          emitter_material(5.f));
    world.scene.sky = Sky::uniform(Rgb(0.5f));
    world.finish();
    PathOptions options;
    options.max_depth = 1;
    test::expect_techniques_agree(world, options, 4096, bundle, 0.01);
}

// A ball of few triangles, smooth by its normals, loses nothing at their edges either.
TEST(Path, CoarseSmoothBallsVanishInAWhiteSky) {
    for (const int rows : {5, 8, 16})
        for (const float metallic : {0.f, 1.f})
            for (const float roughness : {0.f, 0.3f, 1.f}) {
                World world;
                Material m;
                m.metallic = metallic;
                m.roughness = roughness;
                place(world.scene, sphere(V3f(0.f), 0.6f, rows, true), m);
                world.scene.sky = Sky::uniform(Rgb(1.f));
                world.finish();
                const Mean e = estimate(world, PathOptions(), 512, bundle);
                EXPECT_TRUE(test::agrees(e, 1, 0.005))
                    << rows << ' ' << metallic << ' ' << roughness << ": " << e;
            }
}

// A sun grazes a diffuse ball of few triangles: light falls as the smooth normals say, without
// steps at the edges of triangles that face away from the sun.
TEST(Path, CoarseSmoothBallHasNoStepsAtItsTerminator) {
    World world;
    place(world.scene, sphere(V3f(0.f), 1.f, 12, true), diffuse_material(1.f));
    const V3f to_light = unit({1, 0.1f, 0.05f});
    world.scene.lights.push_back(SunLight{-to_light, Rgb(kPi)});
    world.finish();
    PathOptions options;
    options.max_depth = 1;
    const PathTracer tracer(world.scene, *world.bvh, *world.lights, options);
    PathStats stats;
    int near_terminator = 0;
    for (int i = 0; i < 4000; ++i) {
        const Sampler sampler(SamplerKind::Owen, 1, {0, 0, static_cast<uint32_t>(i)});
        const V2f u = sampler.get2(Dim::Film);
        const Ray ray = ray_to(V3f(0, 0, 6), V3f(1.6f * u.x - 0.8f, 1.6f * u.y - 0.8f, 0));
        const auto hit = world.bvh->intersect(ray);
        if (!hit) continue;
        const Surface s = make_surface(world.scene, ray.direction, *hit);
        if (!(s.ns.dot(ray.direction) < -0.1f)) continue;
        FilmSample out;
        const float seen = tracer.radiance({ray}, Bands::rgb(), sampler, out, stats)[0];
        const float cosine = s.ns.dot(to_light);
        near_terminator += cosine > 0 && s.ng.dot(to_light) < 0;
        EXPECT_NEAR(seen, std::max(cosine, 0.f), 1e-4f) << s.p;
    }
    EXPECT_GT(near_terminator, 20);  // triangles in the shade of their own planes
}

// A lamp so near that it counts from which point of the surface its light is seen.
TEST(Path, TechniquesAgreeOnACoarseSmoothBall) {
    World world;
    place(world.scene, sphere(V3f(0.f), 0.6f, 6, true), diffuse_material(0.8f));
    place(world.scene, quad(V3f(0.9f, -0.4f, -0.6f), V3f(0, 0, 0.8f), V3f(0, 0.8f, 0)),
          emitter_material(5.f));
    world.finish();
    PathOptions options;
    options.max_depth = 1;
    for (const LightChoiceKind kind : {LightChoiceKind::Tree, LightChoiceKind::Power}) {
        world.lights = std::make_unique<LightChoice>(world.scene, kind);
        test::expect_techniques_agree(
            world, options, 8192,
            [](V2f u) { return ray_to(V3f(0, 0, 4), V3f(0.35f * u.x + 0.2f, u.y - 0.5f, 0)); },
            0.02);
    }
}

// A cube whose corners' normals are smooth by mistake stays a cube: its rays leave its faces.
TEST(Path, NormalsFarFromTheTriangleMeanNoSmoothSurface) {
    Scene scene;
    Mesh mesh = quad(V3f(-1, -1, 0), V3f(2, 0, 0), V3f(0, 2, 0));
    const float a = 1 / std::sqrt(3.f);
    mesh.normals = {V3f(-a, -a, a), V3f(a, -a, a), V3f(a, a, a), V3f(-a, a, a)};
    place(scene, mesh, diffuse_material(1.f));
    for (V3f& n : mesh.normals) n = unit(n + V3f(0, 0, 1));
    place(scene, mesh, diffuse_material(1.f));
    finish_scene(scene);
    const V3f down(0, 0, -1);
    const Hit hit{V2f(0.3f, 0.4f), 0, 0};
    EXPECT_FALSE(make_surface(scene, down, hit).lifted());
    EXPECT_EQ(make_surface(scene, down, hit).side, V3f(0, 0, 1));
    const Surface s = make_surface(scene, down, {V2f(0.3f, 0.4f), 1, 0});
    EXPECT_TRUE(s.lifted());
    EXPECT_GT(s.lift.z, 0.f);
    EXPECT_EQ(s.leaving_point(V3f(0, 0, 1)), s.p);
    // From behind, the same surface is a hollow, which needs no lift.
    EXPECT_FALSE(make_surface(scene, -down, {V2f(0.3f, 0.4f), 1, 0}).lifted());
}

}  // namespace
}  // namespace petzval::integrator
