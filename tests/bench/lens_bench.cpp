// SPDX-License-Identifier: Apache-2.0
// What a ray through a lens costs, from the film to the scene: for a surface with all lanes, and
// for a surface and one of the wavelengths that the kind of number carries.
#include <benchmark/benchmark.h>

#include <vector>

#include "camera/lens/trace.h"
#include "tests/support/lens_json.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

constexpr size_t kRays = 1024;

/// From points of the film to points of the last surface's inner half.
template <class N>
std::vector<camera::LensRay<N>> rays_for(const camera::Lens& lens) {
    using V = camera::ValueOf<N>;
    test::Random random(1);
    std::vector<camera::LensRay<N>> rays(kRays);
    const auto& back = lens.prescription().surfaces.back();
    for (auto& ray : rays) {
        const V2f film = (random.next2() - V2f(0.5f)) * 10.f;
        const V2f aim = (random.next2() - V2f(0.5f)) * float(back.semi_diameter_mm);
        const V3f from(film.x, film.y, float(back.thickness_mm));
        const V3f along = (V3f(aim.x, aim.y, 0) - from).normalized();
        const auto vector = [](const V3f& a) {
            return camera::Vec3<N>{camera::constant<N>(camera::broadcast<V>(a.x)),
                                   camera::constant<N>(camera::broadcast<V>(a.y)),
                                   camera::constant<N>(camera::broadcast<V>(a.z))};
        };
        ray.origin = vector(from), ray.direction = vector(along), ray.counted_from = lens.last();
    }
    return rays;
}

template <class V>
camera::LensIndices<V> indices_for(const camera::Lens& lens) {
    const auto exact = lens.exact_indices(d4{486.1327, 540, 587.5618, 656.2725});
    camera::LensIndices<V> out{};
    for (size_t i = 0; i < lens.media().size(); ++i)
        for (int k = 0; k < camera::NumberTraits<V>::lanes; ++k) {
            if constexpr (camera::NumberTraits<V>::lanes == 1)
                out.of_medium[i] = static_cast<V>(exact.of_medium[i][k]);
            else
                out.of_medium[i][k] = static_cast<camera::ScalarOf<V>>(exact.of_medium[i][k]);
        }
    return out;
}

template <class N>
void film_to_scene(benchmark::State& state, const char* name) {
    const camera::Lens lens(test::read_lens(name));
    const auto rays = rays_for<N>(lens);
    const auto indices = indices_for<camera::ValueOf<N>>(lens);
    size_t i = 0, passed = 0;
    for (auto _ : state) {
        camera::LensRay<N> ray = rays[i++ % kRays];
        const auto alive = camera::trace_lens(
            {lens, camera::Towards::Scene, {0, lens.last()}, camera::Clip::No}, indices, ray);
        passed += camera::all(alive);
        benchmark::DoNotOptimize(ray);
    }
    if (passed != i) state.SkipWithError("not all rays pass");
    using Counter = benchmark::Counter;
    const auto per = [&](int n) {
        return Counter(lens.size() * n, Counter::kIsIterationInvariantRate | Counter::kInvert);
    };
    state.counters["per_surface"] = per(1);
    state.counters["per_surface_and_wavelength"] = per(camera::NumberTraits<N>::lanes);
}

void indices_of_four_wavelengths(benchmark::State& state) {
    const camera::Lens lens(test::read_lens("double-gauss-100mm-f2"));
    f4 nm{400, 500, 600, 700};
    for (auto _ : state) {
        benchmark::DoNotOptimize(nm);
        benchmark::DoNotOptimize(lens.indices(nm));
    }
}
BENCHMARK(indices_of_four_wavelengths);

constexpr auto one_float = film_to_scene<float>;
constexpr auto four_floats = film_to_scene<f4>;
constexpr auto four_doubles = film_to_scene<d4>;
constexpr auto four_floats_derived = film_to_scene<camera::Dual<f4>>;
constexpr auto four_doubles_derived = film_to_scene<camera::Dual<d4>>;
BENCHMARK_CAPTURE(one_float, double_gauss, "double-gauss-100mm-f2");
BENCHMARK_CAPTURE(four_floats, double_gauss, "double-gauss-100mm-f2");
BENCHMARK_CAPTURE(four_doubles, double_gauss, "double-gauss-100mm-f2");
BENCHMARK_CAPTURE(four_floats_derived, double_gauss, "double-gauss-100mm-f2");
BENCHMARK_CAPTURE(four_doubles_derived, double_gauss, "double-gauss-100mm-f2");
BENCHMARK_CAPTURE(four_floats, asphere, "canon-14mm-f2.8-asph");
BENCHMARK_CAPTURE(four_floats, cylinders, "schneider-anamorphic-31mm");

}  // namespace
}  // namespace petzval
