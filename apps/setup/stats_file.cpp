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

nlohmann::ordered_json files_of(const std::vector<WriteOutcome>& outputs) {
    auto out = nlohmann::ordered_json::array();
    for (const WriteOutcome& output : outputs) {
        nlohmann::ordered_json one{{"file", output.wanted.string()}, {"error", nullptr}};
        one["rescue"] = nullptr;
        if (!output.written()) one["error"] = output.error;
        if (!output.rescue.empty()) one["rescue"] = output.rescue.string();
        out.push_back(std::move(one));
    }
    return out;
}

}  // namespace

double peak_memory_mib() {
    rusage self{};
    getrusage(RUSAGE_SELF, &self);
    return static_cast<double>(self.ru_maxrss) / 1024;
}

void write_stats(const std::filesystem::path& path, const RenderSetup& setup,
                 const RenderResult& result, const RenderCost& cost, const RunReport& run,
                 const Film& film) {
    const PathStats& s = result.stats;
    const uint64_t rays = s.camera_rays + s.bounce_rays + s.shadow_rays;
    // A render that was stopped at once took no time that the clock shows.
    const auto per_cpu_s = [&](uint64_t count) -> nlohmann::ordered_json {
        if (!(cost.render_cpu_s > 0)) return nullptr;
        return static_cast<double>(count) / cost.render_cpu_s;
    };
    nlohmann::ordered_json out;
    out["schema"] = "petzval.stats";
    out["version"] = 1;
    out["program"] = program_version();
    out["size_px"] = {film.full_size().x, film.full_size().y};
    out["samples_per_pixel"] = result.end_sample;
    out["pixel_samples"] = s.samples;
    // The digits that were typed or printed, not those of the float.
    out["exposure_ev"] = nlohmann::ordered_json::parse(fmt::format("{}", setup.from.exposure_ev));
    out["threads"] = cost.threads;
    out["threads_that_worked"] = result.workers;
    out["stopped_by"] = nullptr;
    if (run.stopped_by) out["stopped_by"] = run.stopped_by;
    out["phase_s"] = nlohmann::ordered_json::object();
    for (const auto& [name, seconds] : run.phase_s) out["phase_s"][name] = seconds;
    out["load_s"] = setup.from.load_s;
    out["bvh_build_s"] = setup.from.bvh_s;
    out["render_wall_s"] = cost.render_wall_s;
    out["render_cpu_s"] = cost.render_cpu_s;
    out["rays"] = {{"camera", s.camera_rays},
                   {"bounce", s.bounce_rays},
                   {"shadow", s.shadow_rays},
                   {"to_targets", s.target_rays},
                   {"all", rays}};
    out["lens_lanes"] = lens_lanes(s.lens_lanes);
    out["path_vertices"] = s.vertices;
    out["paths_ended_in_clear_glass"] = s.clear_ends;
    out["rays_per_cpu_s"] = per_cpu_s(rays);
    out["samples_per_cpu_s"] = per_cpu_s(s.samples);
    out["cpu_time"] = sections(s, cost.render_cpu_s);
    out["bad_samples"] = film.bad_count();
    out["peak_memory_mib"] = peak_memory_mib();
    out["outputs"] = files_of(run.outputs);
    out["notices"] = run.notices;
    out["warnings"] = run.warnings;
    out["errors"] = run.errors;
    // Names of files need not be UTF-8.
    const std::string text =
        out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    write_file_atomically(path, {text.begin(), text.end()});
}

}  // namespace petzval
