// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/plan_wording.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "apps/setup/spectral_wording.h"
#include "io/base/format.h"

namespace petzval::apps {
namespace {

// Words for a candidate that was not taken.
std::string off(const PlanCandidate& c) {
    if (c.outside)
        return fmt::format("{} would be off by {}", name_of(c.model), io::percent(c.found()));
    return c.inside
               ? fmt::format("{} would need more samples", name_of(c.model))
               : fmt::format("{} may be off by {}", name_of(c.model), io::percent(c.predicted()));
}

std::string at_most(double predicted) {
    return fmt::format("off by {} at most", io::percent(predicted));
}

std::string dispersion_text(const std::string& lens, double px) {
    return fmt::format("dispersion of {} spreads {:.2g} px", lens, px);
}

// What the mode that was not taken would take.
std::string effort_text(const std::optional<ModeChoice>& found) {
    const auto effort = found ? found->effort_of_next() : std::nullopt;
    if (!effort) return "";
    constexpr double kMost = 100;
    return fmt::format("; to the same noise {} would take {} times as long",
                       name_of(found->by_effort[1].mode),
                       *effort < kMost ? fmt::format("about {:.2g}", *effort) : "over 100");
}

// Text of what depends on wavelength, without the lens where the plan replaces it.
std::string dependence(const Plan& plan) {
    std::vector<WavelengthReason> reasons = plan.requested.spectral.reasons;
    if (replaces_camera(plan.chosen))
        std::erase_if(reasons, [](const WavelengthReason& reason) {
            return reason.kind == WavelengthReason::Kind::Lens;
        });
    return text_of(reasons);
}

PlanLine camera_line(const Plan& plan) {
    const CameraReport& report = plan.requested.camera;
    if (report.orthographic) return {"camera", "orthographic", "the file has it", {}};
    if (!(report.lens_radius_m > 0)) return {"camera", "pinhole", "nothing has an iris", {}};
    if (replaces_camera(plan.chosen))
        return {"camera", name_of(plan.chosen), at_most(plan.bias), plan.bias};
    std::vector<std::string> why;
    for (const PlanCandidate& c : plan.candidates)
        if (replaces_camera(c.model)) why.push_back(off(c));
    return {"camera",
            report.lens.empty() ? "thin" : report.lens,
            why.empty() ? "it was asked for" : fmt::format("{}", fmt::join(why, ", ")),
            {}};
}

PlanLine spectral_line(const Plan& plan) {
    const std::string depends = dependence(plan);
    if (plan.chosen == PlanModel::Rgb)
        return {"spectral", "rgb", fmt::format("{}, though {}", at_most(plan.bias), depends),
                plan.bias};
    if (plan.requested.asked.spectral.mode != SpectralMode::Auto)
        return {"spectral",
                plan.requested.spectral.wavelengths ? "wavelengths" : "rgb",
                "it was asked for",
                {}};
    if (depends.empty()) return {"spectral", "rgb", "nothing depends on wavelength", {}};
    const PlanCandidate* rgb = plan.find(PlanModel::Rgb);
    return {"spectral", "wavelengths", (rgb ? off(*rgb) + ", as " : "") + depends, {}};
}

PlanLine dispersion_line(const Plan& plan) {
    const CameraReport& report = plan.requested.camera;
    const auto& asked = report.asked.dispersion;
    if (replaces_camera(plan.chosen) || report.dispersive_lens.empty())
        return {"dispersion", "shared", "no lens sends wavelengths apart", {}};
    if (!plan.requested.spectral.wavelengths)
        return {"dispersion", "shared", "RGB goes along one ray", {}};
    if (plan.measured_mode)
        return {"dispersion",
                name_of(plan.measured_mode->mode()),
                dispersion_text(report.dispersive_lens, *plan.dispersion_px) +
                    effort_text(plan.measured_mode),
                {}};
    if (!plan.dispersion_open)
        return {"dispersion",
                name_of(report.dispersion()),
                asked ? "it was asked for" : "spectra are asked for",
                {}};
    const PlanCandidate *shared = plan.find(PlanModel::Shared), *hero = plan.find(PlanModel::Hero);
    const std::string because = dispersion_text(report.dispersive_lens, *plan.dispersion_px) + ": ";
    switch (plan.chosen) {
        case PlanModel::Hero:
            return {
                "dispersion",
                "hero",
                because + off(*shared) + ", one ray is weighed for each wavelength without a bias",
                {}};
        case PlanModel::Split:
            return {"dispersion", "split", because + off(*shared) + ", " + off(*hero), {}};
        default:
            return {"dispersion", "shared",
                    because + "one ray for all wavelengths, " + at_most(plan.bias), plan.bias};
    }
}

PlanLine precision_line(const Plan& plan) {
    if (replaces_camera(plan.chosen) || !plan.requested.camera.traced)
        return {"precision", "float", "no lens is traced", {}};
    if (!plan.precision) return {"precision", "double", "it was asked for", {}};
    return {
        "precision",
        name_of(plan.precision->precision),
        fmt::format("rays in floats and in doubles part by {:.1g} px", plan.precision->apart_px),
        {}};
}

std::string lamps_into_lens_text(size_t lamps) {
    return (lamps == 1 ? "a lamp shines" : fmt::format("{} lamps shine", lamps)) + " into the lens";
}

PlanLine ghosts_line(const Plan& plan) {
    const CameraRequest& asked = plan.requested.asked.camera;
    if (!plan.ghosts) return {"ghosts", "off", "no lens is traced", {}};
    if (asked.ghosts == GhostUse::Off) return {"ghosts", "off", "it was asked for", {}};
    const auto [shown, lamps, share] = *plan.ghosts;
    if (!shown)
        return {"ghosts",
                "off",
                lamps == 0 ? "no surface reflects, and no lamp shines into the lens"
                           : "no surface reflects; " + lamps_into_lens_text(lamps) +
                                 ": ⟨coating⟩=year shows ghosts",
                {}};
    std::string why = fmt::format("surfaces reflect, with coating {}", name_of(asked.coating));
    if (share && asked.ghosts == GhostUse::Auto)
        why += fmt::format(", about {} of the picture's light", io::percent(*share));
    if (lamps > 0) why += "; " + lamps_into_lens_text(lamps);
    return {"ghosts", name_of(asked.ghosts), why, {}};
}

PlanLine diffraction_line(const Plan& plan) {
    const bool asked = plan.requested.asked.camera.diffraction == DiffractionUse::Auto;
    std::string why = plan.diffraction.text();
    if (!asked && plan.diffraction.matters()) why += ": ⟨diffraction⟩ auto shows it";
    return {
        "diffraction",
        name_of(asked && plan.diffraction.matters() ? DiffractionUse::Auto : DiffractionUse::Off),
        why,
        {}};
}

PlanLine lights_line(const Plan& plan) {
    if (plan.lights_asked) return {"lights", name_of(plan.scene.lights()), "it was asked for", {}};
    if (!plan.lights)
        return {"lights", name_of(plan.scene.lights()), "there is nothing to choose from", {}};
    const auto kind = plan.lights->kind;
    const auto other =
        kind == LightChoiceKind::Tree ? LightChoiceKind::Power : LightChoiceKind::Tree;
    return {"lights",
            name_of(kind),
            fmt::format("to the same noise {} would take about {:.2g} times as long",
                        name_of(other), plan.lights->effort_of_other),
            {}};
}

std::string text_of(const SmallLamps& small) {
    const auto some = [](size_t count, const char* one, const char* more) {
        return count == 1 ? one : fmt::format(fmt::runtime(more), count);
    };
    std::vector<std::string> out;
    if (small.lamps > 0)
        out.push_back(fmt::format("{} of {:.2g} mm at most",
                                  some(small.lamps, "a lamp", "{} lamps"),
                                  1e3 * small.largest_lamp_m));
    if (small.spots > 0)
        out.push_back(fmt::format("{} of {:.2g}° at most",
                                  some(small.spots, "a spot of the sky", "{} spots of the sky"),
                                  small.largest_spot_rad * 180 / double(kPi)));
    return fmt::format("{}", fmt::join(out, " and "));
}

}  // namespace

std::string text_of(const integrator::NoiseReport& reached, double asked) {
    if (!std::isfinite(reached.noise))
        return fmt::format("noise: not known, as parts of the picture have fewer than {} samples",
                           integrator::kLeastOfCell);
    std::string out = fmt::format(
        "noise: {} in the picture, {} in its worst part, with {:.0f} samples a pixel",
        io::percent(reached.noise), io::percent(reached.worst_cell), reached.mean_samples);
    if (reached.left == 0) return out;
    out += fmt::format("; {} of {} parts are above {}", reached.left, reached.cells,
                       io::percent(asked));
    if (reached.at_least > 0)
        out += fmt::format(", at least: in {} of them the noise hangs on a few paths",
                           reached.at_least);
    else if (reached.samples_for_all > 0)
        out += fmt::format("; ⟨spp⟩ {:.0f} would do", std::ceil(reached.samples_for_all));
    return out;
}

std::optional<std::string> warning_of(const SmallLamps& small) {
    if (small.count() == 0) return std::nullopt;
    std::string out = fmt::format(
        "warning: fewer than {} paths meet {}: {} light is missing, or in single bright pixels",
        kEnoughPaths, text_of(small), small.count() == 1 ? "its" : "their");
    if (small.samples <= double(kMostSamples))
        out += fmt::format("; ⟨spp⟩ {} would do", static_cast<uint32_t>(small.samples));
    return out;
}

std::string rare_text(const Plan& plan) {
    if (!plan.noise_at_least) return "";
    const RareLight& rare = plan.rare;
    if (rare.noise > 0)
        return fmt::format("{}: few paths find {}", text_of(rare.seldom),
                           rare.seldom.count() == 1 ? "it" : "them");
    if (rare.behind_glass > 0) return "lamps behind solid glass: no path finds them, or hardly one";
    if (rare.caustic) return "surfaces lit by lamps through glass or mirrors: few paths find them";
    if (rare.mirrored) return "lamps seen through glass or mirrors: few paths find them";
    return "few paths hold most of the noise";
}

std::optional<double> times_without_targets(const Plan& plan) {
    constexpr double kDecisive = 4;
    const double first = plan.first_noise * plan.first_noise;
    if (!(plan.rare.spared > (kDecisive - 1) * first)) return std::nullopt;
    return 1 + plan.rare.spared / first;
}

std::vector<PlanLine> lines_of(const Plan& plan) {
    return {camera_line(plan), spectral_line(plan),    dispersion_line(plan), precision_line(plan),
            ghosts_line(plan), diffraction_line(plan), lights_line(plan)};
}

RenderRequest carried_out(const Plan& plan, RenderRequest request) {
    request.samples.count = static_cast<uint32_t>(plan.samples);
    SceneRequest& scene = request.scene;
    if (plan.lights && plan.lights->kind != LightChoiceKind::Tree)
        scene.light_choice = plan.lights->kind;
    CameraRequest& camera = scene.camera;
    const CameraRequest& planned = plan.scene.camera;
    if (replaces_camera(plan.chosen)) {
        const CameraRequest nothing;
        camera.fit = nothing.fit;
        camera.fstop = nothing.fstop;
        camera.focal_length_mm = nothing.focal_length_mm;
        camera.film_distance_mm = nothing.film_distance_mm;
        camera.coating = nothing.coating;
        camera.ghosts = nothing.ghosts;
        camera.precision = nothing.precision;
        camera.focus_by = nothing.focus_by;
        camera.glasses = nothing.glasses;
        camera.dispersion = nothing.dispersion;
        camera.lens = name_of(plan.chosen);
        camera.fov_deg = planned.fov_deg;
        camera.sensor_mm = planned.sensor_mm;
        if (plan.chosen == PlanModel::Pinhole) {
            camera.focus = nothing.focus;
            camera.aperture = nothing.aperture;
            camera.aperture_scale = nothing.aperture_scale;
            camera.iris_sampling = nothing.iris_sampling;
            camera.lens_radius_m = nothing.lens_radius_m;
        } else {
            camera.lens_radius_m = planned.lens_radius_m;
            camera.focus = planned.focus;
        }
        return request;
    }
    if (plan.precision && plan.precision->precision == camera::Precision::Double)
        camera.precision = plan.precision->precision;
    if (plan.anything_open)
        scene.spectral.mode =
            plan.chosen == PlanModel::Rgb ? SpectralMode::Rgb : SpectralMode::Wavelengths;
    if (plan.dispersion_open) camera.dispersion = planned.dispersion;
    if (plan.measured_mode) camera.dispersion = plan.measured_mode->mode();
    return request;
}

std::string reason_of(const AutoChoice& choice) {
    std::string why;
    if (choice.dispersion) why = dispersion_text(choice.dispersive_lens, choice.dispersion_px);
    if (choice.candidates.empty()) return why + effort_text(choice.measured_mode);
    const auto refused = [&] {
        // Shared rays are the last but the fullest model where they were compared at all.
        const size_t last_simpler = choice.candidates.size() - 2;
        return off(choice.candidates[choice.dispersion_compared ? last_simpler : 0]);
    };
    std::string found =
        choice.taken ? at_most(choice.candidates[*choice.taken].predicted()) : refused();
    if (choice.taken && choice.dispersion_compared) found = "one ray for all wavelengths, " + found;
    return (why.empty() ? found : why + ": " + found) + effort_text(choice.measured_mode);
}

std::optional<std::string> line_of(const AutoChoice& choice) {
    if (!choice.dispersion) return std::nullopt;
    return fmt::format("dispersion: {}, as {}", name_of(*choice.dispersion), reason_of(choice));
}

}  // namespace petzval::apps
