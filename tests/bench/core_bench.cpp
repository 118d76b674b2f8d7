// SPDX-License-Identifier: Apache-2.0
// Nanoseconds for each of the calls that stand in the inner loop of a path. "far" arguments jump
// about (bounced rays), "near" ones stay in a neighbourhood (camera rays of a tile).
#include <benchmark/benchmark.h>

#include "core/film/film.h"
#include "core/light/light_choice.h"
#include "core/light/light_sampling.h"
#include "core/sampling/filter.h"
#include "core/sampling/sampler.h"
#include "core/sampling/warp.h"
#include "tests/support/lamp.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using test::Random;

const Bands kRgb = Bands::rgb();
constexpr size_t kArguments = 1 << 16;

std::vector<V2f> points(bool far) {
    std::vector<V2f> out;
    Random random(1);
    for (size_t i = 0; i < kArguments; ++i)
        out.push_back(random.next2() * (far ? 1.f : 0.01f) + V2f(0.3f, 0.4f) * (far ? 0.f : 1.f));
    return out;
}

std::vector<Image> images() {
    Image image{"bench", 2048, 2048, std::vector<uint8_t>(size_t{4} * 2048 * 2048)};
    auto& bytes = std::get<std::vector<uint8_t>>(image.texels);
    for (size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<uint8_t>(hash32(static_cast<uint32_t>(i)));
    return std::vector<Image>(4, image);
}

std::array<TextureSlot, 4> slots() {
    std::array<TextureSlot, 4> out;
    for (int i = 0; i < 4; ++i) {
        out[i].image = i;
        out[i].encoding = i % 2 ? Encoding::Linear : Encoding::Srgb;
    }
    return out;
}

// Four textures of 2048 x 2048 at the same place, one after the other; the time is for all.
void textures_one_by_one(benchmark::State& state) {
    const auto scene_images = images();
    const auto material = slots();
    const auto uv = points(state.range(0));
    size_t i = 0;
    for (auto _ : state) {
        f4 sum{};
        for (const auto& slot : material)
            sum += sample_texture(scene_images, slot, uv[i % kArguments]);
        benchmark::DoNotOptimize(sum);
        ++i;
    }
}
BENCHMARK(textures_one_by_one)->ArgName("far")->Arg(0)->Arg(1);

// The same, all located before the first is read.
void textures_together(benchmark::State& state) {
    const auto scene_images = images();
    const auto material = slots();
    const auto uv = points(state.range(0));
    size_t i = 0;
    for (auto _ : state) {
        std::array<TextureLookup, 4> lookups;
        for (int k = 0; k < 4; ++k)
            lookups[k] = locate_texture(scene_images, material[k], uv[i % kArguments]);
        f4 sum{};
        for (const auto& lookup : lookups) sum += read_texture(lookup);
        benchmark::DoNotOptimize(sum);
        ++i;
    }
}
BENCHMARK(textures_together)->ArgName("far")->Arg(0)->Arg(1);

Sky dawn(int width) {
    std::vector<float> rgb;
    Random random(2);
    for (int i = 0; i < 3 * width * (width / 2); ++i) rgb.push_back(0.5f + random.next());
    for (int i = 0; i < 30; ++i) rgb[3 * width * (width / 8) + i] = 2e4f;
    return Sky::picture(std::move(rgb), width, width / 2, 30.f, 1.f);
}

void sky_sample(benchmark::State& state) {
    const Sky sky = dawn(static_cast<int>(state.range(0)));
    const auto u = points(true);
    size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(sky.sample(u[i++ % kArguments]));
}
BENCHMARK(sky_sample)->ArgName("width")->Arg(64)->Arg(1024)->Arg(4096);

void sky_find(benchmark::State& state) {
    const Sky sky = dawn(static_cast<int>(state.range(0)));
    std::vector<V3f> directions;
    for (const V2f& u : points(true)) directions.push_back(uniform_sphere(u));
    size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(sky.find(directions[i++ % kArguments]));
}
BENCHMARK(sky_find)->ArgName("width")->Arg(64)->Arg(1024)->Arg(4096);

// n lamps with a texture on them.
Scene lamps(uint32_t n) {
    Scene scene;
    scene.images = images();
    scene.materials = {test::glowing(Rgb(5.f))};
    scene.materials[0].emissive_texture.image = 0;
    Mesh mesh;
    mesh.uv[0].reserve(3 * n);
    Random random(3);
    for (uint32_t i = 0; i < n; ++i) {
        const V3f at = random.direction() * 10.f;
        for (uint32_t k = 0; k < 3; ++k) {
            mesh.positions.push_back(at + random.direction() * 0.1f);
            mesh.uv[0].push_back(random.next2());
        }
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    scene.meshes = {std::move(mesh)};
    scene.instances.resize(1);
    finish_scene(scene);
    return scene;
}

void light_pick_and_sample(benchmark::State& state) {
    const Scene scene = lamps(static_cast<uint32_t>(state.range(0)));
    const LightChoice choice(scene, static_cast<LightChoiceKind>(state.range(1)));
    const LightReceiver receiver{V3f(0.f), V3f(0, 1, 0), false};
    const auto u = points(true);
    size_t i = 0;
    for (auto _ : state) {
        const auto pick = choice.pick(u[i % kArguments].x, receiver);
        ++i;
        if (!pick) continue;
        benchmark::DoNotOptimize(sample_light(scene, scene.lights[pick->light], V3f(0.f),
                                              u[(i + 6) % kArguments], kRgb));
    }
}
BENCHMARK(light_pick_and_sample)
    ->ArgNames({"lights", "tree"})
    ->ArgsProduct({{10, 200000}, {int(LightChoiceKind::Power), int(LightChoiceKind::Tree)}});

void light_choice_build(benchmark::State& state) {
    const Scene scene = lamps(static_cast<uint32_t>(state.range(0)));
    for (auto _ : state)
        benchmark::DoNotOptimize(LightChoice(scene, static_cast<LightChoiceKind>(state.range(1))));
}
BENCHMARK(light_choice_build)
    ->ArgNames({"lights", "tree"})
    ->ArgsProduct({{200000}, {int(LightChoiceKind::Power), int(LightChoiceKind::Tree)}})
    ->Unit(benchmark::kMillisecond);

void piecewise_1d(benchmark::State& state) {
    std::vector<float> weights(state.range(0));
    Random random(4);
    for (float& w : weights) w = random.next();
    const Piecewise1D distribution(weights);
    const auto u = points(true);
    size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(distribution.sample(u[i++ % kArguments].x));
}
BENCHMARK(piecewise_1d)->ArgName("cells")->Arg(1000)->Arg(200000);

void filter_sample(benchmark::State& state) {
    const Filter filter(FilterKind::BlackmanHarris, 1.5f);
    const auto u = points(true);
    size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(filter.sample(u[i++ % kArguments]));
}
BENCHMARK(filter_sample);

void sampler_get2(benchmark::State& state) {
    uint32_t i = 0;
    for (auto _ : state) {
        const Sampler sampler(static_cast<SamplerKind>(state.range(0)), 1, {5, 7, i++});
        benchmark::DoNotOptimize(sampler.get2(Dim::Bsdf, 3));
    }
}
BENCHMARK(sampler_get2)->ArgName("kind")->DenseRange(0, 2);

void film_add(benchmark::State& state) {
    Film film(
        {64, 64}, {0, 0, 64, 64},
        state.range(0) ? std::vector{Aov::Albedo, Aov::Normal, Aov::Depth} : std::vector<Aov>{});
    FilmSample sample;
    sample.hit = true;
    uint32_t i = 0;
    for (auto _ : state) {
        film.add(static_cast<int>(i & 63), static_cast<int>(i >> 6 & 63), i, sample);
        ++i;
    }
}
BENCHMARK(film_add)->ArgName("layers")->Arg(0)->Arg(1);

}  // namespace
}  // namespace petzval
