// SPDX-License-Identifier: Apache-2.0
// How long it takes from nothing to the first ray, for every lens that ships and a scene of one
// triangle. Each figure is the least of several processes that are forked before anything is done,
// so that none finds what another has warmed up; loading the program itself is not in it. What
// counts is the CPU time of the main thread, as others may use the machine: on an idle one that is
// what a clock shows. The clock's median stands beside it. The catalogue is part of the file, and
// the table of the set-up.
//
//   startup [RUNS]
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>

#include "apps/setup/render_setup.h"
#include "camera/lens/ray_aiming.h"
#include "io/glass/catalogue.h"
#include "io/gltf/gltf.h"
#include "io/lens/lens_file.h"
#include "tests/measure/noise.h"

namespace petzval {
namespace {

namespace fs = std::filesystem;

constexpr double kWanted_ms = 50, kWantedSetUp_ms = 10;

constexpr const char* kTriangle = R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
"min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{
"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";

double thread_cpu_ms() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

double clock_ms() {
    return std::chrono::duration<double, std::milli>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

double ms_of(const std::function<void()>& f, double (*now_ms)() = thread_cpu_ms) {
    const double start_ms = now_ms();
    f();
    return now_ms() - start_ms;
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

std::vector<double> measured(int runs, const std::function<double()>& f) {
    std::vector<double> values;
    for (int i = 0; i < runs; ++i)
        if (const auto value = in_child(f)) values.push_back(*value);
    if (values.empty()) values.push_back(NAN);
    std::sort(values.begin(), values.end());
    return values;
}

apps::SceneRequest request_for(const fs::path& scene, const std::string& lens) {
    apps::SceneRequest request;
    request.scene = scene;
    request.camera.look_at = {V3f(0, 0, 10), V3f(0, 0, 0)};
    request.camera.focus = apps::FocusDistance{10};
    request.camera.lens = lens;
    return request;
}

const auto kSilent = [](const std::string&) {};

double first_ray_ms(const apps::SceneRequest& request, double (*now_ms)() = thread_cpu_ms) {
    return ms_of(
        [&] {
            const apps::RenderSetup setup = apps::set_up_render(request, kSilent);
            const Sampler sampler(SamplerKind::Owen, 0, {0, 0, 0});
            const Bands bands = setup.view.observer.draw(0.5f);
            const camera::CameraSample seen =
                setup.view.still->sample({V2f(0.5f, 0.5f), sampler}, bands);
            if (seen.size() > 0) static_cast<void>(setup.prepared.bvh->intersect(seen[0].ray));
        },
        now_ms);
}

// The same without a lens: what is left of the difference, the lens's file taken off, is focus,
// f-number, table and irradiance.
double without_lens_ms(apps::SceneRequest request) {
    request.camera.lens.reset();
    request.spectral.mode = apps::SpectralMode::Wavelengths;
    request.camera.fstop = 2;
    return first_ray_ms(request);
}

double table_ms(const std::string& name) {
    const camera::Lens lens(io::load_lens(name).lens);
    const double reach_mm = std::min(lens.prescription().image_circle_mm / 2, 21.6);
    return ms_of([&] { static_cast<void>(camera::RayAimer(lens, lens.film_mm(), reach_mm)); });
}

double tree_ms(const fs::path& scene) {
    io::GltfFile file = io::load_gltf(scene);
    finish_scene(file.scene);
    return ms_of([&] { static_cast<void>(Bvh(file.scene, Traversal::Robust)); });
}

double spectra_ms(const fs::path& scene) {
    io::GltfFile file = io::load_gltf(scene);
    apps::SpectralRequest request;
    request.mode = apps::SpectralMode::Wavelengths;
    return ms_of(
        [&] { static_cast<void>(apps::set_up_spectra(request, file.scene, "", false, kSilent)); });
}

int run(int runs) {
    const fs::path scene =
        fs::temp_directory_path() / fmt::format("petzval-startup-{}.gltf", getpid());
    std::ofstream(scene) << kTriangle;
    const auto least_ms = [&](const std::function<double()>& f) {
        return measured(runs, f).front();
    };
    const auto lenses = io::list_lenses();
    const double bare_ms =
        least_ms([&] { return without_lens_ms(request_for(scene, lenses.front().name)); });
    fmt::print(
        "Milliseconds, least of {}. All lenses: scene {:.1f}, spectra {:.1f}, tree {:.1f}, "
        "catalogue of glasses {:.1f}\n\n",
        runs, least_ms([&] { return ms_of([&] { static_cast<void>(io::load_gltf(scene)); }); }),
        least_ms([&] { return spectra_ms(scene); }), least_ms([&] { return tree_ms(scene); }),
        least_ms([] { return ms_of([] { static_cast<void>(io::glass_catalog()); }); }));
    fmt::print(
        "| lens | file | set-up | of which table | to the first ray | by the clock "
        "|\n|---|---|---|---|---|---|\n");
    bool kept = true;
    for (const io::LensSummary& lens : lenses) {
        const apps::SceneRequest request = request_for(scene, lens.name);
        const double file_ms =
            least_ms([&] { return ms_of([&] { static_cast<void>(io::load_lens(lens.name)); }); });
        const double filled_ms = least_ms([&] { return table_ms(lens.name); });
        const double all_ms = least_ms([&] { return first_ray_ms(request); });
        std::vector<double> by_clock_ms =
            measured(runs, [&] { return first_ray_ms(request, clock_ms); });
        const double camera_ms = all_ms - bare_ms - file_ms;
        fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} |\n", lens.name, file_ms,
                   camera_ms, filled_ms, all_ms, median(by_clock_ms));
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
