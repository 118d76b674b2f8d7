// SPDX-License-Identifier: Apache-2.0
#include "integrator/path.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/spectrum/colour.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using test::diffuse_material;
using test::emitter_material;
using test::Mean;
using test::place;
using test::quad;
using test::sphere;
using test::World;

// Mean red radiance over a bundle of rays; the error comes from 32 independent replicates, as the
// points of one replicate are not independent.
template <class MakeRay>
Mean estimate(const World& world, const PathOptions& options, uint32_t samples,
              const MakeRay& make_ray, float* alpha = nullptr) {
    constexpr int replicates = 32;
    const PathTracer tracer(world.scene, *world.bvh, *world.lights, options);
    PathStats stats;
    test::Moments means;
    for (uint32_t seed = 0; seed < replicates; ++seed) {
        double mean = 0;
        for (uint32_t i = 0; i < samples; ++i) {
            const Sampler sampler(SamplerKind::Owen, seed, {3, 5, i});
            FilmSample out;
            mean += tracer.radiance(make_ray(sampler.get2(Dim::Film)), Bands::rgb(), sampler, false,
                                    out, stats)[0];
            if (alpha) *alpha += out.alpha / static_cast<float>(samples * replicates);
        }
        means.add(mean / samples);
    }
    return means;
}

Ray ray_to(V3f origin, V3f target) {
    Ray ray;
    ray.origin = origin;
    ray.direction = unit(target - origin);
    return ray;
}

// A bundle over the square [-0.5, 0.5]^2 at z = 0, seen from z = 4.
Ray bundle(V2f u) {
    return ray_to(V3f(0, 0, 4), V3f(u.x - 0.5f, u.y - 0.5f, 0));
}

// Sums of floats allow 1e-5 beside chance; chance is small, so that the test has teeth.
void expect_agrees(const Mean& e, double truth, const char* what) {
    EXPECT_TRUE(test::agrees(e, truth, 1e-5 * truth)) << what << ": " << e << ", not " << truth;
    EXPECT_LT(e.error, 0.005 * truth) << what;
}

// Inside a closed diffuse emitter radiance is emission / (1 - albedo), whatever its shape.
TEST(Path, ClosedSphereHasItsKnownRadiance) {
    World world;
    Mesh inside = sphere(V3f(0.f), 2.f, 16, false);
    place(world.scene, inside, emitter_material(0.7f, 0.6f));
    world.finish();
    PathOptions options;
    options.max_depth = 1000;
    for (const Technique technique : {Technique::Mis, Technique::BsdfOnly, Technique::LightOnly}) {
        options.technique = technique;
        const Mean e = estimate(world, options, 1024, [](V2f u) {
            return ray_to(V3f(0.3f, 0.2f, -0.1f), V3f(u.x * 6 - 3, u.y * 6 - 3, 1));
        });
        expect_agrees(e, 0.7 / (1 - 0.6), "closed sphere");
    }
}

TEST(Path, WhiteObjectsVanishInAWhiteSky) {
    for (const float metallic : {0.f, 1.f})
        for (const float roughness : {0.f, 0.3f, 1.f}) {
            World world;
            Material m;
            m.metallic = metallic;
            m.roughness = roughness;
            place(world.scene, sphere(V3f(0.f), 1.f, 48, true), m);
            world.scene.sky = Sky::uniform(Rgb(1.f));
            world.finish();
            PathOptions options;
            options.max_depth = 64;
            const Mean e = estimate(world, options, 2048, bundle);
            EXPECT_TRUE(test::agrees(e, 1, 0.005)) << metallic << ' ' << roughness << ": " << e;
            EXPECT_LT(e.error, 0.002) << metallic << ' ' << roughness;
        }
}

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
    const auto by = [&](Technique technique) {
        options.technique = technique;
        return estimate(world, options, 4096, bundle);
    };
    const Mean both = by(Technique::Mis);
    for (const Technique technique : {Technique::LightOnly, Technique::BsdfOnly}) {
        const Mean one = by(technique);
        EXPECT_TRUE(test::agrees(both - one, 0)) << both << " and " << one;
        EXPECT_LT(one.error, 0.01 * one.value);
    }
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
        const float seen = tracer.radiance(ray, Bands::rgb(), sampler, false, out, stats)[0];
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
        const auto by = [&](Technique technique) {
            options.technique = technique;
            return estimate(world, options, 8192, [](V2f u) {
                return ray_to(V3f(0, 0, 4), V3f(0.35f * u.x + 0.2f, u.y - 0.5f, 0));
            });
        };
        const Mean both = by(Technique::Mis);
        for (const Technique technique : {Technique::LightOnly, Technique::BsdfOnly}) {
            const Mean one = by(technique);
            EXPECT_TRUE(test::agrees(both - one, 0)) << both << " and " << one;
            EXPECT_LT(one.error, 0.02 * one.value);
        }
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
    const Hit hit{1.f, V2f(0.3f, 0.4f), 0, 0};
    EXPECT_FALSE(make_surface(scene, down, hit).lifted());
    EXPECT_EQ(make_surface(scene, down, hit).side, V3f(0, 0, 1));
    const Surface s = make_surface(scene, down, {1.f, V2f(0.3f, 0.4f), 1, 0});
    EXPECT_TRUE(s.lifted());
    EXPECT_GT(s.lift.z, 0.f);
    EXPECT_EQ(s.leaving_point(V3f(0, 0, 1)), s.p);
    // From behind, the same surface is a hollow, which needs no lift.
    EXPECT_FALSE(make_surface(scene, -down, {1.f, V2f(0.3f, 0.4f), 1, 0}).lifted());
}

// A solid glass ball takes nothing away from a white sky.
TEST(Path, ClearGlassVanishesInAWhiteSky) {
    World world;
    Material m;
    m.metallic = 0;
    m.roughness = 0;
    m.transmission = 1;
    m.has_volume = true;
    place(world.scene, sphere(V3f(0.f), 1.f, 64, true), m);
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    PathOptions options;
    options.max_depth = 200;
    const Mean e = estimate(world, options, 2048, bundle);
    // Facets and smooth normals disagree at the rim.
    EXPECT_TRUE(test::agrees(e, 1, 0.01)) << e;
    EXPECT_LT(e.error, 0.002);
}

TEST(Path, AbsorptionFollowsBeerAndLambert) {
    World world;
    Material m;
    m.metallic = 0;
    m.roughness = 0;
    m.transmission = 1;
    m.ior = 1;  // nothing bends or reflects: only the way inside counts
    m.has_volume = true;
    m.attenuation_color = Rgb(0.25f);
    m.attenuation_distance_m = 0.5f;
    place(world.scene, quad(V3f(-2, -2, 0), V3f(4, 0, 0), V3f(0, 4, 0)), m);
    place(world.scene, quad(V3f(-2, -2, -1), V3f(0, 4, 0), V3f(4, 0, 0)), m);
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    const Mean e =
        estimate(world, PathOptions(), 64, [](V2f) { return ray_to(V3f(0, 0, 3), V3f(0.f)); });
    EXPECT_NEAR(e.value, std::pow(0.25, 1.0 / 0.5), 1e-4);
}

// The camera may stand in the volume: what lies between it and the back of a face counts.
TEST(Path, ACameraInsideAVolumeSeesItsAbsorption) {
    World world;
    Material m;
    m.metallic = 0;
    m.roughness = 0;
    m.transmission = 1;
    m.ior = 1;
    m.has_volume = true;
    m.attenuation_color = Rgb(0.25f);
    m.attenuation_distance_m = 0.5f;
    place(world.scene, quad(V3f(-2, -2, 0), V3f(4, 0, 0), V3f(0, 4, 0)), m);
    place(world.scene, quad(V3f(-2, -2, -1), V3f(0, 4, 0), V3f(4, 0, 0)), m);
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    const auto seen = [&](V3f eye, V3f target) {
        return estimate(world, PathOptions(), 64, [&](V2f) { return ray_to(eye, target); }).value;
    };
    for (const float depth : {0.25f, 0.5f, 1.f - 1e-6f})
        EXPECT_NEAR(seen(V3f(0, 0, -1 + depth), V3f(0, 0, -2)), std::pow(0.25, double(depth) / 0.5),
                    1e-4)
            << depth;
    // Aslant: the way is longer.
    EXPECT_NEAR(seen(V3f(0, 0, -0.5f), V3f(0.5f, 0, 0)), std::pow(0.25, 0.5 * std::sqrt(2.) / 0.5),
                1e-4);
    EXPECT_NEAR(seen(V3f(0, 0, 3), V3f(0.f)), std::pow(0.25, 1 / 0.5), 1e-4);
    EXPECT_NEAR(seen(V3f(0, 0, -3), V3f(0, 0, -4)), 1, 1e-6);
}

// A path that has left an inner volume is in the outer one again, as the next face says.
TEST(Path, TheOuterVolumeAbsorbsBehindTheInnerOne) {
    World world;
    const auto slab = [&](float front, float back, float colour) {
        Material m;
        m.metallic = 0;
        m.roughness = 0;
        m.transmission = 1;
        m.ior = 1;
        m.has_volume = true;
        m.attenuation_color = Rgb(colour);
        m.attenuation_distance_m = 1;
        place(world.scene, quad(V3f(-2, -2, front), V3f(4, 0, 0), V3f(0, 4, 0)), m);
        place(world.scene, quad(V3f(-2, -2, back), V3f(0, 4, 0), V3f(4, 0, 0)), m);
    };
    slab(0, -4, 0.5f);
    slab(-1, -2, 0.25f);
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    PathOptions options;
    options.roulette_depth = 16;
    const Mean e = estimate(world, options, 4, [](V2f) { return ray_to(V3f(0, 0, 3), V3f(0.f)); });
    EXPECT_NEAR(e.value, 0.5 * 0.25 * 0.25, 1e-4);
}

// Light on its way through a volume is absorbed whichever technique finds it.
TEST(Path, TechniquesAgreeInsideAVolume) {
    World world;
    Material m;
    m.metallic = 0;
    m.roughness = 0.6f;
    m.transmission = 1;
    m.ior = 1.2f;
    m.has_volume = true;
    m.attenuation_color = Rgb(0.5f);
    m.attenuation_distance_m = 1.5f;
    place(world.scene, sphere(V3f(0.f), 1.5f, 24, false), m);
    place(world.scene, quad(V3f(-0.6f, -0.6f, 0.2f), V3f(1.2f, 0, 0), V3f(0, 1.2f, 0)),
          diffuse_material(0.7f));
    place(world.scene, quad(V3f(-0.5f, 0.7f, 0.3f), V3f(1, 0, 0), V3f(0, 0, 0.7f)),
          emitter_material(5.f));
    world.finish();
    PathOptions options;
    options.max_depth = 6;
    const auto by = [&](Technique technique) {
        options.technique = technique;
        return estimate(world, options, 8192, bundle);
    };
    const Mean both = by(Technique::Mis);
    for (const Technique technique : {Technique::LightOnly, Technique::BsdfOnly}) {
        const Mean one = by(technique);
        EXPECT_TRUE(test::agrees(both - one, 0)) << both << " and " << one;
        EXPECT_LT(one.error, 0.03 * one.value);
    }
}

World floor_under(Light light) {
    World world;
    place(world.scene, quad(V3f(-50, -50, 0), V3f(100, 0, 0), V3f(0, 100, 0)),
          diffuse_material(0.5f));
    world.scene.lights.push_back(light);
    world.finish();
    return world;
}

TEST(Path, PunctualLightsGiveTheirIlluminance) {
    const auto centre = [](V2f) { return ray_to(V3f(0, 0, 4), V3f(0.f)); };
    const double albedo_over_pi = 0.5 / std::numbers::pi;
    const World point = floor_under(PointLight{V3f(0, 3, 4), Rgb(100.f)});
    expect_agrees(estimate(point, PathOptions(), 16, centre), albedo_over_pi * 100 / 25 * 0.8,
                  "point");
    const World sun = floor_under(SunLight{unit(V3f(0, -3, -4)), Rgb(10.f)});
    expect_agrees(estimate(sun, PathOptions(), 16, centre), albedo_over_pi * 10 * 0.8, "sun");
    const World spot = floor_under(SpotLight{V3f(0, 0, 2), V3f(0, 0, -1), Rgb(8.f), 0.9f, 0.8f});
    expect_agrees(estimate(spot, PathOptions(), 16, centre), albedo_over_pi * 8 / 4, "spot");
}

// A disk's worth of closed form: a square emitter seen from below its centre. Configuration factor
// of a differential plane to a parallel rectangle corner, times four (Howell, C-11).
TEST(Path, SquareEmitterMatchesItsConfigurationFactor) {
    World world;
    place(world.scene, quad(V3f(-50, -50, 0), V3f(100, 0, 0), V3f(0, 100, 0)),
          diffuse_material(0.5f));
    Material light = emitter_material(3.f);
    place(world.scene, quad(V3f(-1, -1, 2), V3f(0, 2, 0), V3f(2, 0, 0)), light);
    world.finish();
    const double a = 0.5, b = 0.5;  // half sides over the distance
    const double corner = 1 / (2 * std::numbers::pi) *
                          (a / std::sqrt(1 + a * a) * std::atan(b / std::sqrt(1 + a * a)) +
                           b / std::sqrt(1 + b * b) * std::atan(a / std::sqrt(1 + b * b)));
    const double truth = 0.5 * 3 * 4 * corner;
    PathOptions options;
    options.max_depth = 1;
    for (const Technique technique : {Technique::Mis, Technique::LightOnly, Technique::BsdfOnly}) {
        options.technique = technique;
        const Mean e =
            estimate(world, options, 4096, [](V2f) { return ray_to(V3f(3, 0, 1.9f), V3f(0.f)); });
        expect_agrees(e, truth, "square");
    }
}

// Three estimators of one integral: lights only, BSDF only, both.
TEST(Path, TechniquesAgree) {
    World world;
    Material floor;
    floor.base_color = Rgb(0.6f);
    floor.metallic = 0.3f;
    floor.roughness = 0.4f;
    floor.double_sided = true;
    place(world.scene, quad(V3f(-3, -3, -1), V3f(6, 0, 0), V3f(0, 6, 0)), floor);
    place(world.scene, sphere(V3f(0, 0, 0), 0.6f, 24, true), diffuse_material(0.7f));
    place(world.scene, quad(V3f(-1, 1.5f, 1), V3f(2, 0, 0), V3f(0, 1, 0.5f)),
          emitter_material(5.f));
    std::vector<float> sky(3 * 32 * 16, 0.2f);
    for (int i = 0; i < 12; ++i) sky[3 * (4 * 32 + 3 * 4) + static_cast<size_t>(i)] = 20.f;
    world.scene.sky = Sky::picture(sky, 32, 16, 0.f, 1.f);
    world.finish();
    PathOptions options;
    options.max_depth = 4;
    const auto by = [&](Technique technique) {
        options.technique = technique;
        return estimate(world, options, 4096, [](V2f u) {
            return ray_to(V3f(0, 0.5f, 4), V3f(2 * u.x - 1, 2 * u.y - 1, -0.5f));
        });
    };
    const Mean both = by(Technique::Mis);
    for (const Technique technique : {Technique::LightOnly, Technique::BsdfOnly}) {
        const Mean one = by(technique);
        EXPECT_TRUE(test::agrees(both - one, 0)) << both << " and " << one;
        EXPECT_LT(one.error, 0.01 * one.value);
        EXPECT_LE(both.error, one.error);  // what combining the two is for
    }
}

// The same by the light tree, whose probabilities depend on the vertex: emitters of one side and of
// two, a bulb and a sky, a glossy floor below and a pane that transmits.
TEST(Path, TechniquesAgreeWithTheLightTree) {
    World world;
    Material floor = diffuse_material(0.6f);
    floor.metallic = 0.3f;
    floor.roughness = 0.4f;
    place(world.scene, quad(V3f(-3, -3, -1), V3f(6, 0, 0), V3f(0, 6, 0)), floor);
    Material pane = diffuse_material(0.9f);
    pane.transmission = 0.7f;
    pane.roughness = 0.5f;
    place(world.scene, quad(V3f(-0.5f, -0.5f, 0.2f), V3f(1, 0, 0), V3f(0, 1, 0.3f)), pane);
    Material one_sided = emitter_material(5.f);
    one_sided.double_sided = false;
    place(world.scene, quad(V3f(-1, 1.5f, 1), V3f(2, 0, 0), V3f(0, 1, 0.5f)), one_sided);
    place(world.scene, quad(V3f(-1.5f, -1, -0.6f), V3f(0, 0.4f, 0), V3f(0, 0, 0.4f)),
          emitter_material(8.f, 0.5f));
    place(world.scene, sphere(V3f(1, -0.5f, -0.5f), 0.2f, 8, false), emitter_material(3.f, 0.2f));
    world.scene.sky = Sky::uniform(Rgb(0.05f));
    world.finish();
    PathOptions options;
    options.max_depth = 4;
    const auto measure = [&](Technique technique, LightChoiceKind kind) {
        options.technique = technique;
        world.lights = std::make_unique<LightChoice>(world.scene, kind);
        return estimate(world, options, 8192, [](V2f u) {
            return ray_to(V3f(0, -0.5f, 4), V3f(2 * u.x - 1, 2 * u.y - 1, -0.5f));
        });
    };
    const Mean mis = measure(Technique::Mis, LightChoiceKind::Tree);
    for (const Mean& other : {measure(Technique::LightOnly, LightChoiceKind::Tree),
                              measure(Technique::BsdfOnly, LightChoiceKind::Tree),
                              measure(Technique::Mis, LightChoiceKind::Power)}) {
        EXPECT_TRUE(test::agrees(mis - other, 0)) << mis << " and " << other;
        EXPECT_LT(other.error, 0.01 * other.value);
    }
}

TEST(Path, CoverageMixesSurfaceAndSky) {
    World world;
    Material m = diffuse_material(0.f);
    m.alpha_mode = AlphaMode::Blend;
    m.alpha = 0.25f;
    place(world.scene, quad(V3f(-2, -2, 0), V3f(4, 0, 0), V3f(0, 4, 0)), m);
    world.scene.sky = Sky::uniform(Rgb(2.f));
    world.finish();
    expect_agrees(estimate(world, PathOptions(), 4096, bundle), 0.75 * 2, "blend");
    PathOptions options;
    options.transparent = true;
    float alpha = 0;
    const Mean e = estimate(world, options, 4096, bundle, &alpha);
    EXPECT_EQ(e.value, 0.0);
    EXPECT_NEAR(alpha, 0.25f, 0.01f);
}

TEST(Path, BacksOfSingleSidedSurfacesAreCulledFromViewButCastShadows) {
    World world;
    Material m = diffuse_material(0.5f);
    m.double_sided = false;
    place(world.scene, quad(V3f(-2, -2, 0), V3f(0, 4, 0), V3f(4, 0, 0)), m);  // front away from us
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    EXPECT_NEAR(estimate(world, PathOptions(), 16, bundle).value, 1.0, 1e-5);

    World shaded;
    place(shaded.scene, quad(V3f(-50, -50, -1), V3f(100, 0, 0), V3f(0, 100, 0)),
          diffuse_material(0.5f));
    place(shaded.scene, quad(V3f(-2, -2, 0), V3f(0, 4, 0), V3f(4, 0, 0)), m);
    shaded.scene.lights.push_back(SunLight{V3f(0, 0, -1), Rgb(10.f)});
    shaded.finish();
    PathOptions direct;
    direct.max_depth = 1;
    EXPECT_EQ(estimate(shaded, direct, 16, bundle).value, 0.0);
}

TEST(Path, BackdropIsSeenAndTheEnvironmentLights) {
    World world;
    place(world.scene, quad(V3f(-2, -2, 0), V3f(4, 0, 0), V3f(0, 4, 0)), diffuse_material(0.5f));
    world.scene.sky = Sky::uniform(Rgb(2.f));
    world.finish();
    PathOptions options;
    options.visible_background = Rgb(7.f);
    EXPECT_NEAR(
        estimate(world, options, 16, [](V2f) { return ray_to(V3f(0, 0, 4), V3f(9, 9, 4)); }).value,
        7.0, 1e-5);
    expect_agrees(estimate(world, options, 1024, bundle), 0.5 * 2, "lit by the environment");
}

TEST(Path, UnlitShowsItsColour) {
    World world;
    Material m = diffuse_material(0.4f);
    m.unlit = true;
    place(world.scene, quad(V3f(-2, -2, 0), V3f(4, 0, 0), V3f(0, 4, 0)), m);
    world.finish();
    EXPECT_NEAR(estimate(world, PathOptions(), 16, bundle).value, 0.4, 1e-6);
}

}  // namespace
}  // namespace petzval
