// SPDX-License-Identifier: Apache-2.0
// What a sample of the lens camera costs, alone and among eight, which share of them gets through
// the lens, and how long a lens takes to set up: at the filed stop and at f/4, in each dispersion
// mode.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
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

camera::LensCameraInput input_of(const std::string& name, double fnumber) {
    auto lens = std::make_shared<const camera::Lens>(io::load_lens(name).lens);
    const camera::FirstOrder first = camera::first_order(*lens, kLineD_nm);
    const double filed = lens->prescription().surfaces[size_t(lens->stop())].semi_diameter_mm;
    const double scale = fnumber > 0 ? first.fnumber / fnumber : 1;
    camera::LensCameraInput in{.lens = lens,
                               .iris = camera::Iris(camera::Disk{}, filed * std::min(scale, 1.)),
                               .to_world = M44f()};
    in.film_mm = lens->film_mm();
    // The largest 3 : 2 frame in the image circle.
    in.film_width_mm = lens->prescription().image_circle_mm * 0.83;
    in.film_height_mm = in.film_width_mm * 2 / 3;
    in.entrance_pupil_mm = first.entrance_pupil_mm;
    in.dispersion = camera::DispersionMode::Hero;
    return in;
}

Bands four_wavelengths(float shift) {
    Bands bands = Bands::rgb();
    bands.spectral = true;
    bands.on = m4{-1, -1, -1, -1};
    for (int i = 0; i < 4; ++i) bands.nm[i] = 400.f + 75.f * (float(i) + shift);
    return bands;
}

/// What a render does: samples of `together` film points at once. Time is of one sample.
void sample(benchmark::State& state, const char* name, double fnumber, camera::DispersionMode mode,
            size_t together) {
    camera::LensCameraInput in = input_of(name, fnumber);
    in.dispersion = mode;
    const camera::LensCamera camera(in);
    const Filter filter(FilterKind::BlackmanHarris, 1.5f);
    test::Random random(1);
    constexpr size_t kSamples = 4096;
    std::vector<camera::FilmPoint> points(kSamples);
    std::vector<Bands> bands(kSamples);
    for (uint32_t i = 0; i < kSamples; ++i) {
        const V2f offset = filter.sample(random.next2());
        points[i] = {random.next2(),
                     Sampler(SamplerKind::Owen, 0, {0, 0, i}),
                     {&filter, offset, {480, 320}}};
        bands[i] = four_wavelengths(random.next());
        bands[i].hero = int(random.next() * 4);
    }
    std::array<camera::CameraSample, camera::kMostFilmPoints> out;
    size_t at = 0, passed = 0, all = 0;
    for (auto _ : state) {
        camera.sample_all({&points[at], together}, {&bands[at], together}, {out.data(), together});
        for (size_t i = 0; i < together; ++i) passed += !out[i].empty();
        all += together;
        at = (at + together) % kSamples;
    }
    state.SetItemsProcessed(int64_t(all));
    state.counters["passed"] = double(passed) / double(all);
}

void set_up(benchmark::State& state, const std::string& name) {
    const camera::LensCameraInput in = input_of(name, kFiled);
    for (auto _ : state) benchmark::DoNotOptimize(camera::LensCamera(in));
}

const bool registered = [] {
    for (const char* name : {"takumar-50mm-f1.2", "double-gauss-100mm-f2", "canon-14mm-f2.8-asph",
                             "schneider-anamorphic-31mm", "minolta-fisheye-16mm-f2.8"})
        for (const double fnumber : {kFiled, 4.})
            for (const auto& [mode, label] : {std::pair{camera::DispersionMode::Shared, "/shared"},
                                              {camera::DispersionMode::Hero, "/hero"},
                                              {camera::DispersionMode::Split, "/split"}})
                for (const size_t together : {size_t{1}, camera::kMostFilmPoints})
                    benchmark::RegisterBenchmark(
                        (std::string("sample/") + name + (fnumber > 0 ? "/f4" : "/filed") + label +
                         "/" + std::to_string(together))
                            .c_str(),
                        sample, name, fnumber, mode, together);
    for (const io::LensSummary& lens : io::list_lenses())
        benchmark::RegisterBenchmark(("set_up/" + lens.name).c_str(), set_up, lens.name)
            ->Unit(benchmark::kMillisecond);
    return true;
}();

}  // namespace
}  // namespace petzval
