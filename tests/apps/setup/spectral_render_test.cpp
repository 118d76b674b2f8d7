// SPDX-License-Identifier: Apache-2.0
// Renders with wavelengths against what is known of them by other ways.
#include <gtest/gtest.h>

#include <cstring>
#include <numbers>

#include "camera/models/thin_lens.h"
#include "core/spectrum/colorimetry.h"
#include "core/spectrum/colour.h"
#include "integrator/render/executor.h"
#include "integrator/render/render.h"
#include "io/glass/glass_lookup.h"
#include "io/spectra/spectra.h"
#include "tests/support/set_up_observer.h"
#include "tests/support/statistics.h"
#include "tests/support/traced_world.h"

namespace petzval::apps {
namespace {

using test::diffuse_material;
using test::emitter_material;
using test::observer_of;
using test::place;
using test::quad;
using test::sphere;
using World = test::TracedWorld;

Film render_film(const World& world, const camera::Camera& camera, V2i size,
                 const integrator::RenderJob& job, int threads = 2) {
    Film film(size, {0, 0, size.x, size.y}, {}, job.observer.bins());
    integrator::ThreadExecutor executor(threads);
    integrator::RenderMonitor monitor;
    static_cast<void>(integrator::render(*world.tracer, camera, job, film, executor, monitor));
    EXPECT_EQ(film.left_out().count(), 0u);
    return film;
}

integrator::RenderJob job_of(const Observer& observer, uint32_t spp) {
    integrator::RenderJob job;
    job.observer = observer;
    job.end_sample = spp;
    job.filter = Filter(FilterKind::Box, 0.5f);
    if (observer.bins()) job.replicates = kReplicates;
    return job;
}

V3d srgb_to_lab(const V3d& rgb) {
    const V3d white = respond(io::standard_observer(), io::find_illuminant("d65"));
    const V3d white1 = white / white.y;
    return xyz_to_lab(srgb_to_xyz(white1) * rgb, white1);
}

// Looks along -z at the square [0, width] x [0, height] of the plane z = 0.
camera::OrthographicCamera above(float width, float height) {
    M44f to_world;
    to_world.translate(V3f(width / 2, height / 2, 5));
    return {to_world, width / 2, height / 2};
}

// Every patch of a colour chart is a lamp that shines as the patch under D65 would: what hero
// wavelengths make of it against the sum over all wavelengths.
TEST(SpectralRender, ColourCheckerSpectraAgainstDirectIntegration) {
    const std::vector<SpectrumTable> patches = io::training_reflectances();
    ASSERT_EQ(patches.size(), 24u);
    const auto xyz_bar = io::standard_observer();
    const SpectrumTable d65 = io::find_illuminant("d65");
    const V3d white = respond(xyz_bar, d65);
    World world;
    std::vector<V3d> expected;
    for (size_t i = 0; i < patches.size(); ++i) {
        SpectrumTable reflected;
        for (size_t k = 0; k < d65.value.size(); ++k)
            reflected.value[k] = patches[i].value[k] * d65.value[k];
        const V3d xyz = respond(xyz_bar, reflected) / white.y;
        expected.push_back(xyz);
        Illuminant lamp;
        for (size_t k = 0; k < d65.value.size(); ++k)
            lamp.per_nit.value[k] = static_cast<float>(reflected.value[k] / white.y / xyz.y /
                                                       kLuminousEfficacy_lm_per_w);
        Material m = emitter_material(static_cast<float>(xyz.y));
        m.illuminant = static_cast<int32_t>(i);
        world.scene.illuminants.push_back(lamp);
        place(world.scene, quad(V3f(float(i % 6), float(i / 6), 0), V3f(1, 0, 0), V3f(0, 1, 0)), m);
    }
    world.finish();
    const V2i size(6 * 4, 4 * 4);
    const Film film =
        render_film(world, above(6, 4), size, job_of(observer_of({}, world.scene), 256));
    for (int i = 0; i < 24; ++i) {
        V3d mean(0.);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) {
                const V4f c = film.colour(i % 6 * 4 + x, (3 - i / 6) * 4 + y);
                mean += V3d(c.x, c.y, c.z) / 16.;
            }
        const double error =
            delta_e_2000(srgb_to_lab(mean), xyz_to_lab(expected[size_t(i)], white / white.y));
        EXPECT_LE(error, 0.5) << "patch " << i;
    }
}

// RGB patches under a sky of 1 nit: up to spectra and back. The cyan patch (index 17) lies outside
// sRGB, so that no RGB says it.
TEST(SpectralRender, ColourCheckerRgbThroughUpliftAndBack) {
    const auto xyz_bar = io::standard_observer();
    const SpectrumTable d65 = io::find_illuminant("d65");
    const V3d white = respond(xyz_bar, d65);
    const Matrix3 to_rgb = srgb_to_xyz(white / white.y).inverse();
    World world;
    std::vector<V3d> colours;
    for (const SpectrumTable& patch : io::training_reflectances()) {
        SpectrumTable reflected;
        for (size_t k = 0; k < d65.value.size(); ++k)
            reflected.value[k] = patch.value[k] * d65.value[k];
        const V3d rgb = to_rgb * (respond(xyz_bar, reflected) / white.y);
        const size_t i = colours.size();
        colours.push_back(rgb);
        Material m = diffuse_material(0.f);
        for (int c = 0; c < 3; ++c) m.base_color.v[c] = std::max(0.f, static_cast<float>(rgb[c]));
        place(world.scene, quad(V3f(float(i % 6), float(i / 6), 0), V3f(1, 0, 0), V3f(0, 1, 0)), m);
    }
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    const Film film = render_film(world, above(6, 4), {24, 16}, job_of(observer_of({}), 256));
    int outside = 0;
    for (int i = 0; i < 24; ++i) {
        V3d mean(0.);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) {
                const V4f c = film.colour(i % 6 * 4 + x, (3 - i / 6) * 4 + y);
                mean += V3d(c.x, c.y, c.z) / 16.;
            }
        const V3d& rgb = colours[size_t(i)];
        if (std::min({rgb.x, rgb.y, rgb.z}) < 0) {
            ++outside;
            EXPECT_EQ(i, 17);
            continue;
        }
        EXPECT_LE(delta_e_2000(srgb_to_lab(mean), srgb_to_lab(rgb)), 0.5) << "patch " << i;
    }
    EXPECT_EQ(outside, 1);
}

Material glass_material(const char* name, float roughness) {
    Material m;
    m.metallic = 0;
    m.roughness = roughness;
    m.transmission = 1;
    m.has_volume = true;
    m.glass = io::LensGlasses({}).find(name);
    m.ior = static_cast<float>(m.glass->index(kLineD_nm));
    return m;
}

// Mean of every lane's radiance over that of the white sky, in four parts of the spectrum.
std::array<test::Moments, 4> furnace(const World& world, const Observer& observer,
                                     uint32_t samples = 512) {
    std::array<test::Moments, 4> part;
    constexpr uint32_t replicates = 16;
    for (uint32_t seed = 0; seed < replicates; ++seed) {
        std::array<double, 4> sum{}, count{};
        for (uint32_t i = 0; i < samples; ++i) {
            const Sampler sampler(SamplerKind::Owen, seed, {0, 0, i});
            const Bands bands = observer.draw(sampler.get1(Dim::Wavelength));
            const V2f u = sampler.get2(Dim::Film);
            Ray ray;
            ray.origin = V3f(0, 0, 4);
            ray.direction = unit(V3f(u.x - 0.5f, u.y - 0.5f, 0) - ray.origin);
            FilmSample out;
            integrator::PathStats stats;
            const f4 seen = world.tracer->radiance({ray}, bands, sampler, out, stats);
            for (int lane = 0; lane < 4; ++lane) {
                const auto k = static_cast<size_t>(
                    std::clamp((static_cast<int>(bands.nm[lane]) - 400) / 75, 0, 3));
                sum[k] += seen[lane] / bands.white[lane];
                count[k] += 1;
            }
        }
        for (size_t k = 0; k < 4; ++k) part[k].add(sum[k] / count[k]);
    }
    return part;
}

TEST(SpectralRender, FurnaceAtEveryWavelength) {
    const Observer observer = observer_of({});
    for (const Material& m : {diffuse_material(1.f), glass_material("schott:N-SF11", 0.f)}) {
        World world;
        place(world.scene, sphere(V3f(0.f), 1.f, 32, true), m);
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish(200);
        const auto part = furnace(world, observer);
        for (size_t k = 0; k < 4; ++k)
            EXPECT_TRUE(test::agrees(part[k], 1., 5e-5)) << k << ": " << test::Mean(part[k]);
    }
}

// Rough glass that disperses loses what rough glass of the same index loses, and gains nothing.
TEST(SpectralRender, RoughDispersionNeitherGainsNorLoses) {
    const Observer observer = observer_of({});
    std::array<std::array<test::Moments, 4>, 2> part;
    for (const bool disperses : {false, true}) {
        Material m = glass_material("schott:N-BK7", 0.3f);
        if (!disperses) m.glass.reset();
        World world;
        place(world.scene, sphere(V3f(0.f), 1.f, 32, true), m);
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish(200);
        part[disperses] = furnace(world, observer, 8192);
    }
    for (size_t k = 0; k < 4; ++k) {
        const test::Mean off = test::Mean(part[1][k]) - test::Mean(part[0][k]);
        EXPECT_TRUE(test::agrees(off, 0, 1e-3)) << k << ": " << off;
        EXPECT_LT(off.error, 0.0025) << k;
        EXPECT_LE(part[1][k].mean(), 1.001);
    }
}

// A prism of 60 degrees: apex at the top, long axis z, base from (-1, 0) to (1, 0).
constexpr float kPrismHeight = std::numbers::sqrt3_v<float>;
Mesh prism_mesh() {
    Mesh out;
    for (const float z : {-5.f, 5.f})
        out.positions.insert(out.positions.end(),
                             {V3f(-1, 0, z), V3f(1, 0, z), V3f(0, kPrismHeight, z)});
    out.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                     {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    return out;
}

// A ray through a prism of 60 degrees leaves each wavelength at the angle of Snell's law,
// computed here from the catalogue's figures alone.
TEST(SpectralRender, PrismBendsEachWavelengthAsSnellSays) {
    World world;
    place(world.scene, prism_mesh(), glass_material("schott:N-SF11", 0.f));
    world.finish();
    const Observer observer = observer_of({});
    const double incidence = 60. / 180 * std::numbers::pi, apex = 60. / 180 * std::numbers::pi;
    // Into the left face, whose outward normal points 150 degrees from +x.
    const V3d normal_in(std::cos(150. / 180 * std::numbers::pi),
                        std::sin(150. / 180 * std::numbers::pi), 0);
    const double heading = std::atan2(-normal_in.y, -normal_in.x) + incidence;
    for (const double nm : {400., 486.1327, 587.5618, 656.2725, 780.}) {
        // N-SF11: Schott's Sellmeier coefficients.
        const double w2 = nm * nm * 1e-6;
        const double n =
            std::sqrt(1 + 1.73759695 * w2 / (w2 - 0.013188707) +
                      0.313747346 * w2 / (w2 - 0.0623068142) + 1.89878101 * w2 / (w2 - 155.23629));
        const double inside = std::asin(std::sin(incidence) / n);
        const double outside = std::asin(n * std::sin(apex - inside));
        const double deviation = incidence + outside - apex;

        const Bands bands = observer.at(splat(static_cast<float>(nm)), splat(1.f), m4{-1, 0, 0, 0});
        Ray ray;
        ray.direction =
            V3f(static_cast<float>(std::cos(heading)), static_cast<float>(std::sin(heading)), 0);
        ray.origin = V3f(-0.5f, kPrismHeight / 2, 0) - ray.direction;
        const V3f start = ray.direction;
        int faces = 0;
        while (const auto hit = world.bvh->intersect(ray)) {
            const Surface s = make_surface(world.scene, ray.direction, *hit);
            const V3f wo = -ray.direction;
            const ShadingInput shading = read_material(world.scene, s, wo, bands);
            const Bsdf bsdf(shading.bsdf, bands, shading.frame.to_local(wo));
            const auto sample = bsdf.sample(kOneMinus, {0.5f, 0.5f});
            ASSERT_TRUE(sample && sample->transmitted) << nm;
            ray.direction = unit(shading.frame.to_world(sample->wi));
            ray.origin = offset_origin(s.p, s.p_error, s.ng, ray.direction);
            ASSERT_LE(++faces, 2);
        }
        EXPECT_EQ(faces, 2) << nm;
        const double turned =
            std::atan2(start.cross(ray.direction).length(), start.dot(ray.direction));
        EXPECT_NEAR(turned, deviation, 2e-6) << nm;
    }
}

// Everything that depends on wavelength, small enough to be rendered well.
void add_wavelength_scene(World& world) {
    Scene& scene = world.scene;
    const auto wall = [&](V3f corner, V3f a, V3f b, Rgb colour) {
        Material m = diffuse_material(0.f);
        m.base_color = colour;
        place(scene, quad(corner, a, b), m);
    };
    wall(V3f(-2, -1, -2), V3f(0, 0, 4), V3f(4, 0, 0), Rgb(0.7f, 0.7f, 0.7f));
    wall(V3f(-2, -1, -2), V3f(4, 0, 0), V3f(0, 3, 0), Rgb(0.8f, 0.2f, 0.1f));
    wall(V3f(-2, -1, -2), V3f(0, 3, 0), V3f(0, 0, 4), Rgb(0.1f, 0.3f, 0.8f));
    place(scene, sphere(V3f(0.6f, -0.4f, 0), 0.6f, 16, true), glass_material("schott:N-SF11", 0.f));
    Material frosted = glass_material("schott:N-SF66", 0.25f);
    frosted.attenuation_color = Rgb(0.9f, 0.6f, 0.3f);
    frosted.attenuation_distance_m = 0.5f;
    place(scene, sphere(V3f(-0.7f, -0.4f, 0.3f), 0.6f, 16, true), frosted);
    Material gold;
    gold.roughness = 0.3f;
    gold.metal = 0;
    scene.metals.push_back(*io::find_metal("au"));
    place(scene, sphere(V3f(0, 0.6f, -1), 0.6f, 16, true), gold);
    Material lamp = emitter_material(6.f);
    lamp.illuminant = 0;
    scene.illuminants.push_back(*io::find_light_spectrum("a"));
    place(scene, quad(V3f(-1, 2, -1), V3f(2, 0, 0), V3f(0, 0, 2)), lamp);
    scene.sky = Sky::uniform(Rgb(0.2f, 0.3f, 0.5f));
}

// The same scene with one wavelength a path, drawn evenly: no lanes share anything, nothing is
// terminated, and the BSDF never chooses among lanes.
TEST(SpectralRender, HeroAgreesWithOneWavelengthAPath) {
    World world;
    add_wavelength_scene(world);
    world.finish(12);
    const Observer observer = observer_of({}, world.scene);
    camera::ThinLens lens;
    lens.to_world = camera::look_at(V3f(0, 0.3f, 4), V3f(0, 0, 0));
    lens.aspect = 1;
    lens.yfov_rad = 0.8f;
    const camera::ThinLensCamera camera(lens);
    constexpr int side = 5;
    constexpr uint32_t replicates = 16, hero_samples = 512, single_samples = 2048;
    const auto estimate = [&](uint32_t samples, uint32_t seed0, const auto& bands_of) {
        std::array<std::array<test::Moments, 3>, side * side> pixels;
        for (int p = 0; p < side * side; ++p)
            for (uint32_t seed = 0; seed < replicates; ++seed) {
                std::array<double, 3> sum{};
                for (uint32_t i = 0; i < samples; ++i) {
                    const Sampler sampler(SamplerKind::Owen, seed0 + seed, {p, 0, i});
                    const Bands bands = bands_of(sampler.get1(Dim::Wavelength));
                    const V2f at = (V2f(p % side, p / side) + sampler.get2(Dim::Film)) / side;
                    const camera::CameraSample seen = camera.sample({at, sampler}, bands);
                    FilmSample out;
                    integrator::PathStats stats;
                    const f4 radiance =
                        world.tracer->radiance({seen[0].ray, seen[0].lanes, seen[0].hero_decided},
                                               bands, sampler, out, stats);
                    const Rgb colour = to_rgb(seen[0].weight * radiance, bands);
                    for (int c = 0; c < 3; ++c) sum[size_t(c)] += colour[c] / samples;
                }
                for (size_t c = 0; c < 3; ++c) pixels[size_t(p)][c].add(sum[c]);
            }
        return pixels;
    };
    const auto hero = estimate(hero_samples, 0, [&](float u) { return observer.draw(u); });
    const auto single = estimate(single_samples, 1000, [&](float u) {
        const float nm = kFirst_nm + u * (kLast_nm - kFirst_nm);
        return observer.at(splat(nm), splat(1.f / (kLast_nm - kFirst_nm)), m4{-1, 0, 0, 0});
    });
    double squares = 0;
    for (size_t p = 0; p < hero.size(); ++p)
        for (size_t c = 0; c < 3; ++c) {
            const test::Mean off = test::Mean(hero[p][c]) - test::Mean(single[p][c]);
            const double t = off.value / off.error;
            squares += t * t;
            EXPECT_TRUE(test::agrees(off, 0))
                << "pixel " << p << " channel " << c << ": " << hero[p][c].mean() << " and "
                << single[p][c].mean() << ", t " << t;
        }
    // 75 numbers of Student's t with 15 + 15 degrees of freedom: their variance is 30 / 28.
    EXPECT_GE(test::chi_square_p(squares / (30. / 28), 75), test::sidak()) << squares;
}

// Rough glass parts the wavelengths twice. The lane that led into the prism has been chosen by
// the hero, so that the hero must not choose the lane that leads out of it. A lamp behind the
// prism gets the short wavelengths alone.
TEST(SpectralRender, ARoughPrismAgreesWithOneWavelengthAPath) {
    World world;
    place(world.scene, prism_mesh(), glass_material("schott:N-SF11", 0.1f));
    constexpr float out_deg = -40, distance = 4;  // of 530 nm, about
    const float out = out_deg / 180 * std::numbers::pi_v<float>;
    const V3f ahead(std::cos(out), std::sin(out), 0), to_long(-ahead.y, ahead.x, 0);
    place(world.scene,
          quad(V3f(0.5f, kPrismHeight / 2, -50) + ahead * distance - to_long * 10, to_long * 10,
               V3f(0, 0, 100)),
          emitter_material(1.f));
    world.finish(12);
    const Observer observer = observer_of({}, world.scene);
    Ray ray;
    ray.direction = unit(V3f(std::numbers::sqrt3_v<float>, 1, 0));
    ray.origin = V3f(-0.5f, kPrismHeight / 2, 0) - ray.direction;
    const auto estimate = [&](uint32_t samples, uint32_t seed0, const auto& bands_of) {
        std::array<test::Moments, 3> part;
        for (uint32_t seed = seed0; seed < seed0 + 16; ++seed) {
            Rgb sum(0.f);
            for (uint32_t i = 0; i < samples; ++i) {
                const Sampler sampler(SamplerKind::Owen, seed, {0, 0, i});
                const Bands bands = bands_of(sampler.get1(Dim::Wavelength));
                FilmSample film;
                integrator::PathStats stats;
                sum += to_rgb(world.tracer->radiance({ray, bands.on, false}, bands, sampler, film,
                                                     stats),
                              bands) *
                       (1.f / static_cast<float>(samples));
            }
            for (int c = 0; c < 3; ++c) part[size_t(c)].add(sum[c]);
        }
        return part;
    };
    const auto hero = estimate(4096, 0, [&](float u) { return observer.draw(u); });
    const auto single = estimate(16384, 1000, [&](float u) {
        const float nm = kFirst_nm + u * (kLast_nm - kFirst_nm);
        return observer.at(splat(nm), splat(1.f / (kLast_nm - kFirst_nm)), m4{-1, 0, 0, 0});
    });
    for (size_t c = 0; c < 3; ++c) {
        const test::Mean off = test::Mean(hero[c]) - test::Mean(single[c]);
        EXPECT_TRUE(test::agrees(off, 0)) << c << ": " << hero[c].mean() << " and "
                                          << single[c].mean() << ", t " << off.value / off.error;
    }
}

TEST(SpectralRender, SameBytesForAnyNumberOfThreads) {
    World world;
    add_wavelength_scene(world);
    world.finish();
    SpectralRequest request;
    request.bins = Bins{400, 50, 6};
    const integrator::RenderJob job = job_of(observer_of(request, world.scene), 16);
    camera::ThinLens lens;
    lens.to_world = camera::look_at(V3f(0, 0.3f, 4), V3f(0, 0, 0));
    const camera::ThinLensCamera camera(lens);
    const V2i size(24, 16);
    const Film one = render_film(world, camera, size, job, 1);
    const Film four = render_film(world, camera, size, job, 4);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const V4f a = one.colour(x, y), b = four.colour(x, y);
            ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0);
            std::array<float, 6> bins_a, bins_b;
            one.spectral()->bin_means(one.offset(x, y), 16, bins_a.data());
            four.spectral()->bin_means(four.offset(x, y), 16, bins_b.data());
            ASSERT_EQ(bins_a, bins_b);
            ASSERT_EQ(one.spectral()->standard_error(one.offset(x, y), {0, 16}),
                      four.spectral()->standard_error(four.offset(x, y), {0, 16}));
        }
}

}  // namespace
}  // namespace petzval::apps
