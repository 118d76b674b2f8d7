// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/stats_file.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "apps/setup/develop.h"
#include "io/base/atomic_file.h"

namespace petzval {
namespace {

// CPU seconds of the render by section: shares of the timed samples, applied to the whole.
nlohmann::ordered_json sections(const PathStats& stats, double cpu_s) {
    const auto ticks = [&](TimedSection s) {
        return static_cast<double>(stats.ticks[static_cast<size_t>(s)]);
    };
    const double whole = ticks(TimedSection::Sample);
    if (whole <= 0) return nullptr;
    const double camera = ticks(TimedSection::Camera), traversal = ticks(TimedSection::Traversal),
                 texture = ticks(TimedSection::Texture);
    return {{"camera_s", cpu_s * camera / whole},
            {"traversal_s", cpu_s * traversal / whole},
            {"texture_s", cpu_s * texture / whole},
            {"shading_s", cpu_s * (whole - camera - traversal - texture) / whole}};
}

// Lens losses of the lanes that were drawn; null for a camera without a lens.
nlohmann::ordered_json lens_lanes(const LensLosses<uint64_t>& lanes) {
    if (lanes.drawn == 0) return nullptr;
    return {{"drawn", lanes.drawn},         {"passed", lanes.drawn - lanes.lost()},
            {"vignetted", lanes.vignetted}, {"totally_reflected", lanes.totally_reflected},
            {"missed", lanes.missed},       {"unreached", lanes.unreached}};
}

}  // namespace

double peak_memory_mib() {
    rusage self{};
    getrusage(RUSAGE_SELF, &self);
    return static_cast<double>(self.ru_maxrss) / 1024;
}

void write_stats(const std::filesystem::path& path, const RenderSetup& setup,
                 const RenderResult& result, const RenderCost& cost, const Film& film) {
    const PathStats& s = result.stats;
    const uint64_t rays = s.camera_rays + s.bounce_rays + s.shadow_rays;
    nlohmann::ordered_json out;
    out["program"] = program_version();
    out["size_px"] = {film.full_size().x, film.full_size().y};
    out["samples_per_pixel"] = result.end_sample;
    out["pixel_samples"] = s.samples;
    // The digits that were typed or printed, not those of the float.
    out["exposure_ev"] = nlohmann::ordered_json::parse(fmt::format("{}", setup.from.exposure_ev));
    out["threads"] = cost.threads;
    out["threads_that_worked"] = result.workers;
    out["load_s"] = setup.from.load_s;
    out["bvh_build_s"] = setup.from.bvh_s;
    out["render_wall_s"] = cost.render_wall_s;
    out["render_cpu_s"] = cost.render_cpu_s;
    out["rays"] = {{"camera", s.camera_rays},
                   {"bounce", s.bounce_rays},
                   {"shadow", s.shadow_rays},
                   {"all", rays}};
    out["lens_lanes"] = lens_lanes(s.lens_lanes);
    out["path_vertices"] = s.vertices;
    out["rays_per_cpu_s"] = static_cast<double>(rays) / cost.render_cpu_s;
    out["samples_per_cpu_s"] = static_cast<double>(s.samples) / cost.render_cpu_s;
    out["cpu_time"] = sections(s, cost.render_cpu_s);
    out["bad_samples"] = film.bad_count();
    out["peak_memory_mib"] = peak_memory_mib();
    const std::string text = out.dump(2) + "\n";
    write_file_atomically(path, {text.begin(), text.end()});
}

}  // namespace petzval
