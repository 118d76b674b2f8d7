// SPDX-License-Identifier: Apache-2.0
// Surfaces that were measured: metals by their indices, and curves of reflectance.
#include <gtest/gtest.h>

#include "core/spectrum/colour.h"
#include "io/spectra/spectra.h"
#include "tests/support/set_up_observer.h"
#include "tests/support/traced_world.h"

namespace petzval::apps {
namespace {

using test::diffuse_material;
using test::observer_of;
using test::place;
using test::quad;
using World = test::TracedWorld;

// The four metals at normal incidence, by the way that a path goes: scene, material, BSDF.
TEST(MeasuredReflectance, MetalsReflectAsTheirIndicesSay) {
    const Observer observer = observer_of({});
    for (const char* name : {"ag", "al", "au", "cu"}) {
        const Metal metal = *io::find_metal(name);
        World world;
        Material m;
        m.roughness = 0;
        m.metal = 0;
        world.scene.metals.push_back(metal);
        place(world.scene, quad(V3f(-1, -1, 0), V3f(2, 0, 0), V3f(0, 2, 0)), m);
        world.finish();
        Ray ray;
        ray.origin = V3f(0.1f, 0.2f, 1);
        ray.direction = V3f(0, 0, -1);
        const auto hit = world.bvh->intersect(ray);
        ASSERT_TRUE(hit);
        const Surface s = make_surface(world.scene, ray.direction, *hit);
        const f4 nm{400, 500, 587.5f, 700};
        const Bands bands = observer.at(nm, splat(1.f), m4{-1, -1, -1, -1});
        const ShadingInput shading = read_material(world.scene, s, -ray.direction, bands);
        const Bsdf bsdf(shading.bsdf, bands, V3f(0, 0, 1));
        const auto sample = bsdf.sample(0.5f, {0.5f, 0.5f});
        ASSERT_TRUE(sample);
        for (int i = 0; i < 4; ++i) {
            const double n = metal.n.at(nm[i]), k = metal.k.at(nm[i]);
            EXPECT_NEAR(sample->weight[i],
                        ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k), 2e-6)
                << name << ' ' << nm[i];
        }
    }
}

// A curve is the colour of its surface: of its texture only the holes count, and colours of
// vertices multiply it, as glTF has them multiply the factor.
TEST(MeasuredReflectance, AMeasuredReflectanceIsTheBaseColour) {
    World world;
    Scene& scene = world.scene;
    scene.reflectances.push_back(*io::find_reflectance("colorchecker:yellow"));
    Material m = diffuse_material(0.f);
    m.reflectance = 0;
    m.base_color = scene.reflectances[0].rgb;
    scene.images.push_back(Image{"dark", 1, 1, std::vector<uint8_t>{25, 50, 75, 255}});
    m.base_color_texture.image = 0;
    Mesh plain = quad(V3f(-1, -1, 0), V3f(1, 0, 0), V3f(0, 2, 0)),
         coloured = quad(V3f(0, -1, 0), V3f(1, 0, 0), V3f(0, 2, 0)),
         glossy = quad(V3f(1, -1, 0), V3f(1, 0, 0), V3f(0, 2, 0));
    coloured.colours.assign(4, V4f(0.5f, 0.5f, 0.5f, 0.3f));
    place(scene, plain, m);
    place(scene, coloured, m);
    m.specular_glossiness = true;
    m.specular_color = Rgb(0.2f, 0.75f, 0.1f);
    place(scene, glossy, m);
    world.finish();
    const f4 nm{400, 500, 587.5f, 700};
    const Bands bands = observer_of({}).at(nm, splat(1.f), m4{-1, -1, -1, 0});
    const auto base_of = [&](float x, const Bands& of) {
        Ray ray;
        ray.origin = V3f(x, 0.2f, 1);
        ray.direction = V3f(0, 0, -1);
        const Surface s = make_surface(scene, ray.direction, *world.bvh->intersect(ray));
        return read_material(scene, s, -ray.direction, of).bsdf.base_color;
    };
    for (const auto& [x, factor] : {std::pair{-0.4f, 1.f}, {0.4f, 0.5f}, {1.4f, 0.25f}}) {
        const f4 base = base_of(x, bands), rgb = base_of(x, Bands::rgb());
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(base[i], factor * scene.reflectances[0].share.at(nm[i]), 1e-6) << x;
            EXPECT_NEAR(rgb[i], factor * scene.reflectances[0].rgb[i], 1e-6) << x;
        }
        EXPECT_EQ(base[3], 0) << "a lane that is off";
    }
}

}  // namespace
}  // namespace petzval::apps
