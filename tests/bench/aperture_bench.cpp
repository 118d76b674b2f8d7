// SPDX-License-Identifier: Apache-2.0
// Nanoseconds for a point of an iris, by shape and way of drawing, and for asking whether one
// passes; seconds of making an iris matter little, but not nothing, so they are here too.
#include <benchmark/benchmark.h>

#include <numbers>

#include "camera/iris/iris.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

constexpr size_t kArguments = 1 << 14;

camera::Mask vignette(int size) {
    camera::Mask mask{size, size, {}};
    for (int i = 0; i < size * size; ++i) {
        const float x = 2.f * (i % size + 0.5f) / size - 1, y = 2.f * (i / size + 0.5f) / size - 1;
        mask.texels.push_back(std::max(0.f, 1 - x * x - y * y));
    }
    return mask;
}

// Wavy rim of 5000 vertices around 8 holes: what a detailed SVG comes to.
camera::Polygon gear() {
    camera::Polygon out{{{}}};
    const auto at = [](double r, double turn) {
        return V2d(std::cos(2 * std::numbers::pi * turn), std::sin(2 * std::numbers::pi * turn)) *
               r;
    };
    for (int i = 0; i < 5000; ++i)
        out.contours[0].push_back(
            at(1 + 0.1 * std::sin(i * 2 * std::numbers::pi / 100), i / 5000.0));
    for (int k = 0; k < 8; ++k) {
        out.contours.emplace_back();
        for (int i = 0; i < 40; ++i)
            out.contours[k + 1].push_back(at(0.6, k / 8.0) + at(0.1, -i / 40.0));
    }
    return out;
}

std::vector<std::pair<const char*, camera::ApertureShape>> shapes() {
    return {{"circle", camera::Disk()},
            {"square", camera::square()},
            {"triangle", camera::regular_polygon(3)},
            {"rhomboid", camera::rhomboid()},
            {"frame", camera::frame()},
            {"star:5", camera::star(5)},
            {"polygon:6", camera::regular_polygon(6)},
            {"polygon:9,0,0.5", camera::regular_polygon(9, 0, 0.5)},
            {"gear", gear()},
            {"mask 64", vignette(64)},
            {"mask 1024", vignette(1024)}};
}

void sample(benchmark::State& state, const camera::ApertureShape& shape, camera::IrisSampling way) {
    const camera::Iris iris(shape, 10, camera::ApertureScale::EqualArea, way);
    std::vector<V2f> u;
    test::Random random(1);
    for (size_t i = 0; i < kArguments; ++i) u.push_back(random.next2());
    size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(iris.sample(u[i++ % kArguments]));
}

void transmits(benchmark::State& state, const camera::ApertureShape& shape) {
    const camera::Iris iris(shape, 10);
    std::vector<V2f> points;
    test::Random random(2);
    for (size_t i = 0; i < kArguments; ++i)
        points.push_back((random.next2() * 2.f - V2f(1)) * iris.bounding_radius_mm());
    size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(iris.transmits(points[i++ % kArguments]));
}

void make(benchmark::State& state, const camera::ApertureShape& shape) {
    for (auto _ : state) benchmark::DoNotOptimize(camera::Iris(shape, 10));
}

const bool registered = [] {
    constexpr const char* names[] = {"formula", "triangles", "rejection"};
    for (const auto& [name, shape] : shapes()) {
        for (const camera::IrisSampling way : camera::iris_samplings(shape))
            benchmark::RegisterBenchmark(
                (std::string("sample/") + names[static_cast<int>(way)] + "/" + name).c_str(),
                [shape = shape, way](benchmark::State& s) { sample(s, shape, way); });
        benchmark::RegisterBenchmark((std::string("transmits/") + name).c_str(),
                                     [shape = shape](benchmark::State& s) { transmits(s, shape); });
        benchmark::RegisterBenchmark((std::string("make/") + name).c_str(),
                                     [shape = shape](benchmark::State& s) { make(s, shape); });
    }
    return true;
}();

}  // namespace
}  // namespace petzval
