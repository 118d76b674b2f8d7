// SPDX-License-Identifier: Apache-2.0
// What a draw of the lens camera costs, which share of the draws gets through the lens, and how
// long a lens takes to set up: at the filed stop and at f/4, in RGB and with four wavelengths.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "camera/lens/paraxial.h"
#include "camera/models/lens_camera.h"
#include "io/lens/lens_file.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

constexpr double kFiled = 0;  ///< f-number: the stop as it is

LensCameraInput input_of(const std::string& name, double fnumber) {
    auto lens = std::make_shared<const Lens>(load_lens(name).lens);
    const FirstOrder first = first_order(*lens, kLineD_nm);
    const double filed = lens->prescription().surfaces[size_t(lens->stop())].semi_diameter_mm;
    const double scale = fnumber > 0 ? first.fnumber / fnumber : 1;
    LensCameraInput in{
        .lens = lens, .iris = Iris(Disk{}, filed * std::min(scale, 1.)), .to_world = M44f()};
    in.film_mm = lens->film_mm();
    // The largest 3 : 2 frame in the image circle.
    in.film_width_mm = lens->prescription().image_circle_mm * 0.83;
    in.film_height_mm = in.film_width_mm * 2 / 3;
    in.entrance_pupil_mm = first.entrance_pupil_mm;
    in.dispersion = DispersionMode::Hero;
    return in;
}

Bands four_wavelengths(float shift) {
    Bands bands = Bands::rgb();
    bands.spectral = true;
    bands.on = m4{-1, -1, -1, -1};
    for (int i = 0; i < 4; ++i) bands.nm[i] = 400.f + 75.f * (float(i) + shift);
    return bands;
}

void draw(benchmark::State& state, const char* name, double fnumber, bool spectral) {
    const LensCamera camera(input_of(name, fnumber));
    const LensCameraInput in = input_of(name, fnumber);
    test::Random random(1);
    constexpr size_t kDraws = 4096;
    struct Numbers {
        V2f film, u;
        Bands bands;
    };
    std::vector<Numbers> numbers(kDraws);
    for (auto& n : numbers) {
        n.film =
            (random.next2() - V2f(0.5f)) * V2f(float(in.film_width_mm), float(in.film_height_mm));
        n.u = random.next2();
        n.bands = spectral ? four_wavelengths(random.next()) : Bands::rgb();
        n.bands.lead = int(random.next() * float(lane_count(n.bands.on)));
    }
    size_t i = 0, passed = 0;
    for (auto _ : state) {
        const Numbers& n = numbers[i++ % kDraws];
        const auto drawn = camera.draw(n.film, n.u, n.bands);
        passed += any(drawn.weight > 0.f);
        benchmark::DoNotOptimize(drawn);
    }
    state.counters["passed"] = double(passed) / double(i);
}

void set_up(benchmark::State& state, const std::string& name) {
    const LensCameraInput in = input_of(name, kFiled);
    for (auto _ : state) benchmark::DoNotOptimize(LensCamera(in));
}

const bool registered = [] {
    for (const char* name : {"takumar-50mm-f1.2", "double-gauss-100mm-f2", "canon-14mm-f2.8-asph",
                             "schneider-anamorphic-31mm", "minolta-fisheye-16mm-f2.8"})
        for (const double fnumber : {kFiled, 4.})
            for (const bool spectral : {false, true})
                benchmark::RegisterBenchmark(
                    (std::string("draw/") + name + (fnumber > 0 ? "/f4" : "/filed") +
                     (spectral ? "/spectral" : "/rgb"))
                        .c_str(),
                    draw, name, fnumber, spectral);
    for (const LensSummary& lens : list_lenses())
        benchmark::RegisterBenchmark(("set_up/" + lens.name).c_str(), set_up, lens.name)
            ->Unit(benchmark::kMillisecond);
    return true;
}();

}  // namespace
}  // namespace petzval
