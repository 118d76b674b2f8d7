// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/trace_sample.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <memory>

#include "apps/cli/field_options.h"
#include "apps/render/render_session.h"
#include "apps/request/parse.h"
#include "apps/request/value_error.h"
#include "integrator/path/path_steps.h"

namespace petzval::apps {
namespace {

/// By PathStep.
constexpr std::array<const char*, static_cast<size_t>(integrator::PathStep::NotFinite) + 1> kSteps{
    "path {path}, {kind}: from {place} m towards {direction}; weight on the film {lanes}",
    "  passes a hole in {surface}, {number} m on",
    "  passes {surface}, {number} m on: cameras do not see it",
    "  meets {surface}, {number} m on{medium}, at {place} m; throughput {lanes}",
    "    goes on: a volume of higher priority fills both sides",
    "    finds light: it sends + {lanes}",
    "    samples light {light}",
    "    shadow ray to it, {goal}: a share of {number} comes through",
    "    it is stopped after {number} m by the {surface}",
    "    scatters sampled light: + {lanes}",
    "    goes on, {lobe}, weight {lanes}",
    "    roulette: goes on with a chance of {number}",
    "  ends: leaves the scene towards {direction}",
    "    finds light behind it: + {lanes}",
    "  ends: the surface is unlit, and scatters nothing",
    "  ends: scattered as often as ⟨max-depth⟩ says",
    "  ends: as much clear glass as ⟨max-clear-depth⟩ says",
    "  ends: absorbed where it would have gone",
    "  ends: what a wide lobe scatters is left to rays that were not sent to targets",
    "  ends: the direction that was drawn is no number"};

SampleId sample_of(const std::string& text, V2i frame) {
    const auto v = parse_numbers("sample", text, 3);
    const auto fits = [](float a, float end) { return a >= 0 && a < end && a == std::floor(a); };
    constexpr float most = 1 << 24;  // all whole numbers below it are floats
    if (fits(v[0], frame.x) && fits(v[1], frame.y) && fits(v[2], most))
        return {int(v[0]), int(v[1]), uint32_t(v[2])};
    throw ValueError("sample", fmt::format("\"{}\" is not x,y,index: a pixel of the {}x{} frame "
                                           "and the number of a sample, from 0 to {}",
                                           text, frame.x, frame.y, most - 1));
}

std::string place(const V3f& p) {
    return fmt::format("{:.5g},{:.5g},{:.5g}", p.x, p.y, p.z);
}

/// Where a shadow ray goes, whose direction is as long as the way to a lamp.
std::string goal(const Ray& ray) {
    if (ray.t_max > 1) return "towards " + place(ray.direction);
    return fmt::format("at {} m, {:.5g} m away", place(ray.origin + ray.direction),
                       ray.direction.length());
}

std::string name(const Scene& scene, uint32_t instance, uint32_t triangle) {
    const uint32_t mesh = scene.instances[instance].mesh;
    return fmt::format("material \"{}\" (mesh {}, instance {}, triangle {})",
                       scene.materials[scene.meshes[mesh].material].name, mesh, instance, triangle);
}

std::string name_of_light(const Scene& scene, uint32_t light) {
    constexpr std::array<const char*, std::variant_size_v<Light>> kinds{
        "point", "spot", "directional", "", "sky", "IES profile"};
    if (const auto* lamp = std::get_if<TriangleLight>(&scene.lights[light]))
        return fmt::format("{}: {}", light, name(scene, lamp->instance, lamp->triangle));
    return fmt::format("{}: {}", light, kinds[scene.lights[light].index()]);
}

std::string lobe(const BsdfSample& drawn, bool straight) {
    const char* const way = straight            ? "straight through"
                            : drawn.transmitted ? "refracted or let through"
                                                : "reflected";
    if (drawn.delta) return fmt::format("{} (smooth)", way);
    return fmt::format("{} ({}, {:.4g} /sr)", way,
                       drawn.pdf < integrator::kNarrowPdf ? "diffuse or wide lobe" : "narrow lobe",
                       drawn.pdf);
}

void print_sample(const integrator::SampleRecord& sample, const Scene& scene, SampleId id) {
    const Bands& bands = sample.bands;
    const auto lanes = [&](f4 v) {
        std::string out;
        for (int i = 0; i < 4; ++i)
            if (bands.on[i]) out += fmt::format("{}{:.4g}", i ? ", " : "", v[i]);
        return out;
    };
    print_line(fmt::format("sample {} of pixel {},{}: film point {:.6g},{:.6g} px", id.index, id.x,
                           id.y, sample.point_px.x, sample.point_px.y));
    print_line(bands.spectral
                   ? fmt::format("lanes: {} nm; radiance in W/(m² sr nm)", lanes(bands.nm))
                   : "lanes: R, G, B; radiance in nits");
    if (const auto& lens = sample.lens; lens.lost() > 0)
        print_line(
            fmt::format("lens: {} of {} rays are lost: {} at rims or the iris, {} by total "
                        "reflection, {} miss a surface, {} do not reach their iris point",
                        lens.lost(), lens.drawn, lens.vignetted, lens.totally_reflected,
                        lens.missed, lens.unreached));
    size_t path = 0;
    for (size_t i = 0; i < sample.events.size(); ++i) {
        const integrator::PathEvent& event = sample.events[i];
        const auto& s = event.surface;
        path += event.step == integrator::PathStep::Begins;
        using namespace fmt::literals;
        print_line(fmt::format(
            fmt::runtime(kSteps[static_cast<size_t>(event.step)]), "path"_a = path,
            "kind"_a = path == 0                         ? "camera ray"
                       : sample.rays[path - 1].of_ghost  ? "of a ghost"
                       : sample.rays[path - 1].to_target ? "to a target"
                                                         : "camera ray",
            "place"_a = place(s ? s->p : event.ray.origin),
            "direction"_a = place(event.ray.direction),
            "lanes"_a = lanes(event.step == integrator::PathStep::GoesOn ? event.drawn.weight
                                                                         : event.lanes),
            "surface"_a = s ? (s->front ? "front of " : "back of ") +
                                  name(scene, s->hit.instance, s->hit.triangle)
                            : "",
            "medium"_a = event.medium ? " in \"" + event.medium->name + "\"" : "",
            "light"_a = event.step == integrator::PathStep::DrawsLight
                            ? name_of_light(scene, event.light)
                            : "",
            "goal"_a = goal(event.ray), "number"_a = fmt::format("{:.5g}", event.number),
            "lobe"_a = lobe(event.drawn, event.straight)));
        const bool is_last = i + 1 == sample.events.size() ||
                             sample.events[i + 1].step == integrator::PathStep::Begins;
        if (is_last && event.step < integrator::PathStep::LeavesScene)
            print_line(event.step == integrator::PathStep::Roulette
                           ? "  ends: by roulette"
                           : "  ends: nothing is left of it");
    }
    const V4f& film = sample.film;
    print_line(sample.left_out ? "the film leaves the sample out: it is not finite, or too large"
                               : fmt::format("the film gets R,G,B {},{},{} nits, alpha {}", film.x,
                                             film.y, film.z, film.w));
}

}  // namespace

void add_trace_sample_command(CLI::App& app, Session& session) {
    auto order = std::make_shared<RenderOrder>();
    auto text = std::make_shared<std::string>();
    CLI::App* command = app.add_subcommand("trace-sample", "print the path of a sample of a pixel");
    add_field_options(*command, *order, kTrace);
    command->add_option("sample", *text, "x,y,index of a pixel and one of its samples, from 0")
        ->required();
    command->callback([order, text, &session] {
        const SampleId id = sample_of(*text, order->render.scene.size);
        RenderSession render(threads_of(order->run));
        render.prepare(order->render, [&](const std::string& n) { session.console.notice(n); });
        print_sample(render.trace_sample(id), *render.setup().prepared.scene, id);
    });
}

}  // namespace petzval::apps
