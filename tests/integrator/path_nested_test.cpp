// SPDX-License-Identifier: Apache-2.0
// Glass in glass: absorption and refraction where volumes overlap, touch and hold the camera.
#include "tests/integrator/path_estimate.h"

namespace petzval::integrator {
namespace {

using test::agrees;
using test::append;
using test::box;
using test::estimate;
using test::glass_material;
using test::Mean;
using test::place;
using test::ray_to;
using test::sphere;
using test::World;

PathOptions no_roulette() {
    PathOptions options;
    options.roulette_depth = 1000;
    return options;
}

// A layer across the z axis.
Mesh layer(float front_z, float back_z, float half_width = 2) {
    return box(V3f(-half_width, -half_width, back_z), V3f(half_width, half_width, front_z));
}

struct Layer {
    float front_z, back_z, ior, attenuation;
    float half_width = 2;
};

World of_layers(std::vector<Layer> layers, bool reversed = false) {
    World world;
    if (reversed) std::reverse(layers.begin(), layers.end());
    for (const Layer& l : layers)
        place(world.scene, layer(l.front_z, l.back_z, l.half_width),
              glass_material(l.ior, l.attenuation));
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    return world;
}

Mean nested_seen(const World& world, V3f eye, V3f target, uint32_t samples = 16) {
    return estimate(world, no_roulette(), samples, [&](V2f) { return ray_to(eye, target); });
}

// Layers of index 1: what is left is the product over what fills each part of the way.
TEST(NestedVolumes, AbsorbAsWhatFillsSpace) {
    struct Case {
        const char* what;
        std::vector<Layer> layers;
        double due;
    };
    const Case cases[] = {
        {"inside", {{0, -4, 1, 0.5f}, {-1, -2, 1, 0.25f}}, 0.125 * 0.25},
        {"three",
         {{0, -6, 1, 0.5f}, {-1, -5, 1, 0.8f, 1.9f}, {-2, -3, 1, 0.25f, 1.8f}},
         0.25 * std::pow(0.8, 3) * 0.25},
        // They overlap by a metre, which the smaller one has.
        {"overlap", {{0, -3, 1, 0.5f}, {-2, -4, 1, 0.25f}}, 0.25 * 0.0625},
        {"overlap before", {{0, -2, 1, 0.25f}, {-1, -4, 1, 0.5f}}, 0.0625 * 0.25},
        // They touch.
        {"touch", {{0, -3, 1, 0.5f}, {-3, -4, 1, 0.25f}}, 0.125 * 0.25},
        {"touch from within", {{0, -3, 1, 0.5f}, {-2, -3, 1, 0.25f}}, 0.25 * 0.25},
        {"touch at the front", {{0, -3, 1, 0.5f}, {0, -1, 1, 0.25f}}, 0.25 * 0.25},
    };
    for (const Case& c : cases)
        for (const bool reversed : {false, true}) {
            const World world = of_layers(c.layers, reversed);
            EXPECT_NEAR(nested_seen(world, V3f(0.1f, 0.2f, 3), V3f(0.1f, 0.2f, 0)).value, c.due,
                        1e-4 * c.due)
                << c.what;
            EXPECT_NEAR(nested_seen(world, V3f(0.3f, 0.1f, -9), V3f(0.3f, 0.1f, 0)).value, c.due,
                        1e-4 * c.due)
                << c.what << ", from behind";
        }
}

// The same, seen aslant from far, where t is rounded more than points: no face is missed.
TEST(NestedVolumes, FacesThatCoincideAreOneBoundaryFromAfar) {
    const World world = of_layers({{0, -3, 1, 0.5f, 40}, {-2, -3, 1, 0.25f, 39}});
    for (int i = 0; i < 200; ++i) {
        const float a = 0.01f * static_cast<float>(i);
        const V3f eye(900 * std::sin(a), 3, 900 * std::cos(a) + 2);
        if (std::fabs(eye.z) < 100) continue;
        const V3f target(0.37f, 0.11f, -1.5f);
        const V3f way = target - eye;
        // What stands for an index of 1 is 1.001.
        const double sine = double(std::hypot(way.x, way.y) / way.length()) / 1.001;
        const double slant = 1 / std::sqrt(1 - sine * sine);
        if (slant > 1.7) continue;  // it reflects more than comes through
        const double due = std::pow(0.25, slant) * std::pow(0.25, slant);
        EXPECT_NEAR(nested_seen(world, eye, target, 1).value, due, 2e-3 * due) << i;
    }
}

// Turned and moved, so that the corners of faces that coincide are rounded apart.
struct Turned {
    M44f turn;
    V3f centre{3, 5, -7};

    Turned() { turn.setAxisAngle(V3f(0.6f, -0.3f, 0.74f), 1.1f); }
    [[nodiscard]] V3f operator()(const V3f& p) const {
        V3f q;
        turn.multVecMatrix(p, q);
        return q + centre;
    }
    [[nodiscard]] Mesh operator()(Mesh mesh) const {
        for (V3f& p : mesh.positions) p = (*this)(p);
        return mesh;
    }
};

double reflectance(double a, double b) {
    return std::pow((a - b) / (a + b), 2);
}

// The front of a small volume coincides with that of a large one, or lies a little before it or
// behind it, as seen from near and from far, where t is rounded more than points are. Bodies
// of each overlap, so that nothing puts a wrong count right.
TEST(NestedVolumes, FacesThatNearlyCoincideAreEachCrossedOnce) {
    const Turned turned;
    for (const float off : {0.f, 1e-6f, -1e-6f, 1e-5f, -1e-5f, 3e-5f, -3e-5f, 1e-4f, -1e-4f})
        for (const float from : {2.f, 800.f}) {
            World world;
            Mesh large = layer(0, -2.9f, 40);
            append(large, layer(-2.5f, -3, 39));
            place(world.scene, turned(large), glass_material(1.33f, 0.5f));
            Mesh bodies = layer(off, -0.8f, 1.3f);
            append(bodies, layer(-0.6f, -1, 1.2f));
            place(world.scene, turned(bodies), glass_material(1.6f, 0.25f));
            // Only what goes through is seen.
            place(world.scene, turned(test::quad(V3f(-30, -30, -4), V3f(60, 0, 0), V3f(0, 60, 0))),
                  test::emitter_material(1));
            world.finish();
            ASSERT_TRUE(world.scene.materials[0].overlaps_itself);
            ASSERT_TRUE(world.scene.materials[1].overlaps_itself);
            // One boundary, or two of them. Ways to and fro within add less than 1 %.
            const double one = 1 - reflectance(1, 1.6);
            const double two = (1 - reflectance(1, 1.33)) * (1 - reflectance(1.33, 1.6));
            const double rest =
                (1 - reflectance(1.6, 1.33)) * (1 - reflectance(1.33, 1)) * 0.25 * 0.25;
            const Mean mean = estimate(world, no_roulette(), 128, [&](V2f u) {
                const V3f p(u.x - 0.5f, u.y - 0.5f, 0), eye(p.x, p.y, from);
                return ray_to(turned(eye), turned(p));
            });
            EXPECT_GT(mean.value, one * rest - 4 * mean.error) << off << " from " << from;
            EXPECT_LT(mean.value, 1.01 * two * rest + 4 * mean.error) << off << " from " << from;
            EXPECT_LT(mean.error, 0.01 * rest) << off << " from " << from;
        }
}

// Faces that count as one boundary, as seen from far, do not shade each other: light samples
// leave clear of both.
TEST(NestedVolumes, FacesThatCoincideDoNotShadeEachOther) {
    const Turned turned;
    const auto light = [&](bool coincide) {
        World world;
        if (coincide) place(world.scene, turned(layer(0, -3, 40)), glass_material(1.f, 1e-30f));
        Material rough = glass_material(1.6f, 1e-30f);
        rough.roughness = 0.6f;
        place(world.scene, turned(layer(-5e-5f, -1, 1.3f)), rough);
        world.scene.lights.push_back(PointLight{turned(V3f(0.3f, 0.4f, 2)), Rgb(1.f)});
        world.finish();
        return estimate(world, PathOptions(), 512, [&](V2f u) {
            const V3f p(u.x - 0.5f, u.y - 0.5f, 0);
            return ray_to(turned(p + V3f(100, 0, 800)), turned(p));
        });
    };
    const Mean apart = light(false), together = light(true);
    EXPECT_TRUE(agrees(apart - together, 0)) << apart << " and " << together;
    EXPECT_LT(together.error, 0.01 * together.value);
}

// Fresnel's equations at the boundary between two media, not between each and air: what comes back
// from one face inside, where the outer medium is black to what goes on.
TEST(NestedVolumes, ReflectByTheIndexOfBothSides) {
    for (const auto& [inner, transmission] :
         {std::pair{1.001, 1.f}, {1.31, 1.f}, {1.6, 1.f}, {2.4, 1.f}, {1.001, 0.4f}, {1.6, 0.4f}}) {
        World world;
        place(world.scene, box(V3f(-50), V3f(50)), glass_material(1.33f));
        // Dense: what goes in does not come out.
        Material m = glass_material(static_cast<float>(inner), 1e-30f);
        m.base_color = Rgb(0.f);  // of its share that is not glass
        m.transmission = transmission;
        place(world.scene, box(V3f(-20, -20, -20), V3f(20, 20, 0)), m);
        place(world.scene, test::quad(V3f(-9, -9, 40), V3f(0, 18, 0), V3f(18, 0, 0)),
              test::emitter_material(1));
        world.finish();
        const Mean e = estimate(world, no_roulette(), 4096,
                                [](V2f) { return ray_to(V3f(0.1f, 0.1f, 4), V3f(0.1f, 0.1f, 0)); });
        EXPECT_TRUE(agrees(e, reflectance(1.33, inner), 1e-5)) << inner << ": " << e;
    }
}

// A ray through layers bends as if each stood in air: Snell's invariant n sin.
TEST(NestedVolumes, RefractByTheIndexOfBothSides) {
    World world;
    place(world.scene, layer(0, -3, 30), glass_material(1.33f));
    place(world.scene, layer(-1, -2, 29), glass_material(1.8f));
    // Lamps as a ruler behind: 1 to the right of where the ray should land, 0 to the left.
    const double sine = std::sin(0.6);
    const auto shift = [&](double n) { return std::tan(std::asin(sine / n)); };
    const double lands = std::tan(0.6) + 2 * shift(1.33) + shift(1.8) + std::tan(0.6);
    for (const double off : {-0.002, 0.002}) {
        World ruled;
        ruled.scene = world.scene;
        Material lamp = test::emitter_material(1.f);
        place(
            ruled.scene,
            test::quad(V3f(static_cast<float>(lands + off), -9, -4), V3f(18, 0, 0), V3f(0, 18, 0)),
            lamp);
        ruled.finish();
        const Mean e = estimate(ruled, no_roulette(), 256, [](V2f) {
            Ray ray;
            ray.origin = V3f(0, 0, 1);
            ray.direction = V3f(std::sin(0.6f), 0, -std::cos(0.6f));
            return ray;
        });
        if (off < 0)
            EXPECT_GT(e.value, 0.5);
        else
            EXPECT_LT(e.value, 0.1);
    }
}

// What is seen through a slab of 3 m whose faces lie within clear volumes of higher
// priority, half a metre to each side.
double seen_with_hidden_faces(const Material& m) {
    World world;
    place(world.scene, layer(0, -3, 40), m);
    place(world.scene, layer(0.5f, -0.5f), glass_material(1));
    place(world.scene, layer(-2.5f, -3.5f), glass_material(1));
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    return nested_seen(world, V3f(0.1f, 0.2f, 3), V3f(0.1f, 0.2f, 0)).value;
}

// The face's roughness and tint are not there either.
TEST(NestedVolumes, HiddenFacesDoNothing) {
    Material rough = glass_material(1, 0.5f);
    rough.roughness = 0.5f;
    rough.base_color = Rgb(0.5f);
    EXPECT_NEAR(seen_with_hidden_faces(rough), 0.25, 1e-4);
}

TEST(NestedVolumes, HiddenFacesGlow) {
    Material glows = glass_material(1, 0.5f);
    glows.emissive = Rgb(1.f);
    EXPECT_NEAR(seen_with_hidden_faces(glows), 1.25, 1e-4);
}

// Of faces that coincide, that of the higher priority shades: the other's tint does not count.
TEST(NestedVolumes, TheFaceOfTheHigherPriorityShades) {
    for (const bool reversed : {false, true}) {
        World world;
        Material tinted = glass_material(1);
        tinted.base_color = Rgb(0.5f);
        const auto large = [&] { place(world.scene, layer(0, -3), tinted); };
        const auto small = [&] { place(world.scene, layer(-3, -4), glass_material(1)); };
        if (reversed)
            small(), large();
        else
            large(), small();
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish();
        EXPECT_NEAR(nested_seen(world, V3f(0.1f, 0.2f, 3), V3f(0.1f, 0.2f, 0)).value, 0.5, 1e-4);
        EXPECT_NEAR(nested_seen(world, V3f(0.1f, 0.2f, -9), V3f(0.1f, 0.2f, 0)).value, 0.5, 1e-4);
    }
}

// A hidden face stands between a floor and a lamp: shadow rays end there, so that paths alone must
// bring all of the light.
TEST(NestedVolumes, ALampBeyondAHiddenFaceIsFoundWhole) {
    const auto light = [](bool divided) {
        World world;
        place(world.scene, box(V3f(-2), V3f(2)), glass_material(1.2f));
        if (divided)
            place(world.scene, box(V3f(-50, -50, -50), V3f(50, 50, 0)), glass_material(1.3f));
        place(world.scene, test::quad(V3f(-1, -1, -1.5f), V3f(2, 0, 0), V3f(0, 2, 0)),
              test::diffuse_material(0.8f));
        place(world.scene, test::quad(V3f(-1, -1, 1.5f), V3f(0, 2, 0), V3f(2, 0, 0)),
              test::emitter_material(1.f));
        world.finish();
        PathOptions options;
        options.max_depth = 2;
        options.max_specular_depth = 4;
        return estimate(world, options, 1024,
                        [](V2f) { return ray_to(V3f(0.1f, 0.2f, 1), V3f(0.1f, 0.2f, -1)); });
    };
    const Mean whole = light(false), divided = light(true);
    EXPECT_TRUE(agrees(whole - divided, 0, 0.01 * whole.value)) << whole << " and " << divided;
    EXPECT_LT(divided.error, 0.01 * divided.value);
    EXPECT_GT(whole.value, 0.05);
}

TEST(NestedVolumes, AClearNestVanishesInAWhiteSky) {
    World world;
    place(world.scene, sphere(V3f(0.f), 1.f, 32, false), glass_material(1.5f));
    place(world.scene, sphere(V3f(0.2f, 0, 0), 0.6f, 32, false), glass_material(1.0f));
    place(world.scene, sphere(V3f(0.2f, 0.3f, 0), 0.5f, 32, false), glass_material(2.0f));
    Material rough = glass_material(1.33f);
    rough.roughness = 0.5f;
    place(world.scene, box(V3f(-0.3f), V3f(0.8f)), rough);
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    PathOptions options;
    options.max_depth = 200;
    const Mean e = estimate(world, options, 2048, test::bundle);
    EXPECT_TRUE(agrees(e, 1, 0.004)) << e;  // rough glass keeps 99.0 to 100.3 %
    EXPECT_LT(e.error, 0.003);
}

// Two cubes of one material that touch are one block.
TEST(NestedVolumes, BodiesOfOneMaterialThatTouchAreOne) {
    World world;
    Mesh two = box(V3f(-2, -2, -1), V3f(2, 2, 0));
    append(two, box(V3f(-2, -2, -2), V3f(2, 2, -1)));
    Material m = glass_material(2.f, 0.5f);
    place(world.scene, two, m);
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    World block;
    place(block.scene, layer(0, -2), m);
    block.scene.sky = Sky::uniform(Rgb(1.f));
    block.finish();
    const V3f eye(0.3f, 0.2f, 3), target(0.1f, 0.2f, 0);
    const Mean a = nested_seen(world, eye, target, 2048), b = nested_seen(block, eye, target, 2048);
    EXPECT_TRUE(agrees(a - b, 0)) << a << " and " << b;
    EXPECT_LT(a.error, 0.01);
}

TEST(NestedVolumes, TheCameraKnowsWhereItStands) {
    const World world = of_layers({{0, -4, 1, 0.5f}, {-1, -2, 1, 0.25f}, {-5, -6, 1, 0.1f}});
    const std::pair<float, double> cases[] = {{1, 0.125 * 0.25 * 0.1},
                                              {-0.5f, std::pow(0.5, 2.5) * 0.25 * 0.1},
                                              {-1.5f, 0.25 * 0.5 * 0.1},
                                              {-3.f, 0.05},
                                              {-4.5f, 0.1},
                                              {-5.5f, std::pow(0.1, 0.5)},
                                              {-7, 1}};
    for (const auto& [z, due] : cases)
        EXPECT_NEAR(nested_seen(world, V3f(0.3f, 0.2f, z), V3f(0.3f, 0.2f, -20)).value, due,
                    1e-4 * due)
            << z;
    // A lamp ahead of the next face: nothing on the way says where the camera is.
    World with_lamp;
    with_lamp.scene = world.scene;
    place(with_lamp.scene, test::quad(V3f(-1, -1, -3.5f), V3f(2, 0, 0), V3f(0, 2, 0)),
          test::emitter_material(1.f));
    with_lamp.finish();
    EXPECT_NEAR(nested_seen(with_lamp, V3f(0.3f, 0.2f, -3), V3f(0.3f, 0.2f, -20)).value,
                std::sqrt(0.5), 1e-4);
}

// A lone volume, and what is seen in it is no face of glass.
TEST(NestedVolumes, TheCameraKnowsThatItIsInWater) {
    World world;
    place(world.scene, box(V3f(-3), V3f(3)), glass_material(1.33f, 0.5f));
    place(world.scene, test::quad(V3f(-1, -1, -2), V3f(2, 0, 0), V3f(0, 2, 0)),
          test::emitter_material(1.f));
    world.finish();
    EXPECT_NEAR(nested_seen(world, V3f(0.1f, 0.2f, 0), V3f(0.1f, 0.2f, -1)).value, 0.25, 1e-4);
}

// A long and a short box of one mesh, whose fronts and sides lie in one plane: where the ray leaves
// the short one, it is in the long one still.
TEST(NestedVolumes, BodiesOfOneMeshMayShareAPlane) {
    for (const bool same_corners : {false, true}) {
        World world;
        Mesh boxes = layer(0, -4);
        append(boxes, layer(0, -1, same_corners ? 2 : 1.3f));
        place(world.scene, boxes, glass_material(1, 0.5f));
        place(world.scene, test::quad(V3f(-1, -1, -3.5f), V3f(2, 0, 0), V3f(0, 2, 0)),
              test::emitter_material(1.f));
        world.finish();
        const double due = std::pow(0.5, 3.5);
        const Mean e = estimate(world, no_roulette(), 64, [](V2f u) {
            return ray_to(V3f(u.x - 0.5f, u.y - 0.5f, 3), V3f(u.x - 0.5f, u.y - 0.5f, 0));
        });
        EXPECT_NEAR(e.value, due, 2e-3 * due) << same_corners;
    }
}

// A lamp within the inner volume's hidden part is found whichever technique looks for it.
TEST(NestedVolumes, TechniquesAgree) {
    World world;
    Material rough = glass_material(1.2f, 0.5f);
    rough.roughness = 0.6f;
    place(world.scene, sphere(V3f(0.f), 1.5f, 16, false), rough);
    place(world.scene, box(V3f(-0.4f, -0.9f, -0.4f), V3f(0.4f, -0.4f, 0.4f)),
          glass_material(1.f, 0.3f));
    place(world.scene, test::quad(V3f(-0.6f, -0.6f, 0.2f), V3f(1.2f, 0, 0), V3f(0, 1.2f, 0)),
          test::diffuse_material(0.7f));
    place(world.scene, test::quad(V3f(-0.5f, 0.7f, 0.3f), V3f(1, 0, 0), V3f(0, 0, 0.7f)),
          test::emitter_material(5.f));
    world.finish();
    PathOptions options;
    options.max_depth = 6;
    test::expect_techniques_agree(world, options, 8192, test::bundle, 0.03);
}

}  // namespace
}  // namespace petzval::integrator
