// SPDX-License-Identifier: Apache-2.0
// How long it takes from nothing to the first ray, for every lens that ships and a scene of one
// triangle. Each figure is the median of several processes that are forked before anything is done,
// so that none finds what another has warmed up; loading the program itself is not in it. Stages
// are measured one by one, each in its own process; glasses and table are part of lens and set-up.
//
//   startup [RUNS]
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>

#include "camera/pupil.h"
#include "io/glasses.h"
#include "io/gltf.h"
#include "io/lens_file.h"
#include "io/session.h"
#include "tests/bench/noise.h"

namespace petzval {
namespace {

namespace fs = std::filesystem;

constexpr double kWanted_ms = 50, kWantedSetUp_ms = 10;

constexpr const char* kTriangle = R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
"min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{
"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";

double ms_of(const std::function<void()>& f) {
    const auto start = std::chrono::steady_clock::now();
    f();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

// What f returns in a process of its own; nothing where it fails there.
std::optional<double> in_child(const std::function<double()>& f) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return std::nullopt;
    const pid_t child = fork();
    if (child == 0) {
        try {
            const double value = f();
            _exit(write(ends[1], &value, sizeof value) == sizeof value ? 0 : 1);
        } catch (const std::exception& e) {
            fmt::print(stderr, "{}\n", e.what());
            _exit(1);
        }
    }
    close(ends[1]);
    double value = 0;
    const bool whole = child > 0 && read(ends[0], &value, sizeof value) == sizeof value;
    close(ends[0]);
    if (child > 0) waitpid(child, nullptr, 0);
    return whole ? std::optional(value) : std::nullopt;
}

double median_of(int runs, const std::function<double()>& f) {
    std::vector<double> values;
    for (int i = 0; i < runs; ++i)
        if (const auto value = in_child(f)) values.push_back(*value);
    return values.empty() ? NAN : median(values);
}

SceneRequest request_for(const fs::path& scene, const std::string& lens) {
    SceneRequest request;
    request.scene = scene;
    request.look_at = {V3f(0, 0, 10), V3f(0, 0, 0)};
    request.focus = FocusDistance{10};
    request.lens.emplace().lens = lens;
    return request;
}

const auto kSilent = [](const std::string&) {};

double first_ray_ms(const SceneRequest& request) {
    return ms_of([&] {
        const Session session = open_session(request, kSilent);
        const Sampler sampler(SamplerKind::Owen, 0, {0, 0, 0});
        const Bands bands = session.observer.draw(0.5f);
        const CameraSample seen = session.camera->sample({V2f(0.5f, 0.5f), sampler}, bands);
        if (seen.count > 0) static_cast<void>(session.bvh->intersect(seen.path[0].ray));
    });
}

// Focus, f-number, table, irradiance: what is neither reading nor tree.
double set_up_ms(const SceneRequest& request) {
    double rest_ms = 0;
    const double all_ms = ms_of([&] {
        const Session session = open_session(request, kSilent);
        rest_ms = 1e3 * (session.load_s + session.bvh_s);
    });
    return all_ms - rest_ms;
}

double table_ms(const std::string& name) {
    const Lens lens(load_lens(name).lens);
    const double reach_mm = std::min(lens.prescription().image_circle_mm / 2, 21.6);
    return ms_of([&] { static_cast<void>(Pupil(lens, lens.film_mm(), reach_mm)); });
}

double bvh_ms(const SceneRequest& request) {
    return 1e3 * open_session(request, kSilent).bvh_s;
}

double spectra_ms(const fs::path& scene) {
    GltfFile file = load_gltf(scene);
    SpectralRequest request;
    request.mode = SpectralMode::Hero;
    return ms_of([&] { static_cast<void>(set_up_spectra(request, file.scene, kSilent)); });
}

int run(int runs) {
    const fs::path scene =
        fs::temp_directory_path() / fmt::format("petzval-startup-{}.gltf", getpid());
    std::ofstream(scene) << kTriangle;
    const auto median_ms = [&](const std::function<double()>& f) { return median_of(runs, f); };
    const auto lenses = list_lenses();
    const auto any = request_for(scene, lenses.front().name);
    fmt::print(
        "Milliseconds, median of {}. All lenses: scene {:.1f}, spectra {:.1f}, tree {:.1f}, "
        "catalogue of glasses {:.1f}\n\n",
        runs, median_ms([&] { return ms_of([&] { static_cast<void>(load_gltf(scene)); }); }),
        median_ms([&] { return spectra_ms(scene); }), median_ms([&] { return bvh_ms(any); }),
        median_ms([] { return ms_of([] { static_cast<void>(glass_catalog()); }); }));
    fmt::print(
        "| lens | file | set-up | of which table | to the first ray |\n|---|---|---|---|---|\n");
    bool kept = true;
    for (const LensSummary& lens : lenses) {
        const SceneRequest request = request_for(scene, lens.name);
        const double file_ms =
            median_ms([&] { return ms_of([&] { static_cast<void>(load_lens(lens.name)); }); });
        const double camera_ms = median_ms([&] { return set_up_ms(request); });
        const double filled_ms = median_ms([&] { return table_ms(lens.name); });
        const double all_ms = median_ms([&] { return first_ray_ms(request); });
        fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} |\n", lens.name, file_ms, camera_ms,
                   filled_ms, all_ms);
        kept = kept && all_ms <= kWanted_ms && camera_ms <= kWantedSetUp_ms;
    }
    fs::remove(scene);
    fmt::print("\n{}: {:g} ms to the first ray, {:g} ms of set-up\n",
               kept ? "kept by all" : "NOT kept by all", kWanted_ms, kWantedSetUp_ms);
    return kept ? 0 : 1;
}

}  // namespace
}  // namespace petzval

int main(int argc, char** argv) {
    try {
        return petzval::run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 5);
    } catch (const std::exception& e) {
        fmt::print(stderr, "{}\n", e.what());
        return 1;
    }
}
