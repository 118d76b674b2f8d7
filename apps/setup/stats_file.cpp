// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/stats_file.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

#include "io/build/build.h"
#include "io/file/atomic_file.h"

namespace petzval::apps {
namespace {

// CPU seconds of the render by section: shares of the timed samples, applied to the whole.
nlohmann::ordered_json sections(const integrator::PathStats& stats, double cpu_s) {
    const auto ticks = [&](integrator::TimedSection s) {
        return static_cast<double>(stats.ticks[static_cast<size_t>(s)]);
    };
    const double whole = ticks(integrator::TimedSection::Sample);
    if (whole <= 0) return nullptr;
    const double camera = ticks(integrator::TimedSection::Camera),
                 traversal = ticks(integrator::TimedSection::Traversal),
                 texture = ticks(integrator::TimedSection::Texture);
    return {{"camera_s", cpu_s * camera / whole},
            {"traversal_s", cpu_s * traversal / whole},
            {"texture_s", cpu_s * texture / whole},
            {"shading_s", cpu_s * (whole - camera - traversal - texture) / whole}};
}

// Lens losses of the lanes that were drawn; null for a camera without a lens.
nlohmann::ordered_json lens_lanes(const camera::LensLosses<uint64_t>& lanes) {
    if (lanes.drawn == 0) return nullptr;
    return {{"drawn", lanes.drawn},         {"passed", lanes.drawn - lanes.lost()},
            {"vignetted", lanes.vignetted}, {"totally_reflected", lanes.totally_reflected},
            {"missed", lanes.missed},       {"unreached", lanes.unreached}};
}

nlohmann::ordered_json files_of(const std::vector<io::WriteOutcome>& outputs) {
    auto out = nlohmann::ordered_json::array();
    for (const io::WriteOutcome& output : outputs) {
        nlohmann::ordered_json one{{"file", output.wanted.string()}, {"error", nullptr}};
        one["rescue"] = nullptr;
        if (!output.written()) one["error"] = output.error;
        if (!output.rescue.empty()) one["rescue"] = output.rescue.string();
        out.push_back(std::move(one));
    }
    return out;
}

// Calls f(name, number) for each number that is kept in a state.
template <class Figures, class F>
void for_each_number(Figures& f, const F& each) {
    auto& s = f.stats;
    each("camera_rays", s.camera_rays);
    each("bounce_rays", s.bounce_rays);
    each("shadow_rays", s.shadow_rays);
    each("target_rays", s.target_rays);
    each("vertices", s.vertices);
    each("clear_ends", s.specular_ends);
    each("tiles", s.tiles);
    each("samples", s.samples);
    each("timed_samples", s.timed_samples);
    each("lanes_drawn", s.lens_lanes.drawn);
    each("lanes_vignetted", s.lens_lanes.vignetted);
    each("lanes_totally_reflected", s.lens_lanes.totally_reflected);
    each("lanes_missed", s.lens_lanes.missed);
    each("lanes_unreached", s.lens_lanes.unreached);
    each("mirrored_bounces", s.mirrored.bounces);
    each("mirrored_lamps", s.mirrored.lamps);
    each("caustic_bounces", s.caustic.bounces);
    each("caustic_lamps", s.caustic.lamps);
    each("ticks", s.ticks);
    each("load_s", f.load_s);
    each("bvh_s", f.bvh_s);
    each("render_wall_s", f.render_wall_s);
    each("render_cpu_s", f.render_cpu_s);
    each("threads", f.threads);
    each("workers", f.workers);
    each("peak_memory_mib", f.peak_memory_mib);
}

}  // namespace

double peak_memory_mib() {
    rusage self{};
    getrusage(RUSAGE_SELF, &self);
    return static_cast<double>(self.ru_maxrss) / 1024;
}

RunFigures& RunFigures::operator+=(const RunFigures& o) {
    stats += o.stats;
    load_s += o.load_s;
    bvh_s += o.bvh_s;
    render_wall_s += o.render_wall_s;
    render_cpu_s += o.render_cpu_s;
    threads = std::max(threads, o.threads);
    workers = std::max(workers, o.workers);
    peak_memory_mib = std::max(peak_memory_mib, o.peak_memory_mib);
    return *this;
}

nlohmann::ordered_json to_json(const RunFigures& f) {
    nlohmann::ordered_json out;
    for_each_number(f, [&](const char* name, const auto& number) { out[name] = number; });
    return out;
}

RunFigures figures_from(const nlohmann::ordered_json& json) {
    RunFigures f;
    for_each_number(f, [&](const char* name, auto& number) { json.at(name).get_to(number); });
    return f;
}

void write_stats(const std::filesystem::path& path, const StatsPicture& picture,
                 const RunFigures& figures, const RunReport& run) {
    const integrator::PathStats& s = figures.stats;
    const uint64_t rays = s.camera_rays + s.bounce_rays + s.shadow_rays;
    // A render that was stopped at once took no time that the clock shows.
    const auto per_cpu_s = [&](uint64_t count) -> nlohmann::ordered_json {
        if (!(figures.render_cpu_s > 0)) return nullptr;
        return static_cast<double>(count) / figures.render_cpu_s;
    };
    nlohmann::ordered_json out;
    out["schema"] = "petzval.stats";
    out["version"] = 1;
    out["program"] = io::program_version();
    out["build"] = io::build_description();
    out["size_px"] = {picture.width, picture.height};
    out["samples_per_pixel"] = picture.samples.count();
    out["pixel_samples"] = s.samples;
    if (const auto& noise = picture.noise)
        out["noise"] = {{"picture", noise->noise},
                        {"worst_cell", noise->worst_cell},
                        {"floor_nits", noise->floor_nits},
                        {"cells", noise->cells},
                        {"cells_left", noise->left},
                        {"cells_at_least", noise->at_least},
                        {"mean_samples_per_pixel", noise->mean_samples}};
    if (const auto& denoised = picture.denoised) {
        const auto json = [](const DenoisedError& error) -> nlohmann::ordered_json {
            return {{"error", error.value()},
                    {"is_at_most", error.is_at_most()},
                    {"bounds", {error.least(), error.most()}}};
        };
        out["denoised"] = {{"picture", json(denoised->error)},
                           {"noisy_picture", json(denoised->noisy)},
                           {"floor_nits", denoised->floor_nits}};
    }
    // The digits that were typed or printed, not those of the float.
    out["exposure_ev"] = nlohmann::ordered_json::parse(fmt::format("{}", picture.exposure_ev));
    out["threads"] = figures.threads;
    out["threads_that_worked"] = figures.workers;
    out["stopped_by"] = nullptr;
    if (run.stopped_by) out["stopped_by"] = run.stopped_by;
    out["phase_s"] = nlohmann::ordered_json::object();
    for (const auto& [name, seconds] : run.phase_s) out["phase_s"][name] = seconds;
    out["load_s"] = figures.load_s;
    out["bvh_build_s"] = figures.bvh_s;
    out["render_wall_s"] = figures.render_wall_s;
    out["render_cpu_s"] = figures.render_cpu_s;
    out["rays"] = {{"camera", s.camera_rays},
                   {"bounce", s.bounce_rays},
                   {"shadow", s.shadow_rays},
                   {"to_targets", s.target_rays},
                   {"all", rays}};
    out["lens_lanes"] = lens_lanes(s.lens_lanes);
    out["path_vertices"] = s.vertices;
    out["paths_ended_in_clear_glass"] = s.specular_ends;
    out["rays_per_cpu_s"] = per_cpu_s(rays);
    out["samples_per_cpu_s"] = per_cpu_s(s.samples);
    out["cpu_time"] = sections(s, figures.render_cpu_s);
    out["bad_samples"] = picture.left_out.not_finite;
    out["too_bright_samples"] = picture.left_out.too_large;
    out["peak_memory_mib"] = figures.peak_memory_mib;
    out["outputs"] = files_of(run.outputs);
    out["notices"] = run.notices;
    out["warnings"] = run.warnings;
    out["errors"] = run.errors;
    // Names of files need not be UTF-8.
    const std::string text =
        out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    io::write_file_atomically(path, {text.begin(), text.end()});
}

}  // namespace petzval::apps
