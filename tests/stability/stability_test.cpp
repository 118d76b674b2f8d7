// SPDX-License-Identifier: Apache-2.0
// The page of the map of failures, and the guards of what no other test holds.
#include "tests/stability/stability.h"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "camera/models/lens_camera.h"
#include "core/shading/bsdf.h"
#include "core/shading/surface.h"
#include "integrator/path/path.h"
#include "io/lens/lens_file.h"
#include "tests/stability/sweeps.h"
#include "tests/stability/world.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using stability::clear_glass;
using stability::diffuse;
using stability::quad;
using stability::World;

TEST(StabilityPage, EveryFindingIsGuardedAndWhateverIsGuardedIsFound) {
    std::set<std::string> found, guarded;
    for (const stability::Sweep& sweep : stability::kSweeps) found.insert(sweep.id);
    EXPECT_EQ(found.size(), std::size(stability::kSweeps));
    for (const auto& [id, tests] : read_guards(PETZVAL_TEST_DATA "/../stability/guards.csv")) {
        guarded.insert(id);
        EXPECT_FALSE(tests.empty()) << id;
    }
    EXPECT_EQ(found, guarded);
}

TEST(StabilityPage, TablesHoldWhatWasFound) {
    const std::vector<Finding> one{{"a-method",
                                    "A method (odd)",
                                    "bias",
                                    "below 3 mm",
                                    "a warning",
                                    "The range.",
                                    {{"x (mm)", "y"}, {{"1", "2"}}}}};
    const std::string page = stability_markdown(one, {{"a-method", {"Suite.A", "Suite.B"}}});
    EXPECT_NE(page.find("| [A method (odd)](#a-method-odd) | bias | below 3 mm |\n"),
              std::string::npos);
    EXPECT_NE(page.find("## A method (odd)\nThe range.\n\n| x (mm) | y |\n|---|---|\n| 1 | 2 |\n"),
              std::string::npos);
    EXPECT_TRUE(
        page.ends_with("- **Fails:** bias. below 3 mm\n- **There:** a warning\n- **Guard:** "
                       "`Suite.A`, `Suite.B`\n"))
        << page;
    EXPECT_EQ(stability_csv(one),
              "finding,method,row,quantity,value\na-method,A method (odd),1,x (mm),1\n"
              "a-method,A method (odd),1,y,2\n");
}

// Floats in metres hold a lens's point to 6e-8 of its place; a pixel of 6 um is 0.6 um there.
TEST(Stability, RaysOfAThinLensMeetAtTenfoldMagnification) {
    const double focal_mm = 50, focus_mm = 55, film_mm = 550, pixel_mm = 0.0006;
    M44f pose;
    pose[3][0] = pose[3][1] = pose[3][2] = 1;
    const auto focus_m = static_cast<float>(focus_mm * 1e-3);
    const camera::ThinLensCamera camera({pose, static_cast<float>(2 * std::atan(12 / film_mm)),
                                         1.5f, camera::Iris(camera::Disk{}, focal_mm / 4),
                                         focus_m});
    std::optional<V3d> first;
    for (uint32_t i = 0; i < 1000; ++i) {
        const Sampler sampler(SamplerKind::Owen, 3, {0, 0, i});
        const Ray ray = camera.sample({{0.9f, 0.2f}, sampler}, Bands::rgb())[0].ray;
        const V3d o(ray.origin), d(ray.direction);
        const V3d p = o + d * ((1 - double(focus_m) - o.z) / d.z);
        if (!first) first = p;
        EXPECT_LT((p - *first).length() * 1e3, 0.4 * pixel_mm);
    }
}

TEST(Stability, ASliverOfAThousandthLosesNothing) {
    const double c = std::sqrt(0.5), x = 0.5, y = 0.0005;
    camera::Polygon sliver{{{{-x, -y}, {x, -y}, {x, y}, {-x, y}}}};
    for (V2d& p : sliver.contours[0]) p = {c * (p.x - p.y), c * (p.x + p.y)};
    for (const camera::IrisSampling way : camera::iris_samplings(sliver)) {
        const camera::Iris iris(sliver, 10, camera::ApertureScale::Inscribed, way);
        int refused = 0;
        test::Random random(3);
        for (int i = 0; i < 10000; ++i) refused += iris.transmits(iris.sample(random.next2())) == 0;
        EXPECT_LE(refused, 5) << int(way);
    }
}

TEST(Stability, NearlyDegeneratePolygonsKeepTheirArea) {
    for (const double d : {1e-3, 1e-6, 1e-9}) {
        // A vertex off a straight edge, and a slot of width d that is 1.5 deep; turned, so that no
        // edge is level.
        const auto turned = [](std::vector<V2d> contour) {
            for (V2d& p : contour) p = {0.8 * p.x - 0.6 * p.y, 0.6 * p.x + 0.8 * p.y};
            return camera::Polygon{{std::move(contour)}};
        };
        const camera::Polygon dented = turned({{-1, -1}, {0, -1 - d}, {1, -1}, {1, 1}, {-1, 1}});
        const camera::Polygon slotted = turned({{-1, -1},
                                                {1, -1},
                                                {1, -d / 2},
                                                {-0.5, -d / 2},
                                                {-0.5, d / 2},
                                                {1, d / 2},
                                                {1, 1},
                                                {-1, 1}});
        for (const auto& [polygon, area] : {std::pair{dented, 4 + d}, {slotted, 4 - 1.5 * d}}) {
            ASSERT_FALSE(camera::find_fault(polygon)) << d;
            double reach2 = 0;
            for (const V2d& p : polygon.contours[0]) reach2 = std::max(reach2, p.length2());
            const camera::Iris iris(polygon, 10, camera::ApertureScale::Inscribed,
                                    camera::IrisSampling::Triangles);
            EXPECT_NEAR(iris.area_mm2() / (area * 100 / reach2), 1, 1e-9) << d;
        }
    }
}

// Past a fold of the pupil the map from directions to the stop turns back: next to it a ray that
// only nearly meets a point of the stop may have any weight. One of 12,600 times the mean was seen.
TEST(Stability, NoDrawOutweighsAllOthersWhereThePupilFolds) {
    const auto lens =
        std::make_shared<const camera::Lens>(io::load_lens("primoplan-58mm-f1.5").lens);
    const double radius_mm = lens->prescription().surfaces[size_t(lens->stop())].semi_diameter_mm;
    camera::LensCameraInput in{
        .lens = lens, .iris = camera::Iris(camera::Disk{}, radius_mm), .to_world = M44f()};
    in.film_mm = lens->film_mm();
    in.dispersion = camera::DispersionMode::Shared;
    const camera::LensCamera camera(in);
    test::Moments weights;
    double heaviest = 0;
    test::Random random(4);
    for (int i = 0; i < 400000; ++i) {
        const auto drawn = camera.draw<f4>({17, 12}, random.next2(), Bands::rgb());
        weights.add(double(drawn.weight[0]));
        heaviest = std::max(heaviest, double(drawn.weight[0]));
    }
    EXPECT_LT(heaviest / weights.mean(), 300);
    EXPECT_LT(weights.variance() / std::pow(weights.mean(), 2), 5);
}

// Half the spacing of floats at 100 m is 4 um, 0.03 of the pixel of 0.12 mm that stands 1 m ahead.
TEST(Stability, APictureAHundredMetresFromTheOriginIsSharp) {
    const V3f eye(100, -70, 30);
    World world;
    world.place(quad(eye + V3f(-2, -2, -1), V3f(4, 0, 0), V3f(0, 4, 0)), diffuse(0.5f));
    world.finish();
    const double depth = double(eye.z) - double(world.scene.meshes[0].positions[0].z);
    M44f pose;
    for (int i = 0; i < 3; ++i) pose[3][i] = eye[i];
    const camera::ThinLensCamera camera({pose, 0.47f, 1.5f, {}, 1.f});
    test::Random random(2);
    for (int i = 0; i < 2000; ++i) {
        const camera::FilmPoint at{random.next2(), Sampler(SamplerKind::Owen, 1, {0, 0, 0})};
        const Ray ray = camera.sample(at, Bands::rgb())[0].ray;
        const auto hit = world.bvh->intersect(ray);
        ASSERT_TRUE(hit);
        const V3d p(make_surface(world.scene, ray.direction, *hit).p);
        const double half = std::tan(double(0.47f) / 2) * depth;
        EXPECT_NEAR(p.x, double(eye.x) + (2 * double(at.film.x) - 1) * half * 1.5, 2.4e-5);
        EXPECT_NEAR(p.y, double(eye.y) + (1 - 2 * double(at.film.y)) * half, 2.4e-5);
    }
}

TEST(Stability, GgxIsANumberAtGrazingLight) {
    test::Random random(5);
    for (const float cosine : {1e-2f, 1e-4f, 1e-6f})
        for (const float roughness : {0.f, 0.032f, 0.05f, 0.3f, 1.f})
            for (const float metallic : {0.f, 1.f})
                for (const float transmission : {0.f, 1.f}) {
                    BsdfInput in;
                    in.base_color = uniform(1.f, Bands::rgb());
                    in.roughness = roughness;
                    in.metallic = metallic;
                    in.transmission = transmission;
                    in.thin = false;
                    in.dielectric_f0 = uniform(0.04f, Bands::rgb());
                    const Bsdf bsdf(in, Bands::rgb(), {safe_sqrt(1 - cosine * cosine), 0, cosine});
                    double sum = 0;
                    for (int i = 0; i < 4000; ++i) {
                        const auto s = bsdf.sample(random.next(), random.next2());
                        if (!s) continue;
                        ASSERT_TRUE(std::isfinite(s->weight[0] + s->wi.x + s->wi.y + s->wi.z));
                        ASSERT_GE(s->weight[0], 0);
                        sum += double(s->weight[0]) / 4000;
                    }
                    EXPECT_LT(sum, 1.05) << cosine << ' ' << roughness << ' ' << metallic;
                }
}

// A pixel within the blur finds the highlight with a chance that is the highlight's share of the
// circle of confusion: 25 mm (10 - 1) / 1 at the highlight.
TEST(Stability, ADefocusedHighlightVariesAsItsShareOfTheBlur) {
    const float side_m = 0.03f;
    Material lamp = diffuse(0);
    lamp.emissive = Rgb(1.f);
    World world;
    world.place(quad(V3f(-side_m / 2, -side_m / 2, -10), V3f(side_m, 0, 0), V3f(0, side_m, 0)),
                lamp);
    world.finish();
    const camera::ThinLensCamera camera(
        {M44f(), 0.47f, 1.5f, camera::Iris(camera::Disk{}, 12.5), 1.f});
    const integrator::PathTracer tracer(world.scene, *world.bvh, *world.lights,
                                        integrator::PathOptions());
    integrator::PathStats stats;
    test::Moments light;
    for (uint32_t i = 0; i < 200000; ++i) {
        const Sampler sampler(SamplerKind::Independent, 9, {0, 0, i});
        const Ray ray = camera.sample({{0.5007f, 0.5004f}, sampler}, Bands::rgb())[0].ray;
        FilmSample out;
        light.add(double(tracer.radiance({ray}, Bands::rgb(), sampler, out, stats)[0]));
    }
    const double share = double(side_m * side_m) / (std::numbers::pi / 4 * 0.225 * 0.225);
    EXPECT_TRUE(test::agrees(light, share)) << light.mean();
    EXPECT_NEAR(light.variance() / (light.mean() * light.mean()), 1 / light.mean() - 1, 0.01);
}

// Of panes in a white sky a depth takes away what it cuts off, and no more; roulette takes nothing.
TEST(Stability, PanesLoseWhatTheDepthCutsOff) {
    const auto mean = [](int panes, int depth) {
        const Material glass = clear_glass(1.5f);
        World world;
        for (int i = 0; i < panes; ++i) {
            const float z = -0.1f * static_cast<float>(i);
            world.place(quad(V3f(-9, -9, z), V3f(18, 0, 0), V3f(0, 18, 0)), glass);
            world.place(quad(V3f(-9, -9, z - 0.05f), V3f(0, 18, 0), V3f(18, 0, 0)), glass);
        }
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish();
        integrator::PathOptions options;
        options.max_specular_depth = depth;
        const integrator::PathTracer tracer(world.scene, *world.bvh, *world.lights, options);
        integrator::PathStats stats;
        test::Moments light;
        for (uint32_t i = 0; i < 40000; ++i) {
            Ray ray;
            ray.origin = {0.1f, 0.2f, 1};
            ray.direction = {0, 0, -1};
            FilmSample out;
            const Sampler sampler(SamplerKind::Independent, 2, {0, 0, i});
            light.add(double(tracer.radiance({ray}, Bands::rgb(), sampler, out, stats)[0]));
        }
        return light;
    };
    for (const int panes : {1, 4}) {
        const test::Moments whole = mean(panes, 500);
        EXPECT_TRUE(test::agrees(whole, 1)) << panes;
    }
    // Two scatterings a pane: straight through eight of them are 16, and reflected ways are cut.
    const double cut = mean(8, 16).mean();
    EXPECT_LT(cut, 0.85);
    EXPECT_GT(cut, std::pow(0.96, 16) - 0.05);
    EXPECT_LT(mean(9, 16).mean(), 0.5);
}

TEST(Stability, BlocksAreNetsUpToTheLastIndex) {
    for (const SamplerKind kind : {SamplerKind::Owen, SamplerKind::Sobol})
        for (const uint32_t first : {0u, 1u << 16, 1u << 24, 1u << 31, 0xffff0000u}) {
            std::vector<int> points(1u << 16);
            for (uint32_t i = 0; i < 1u << 16; ++i) {
                const V2f u = Sampler(kind, 6, {4, 2, first + i}).get2(Dim::Bsdf);
                ++points[size_t(u.y * 256) * 256 + size_t(u.x * 256)];
            }
            EXPECT_EQ(std::count(points.begin(), points.end(), 1), 1 << 16) << first;
        }
}

}  // namespace
}  // namespace petzval
