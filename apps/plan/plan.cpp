// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "apps/plan/dispersion_spread.h"
#include "apps/plan/plan_comparison.h"
#include "apps/setup/equivalent_camera.h"
#include "apps/setup/option_names.h"
#include "apps/setup/stats_file.h"
#include "io/base/error.h"
#include "io/base/format.h"

namespace petzval {
namespace {

using Notice = std::function<void(const std::string&)>;
using Candidates = std::vector<PlanCandidate>;

constexpr int kPixels = 1024, kFewPixels = 256;
// Of each look. Many samples of few pixels are better than few of many: what wavelengths and edges
// do in a pixel evens out faster than in proportion.
constexpr double kLeastSamples = 4, kEnoughSamples = 16;

constexpr double kMostPlannedSamples = 1 << 30;
// Costs are known no better, and the simpler one is taken.
constexpr double kAsCheap = 1.05;

const PlanCandidate* find(const Candidates& all, const std::string& name) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const PlanCandidate& c) { return c.name == name; });
    return found == all.end() ? nullptr : &*found;
}

// How a candidate is spoken of that was not taken.
std::string off(const PlanCandidate& c) {
    if (c.outside)
        return fmt::format("{} would be off by {}", c.name, percent(std::sqrt(c.square_bias.mean)));
    return c.inside ? fmt::format("{} would need more samples", c.name)
                    : fmt::format("{} may be off by {}", c.name, percent(c.predicted()));
}

std::string at_most(const PlanCandidate& c) {
    return fmt::format("off by {} at most", percent(c.predicted()));
}

bool is_camera(const std::string& name) {
    return name == "pinhole" || name == "thin";
}

size_t cheapest(const Candidates& all, double tolerance) {
    const auto cost = [&](const PlanCandidate& c) { return c.samples_for(tolerance) * c.rays; };
    double least = cost(all.back());
    for (const PlanCandidate& c : all)
        if (c.inside) least = std::min(least, cost(c));
    size_t best = 0;
    while (!all[best].inside || cost(all[best]) > kAsCheap * least) ++best;
    return best;
}

/// What a plan tells of.
struct Look {
    const PlanRequest& request;
    const Session& session;
    const PlanOpen& open;
    const Candidates& all;
    const PlanCandidate& chosen;
    double spread_px;

    /// On wavelength, but for the lens where it is not the camera any more.
    [[nodiscard]] std::string depends() const {
        std::vector<std::string> found = session.depends;
        if (is_camera(chosen.name))
            std::erase(found, fmt::format("lens {} disperses", session.dispersive_lens));
        return fmt::format("{}", fmt::join(found, "; "));
    }
    [[nodiscard]] std::string spreads() const {
        return fmt::format("dispersion of {} spreads {:.2g} px", session.dispersive_lens,
                           spread_px);
    }
    [[nodiscard]] bool chose(const char* name) const { return chosen.name == name; }
};

PlanLine camera_line(const Look& at) {
    const CameraReport& report = at.session.camera_report;
    if (report.orthographic) return {"camera", "orthographic", "the file has it", {}};
    if (!(report.lens_radius_m > 0)) return {"camera", "pinhole", "nothing has an iris", {}};
    if (is_camera(at.chosen.name))
        return {"camera", at.chosen.name, at_most(at.chosen), at.chosen.predicted()};
    std::vector<std::string> why;
    for (const PlanCandidate& c : at.all)
        if (is_camera(c.name)) why.push_back(off(c));
    return {"camera",
            report.lens.empty() ? "thin" : report.lens,
            why.empty() ? "it was asked for" : fmt::format("{}", fmt::join(why, ", ")),
            {}};
}

PlanLine spectral_line(const Look& at) {
    if (at.chose("rgb"))
        return {"spectral", "rgb", fmt::format("{}, though {}", at_most(at.chosen), at.depends()),
                at.chosen.predicted()};
    if (at.request.scene.spectral.mode != SpectralMode::Auto)
        return {
            "spectral", at.session.observer.spectral() ? "hero" : "rgb", "it was asked for", {}};
    if (at.depends().empty()) return {"spectral", "rgb", "nothing depends on wavelength", {}};
    const PlanCandidate* rgb = find(at.all, "rgb");
    return {"spectral", "hero", (rgb ? off(*rgb) + ", as " : "") + at.depends(), {}};
}

PlanLine dispersion_line(const Look& at) {
    const auto& asked = at.session.camera_report.asked.dispersion;
    if (is_camera(at.chosen.name) || at.session.dispersive_lens.empty())
        return {"dispersion", "shared", "no lens parts wavelengths", {}};
    if (!at.session.observer.spectral())
        return {"dispersion", "shared", "RGB goes along one ray", {}};
    if (!at.open.dispersion)
        return {"dispersion",
                word_of(asked.value_or(DispersionMode::Tolerance)),
                asked ? "it was asked for" : "spectra are asked for",
                {}};
    const PlanCandidate *shared = find(at.all, "shared"), *tolerance = find(at.all, "tolerance");
    const std::string because = at.spreads() + ": ";
    if (at.chose("hero"))
        return {"dispersion",
                "hero",
                because + off(*shared) + ", one ray is weighed for each wavelength without a bias",
                {}};
    if (at.chose("split"))
        return {"dispersion", "split", because + off(*shared) + ", " + off(*tolerance), {}};
    if (!at.chose("shared") && !at.chose("rgb"))
        return {"dispersion", at.chosen.name,
                fmt::format("{}{}, this {}", because, off(*shared), at_most(at.chosen)),
                at.chosen.predicted()};
    return {"dispersion", "shared", because + "one ray for all wavelengths, " + at_most(at.chosen),
            at.chosen.predicted()};
}

std::vector<PlanOption> options_of(const Look& at, uint64_t samples) {
    std::vector<PlanOption> out{{"--spp", std::to_string(samples)}};
    const CameraRequest& camera = at.chosen.scene.camera;
    const auto set = [&](const char* name, const auto& value) {
        out.emplace_back(name, fmt::format("{}", value));
    };
    const auto leave_out = [&](std::initializer_list<const char*> names) {
        for (const char* name : names) out.emplace_back(name, std::nullopt);
    };
    if (is_camera(at.chosen.name)) {
        leave_out({"--fit", "--fstop", "--focal-length", "--film-distance", "--coating",
                   "--lens-precision", "--focus-by", "--glasses", "--dispersion",
                   "--dispersion-tolerance"});
        set("--lens", at.chosen.name);
        set("--fov", *camera.fov_deg);
        set("--sensor", fmt::format("{}x{}", camera.sensor_mm->x, camera.sensor_mm->y));
        if (at.chose("pinhole")) {
            leave_out(
                {"--focus", "--aperture", "--aperture-scale", "--iris-sampling", "--lens-radius"});
        } else {
            set("--lens-radius", *camera.lens_radius_m);
            set("--focus", std::get<FocusDistance>(*camera.focus).m);
        }
        return out;
    }
    if (at.open.any()) set("--spectral", at.chose("rgb") ? "rgb" : "hero");
    if (at.open.dispersion) set("--dispersion", word_of(*camera.dispersion));
    return out;
}

// Opens the request; what is said of it is kept.
Session open_first(const PlanRequest& request, TbbExecutor& executor,
                   std::vector<std::string>& said) {
    return executor.inside([&] {
        return open_session(request.scene, [&](const std::string& text) { said.push_back(text); });
    });
}

// In place of the first.
Session reopened(const SceneRequest& scene, const Session& first, TbbExecutor& executor) {
    Session session = executor.inside([&] {
        return open_session(
            scene, [](const std::string&) {}, &first);
    });
    session.load_s += first.load_s;
    session.bvh_s += first.bvh_s;
    return session;
}

// What becomes of wavelengths that a lens parts where nothing is left out: as wide as they are.
struct Parted {
    double spread_px;
    SceneRequest scene;
    [[nodiscard]] bool hero() const { return scene.camera.dispersion == DispersionMode::Hero; }
};
Parted part_wavelengths(const Session& first, TbbExecutor& executor) {
    SceneRequest scene = resolved_request(first);
    scene.spectral.mode = SpectralMode::Wavelengths;
    if (first.asked.spectral.mode == SpectralMode::Auto)
        scene.spectral.because = fmt::format("{}", fmt::join(first.depends, "; "));
    const auto with = [&](DispersionMode dispersion) {
        scene.camera.dispersion = dispersion;
        return reopened(scene, first, executor);
    };
    const Session split = with(DispersionMode::Split), shared = with(DispersionMode::Shared);
    const double spread = spread_px(split, shared, scene.size);
    scene.camera.dispersion =
        spread <= kMostHeroSpread_px ? DispersionMode::Hero : DispersionMode::Tolerance;
    return {spread, scene};
}

// Spectra through a lens: nothing is left out of them, and so dispersion is a matter of the spread.
Plan plan_with_bins(const PlanRequest& request, const Session& first, TbbExecutor& executor,
                    const Notice& notice, double most_samples) {
    const Parted parted = part_wavelengths(first, executor);
    PlanRequest settled = request;
    settled.scene.camera.dispersion = parted.scene.camera.dispersion;
    Plan plan = make_plan(settled, executor, notice, most_samples);
    for (PlanLine& line : plan.lines)
        if (line.choice == "dispersion" && !is_camera(plan.chosen)) {
            line.reason = fmt::format("dispersion of {} spreads {:.2g} px", first.dispersive_lens,
                                      parted.spread_px);
            plan.options.emplace_back("--dispersion", line.chosen);
        }
    return plan;
}

}  // namespace

double PlanCandidate::variance_with(double samples) const {
    size_t turn = 0;
    while (turn + 1 < variances.size() && samples >= std::exp2(turn + 1)) ++turn;
    return variances[turn].high() * std::exp2(turn) / samples;
}

double PlanCandidate::samples_for(double tolerance) const {
    const double left = tolerance * tolerance - square_bias.high();
    for (size_t turn = 0;; ++turn) {
        const double samples = std::exp2(turn) * std::max(1., variances[turn].high() / left);
        if (turn + 1 == variances.size() || samples <= std::exp2(turn + 1)) return samples;
    }
}

Plan make_plan(const PlanRequest& request, TbbExecutor& executor, const Notice& notice,
               double most_samples) {
    std::vector<std::string> said;
    const Session first = open_first(request, executor, said);
    if (const PlanOpen open(request.scene, first); open.parted && !open.dispersion)
        return plan_with_bins(request, first, executor, notice, most_samples);
    for (const std::string& text : said)
        if (text != first.spectral_decision) notice(text);
    const PlanOpen open(request.scene, first);
    PlanComparison compared(request, first, open, kPixels, executor);
    compared.add_simpler_cameras();
    if (open.spectral) compared.add_rgb();
    if (open.dispersion) {
        compared.add_shared();
        compared.add_unbiased("hero", DispersionMode::Hero);
        compared.add_parted("tolerance", DispersionMode::Tolerance);
    }
    compared.look(most_samples, true);

    Plan plan;
    plan.candidates = compared.candidates();
    const size_t best = cheapest(plan.candidates, request.tolerance);
    const PlanCandidate& chosen = plan.candidates[best];
    plan.scene = chosen.scene;
    plan.chosen = chosen.name;
    plan.bias = chosen.predicted();
    const double samples = std::ceil(chosen.samples_for(request.tolerance));
    if (!(samples <= kMostPlannedSamples))
        throw ArgumentError(
            "--tolerance", "",
            fmt::format("would take {:.2g} samples of each pixel; give a larger one", samples));
    plan.samples = static_cast<uint64_t>(samples);
    // Their standard errors come from as many replicates, each with the same share of the samples.
    if (request.scene.spectral.bins)
        plan.samples = (plan.samples + kReplicates - 1) / kReplicates * kReplicates;
    plan.noise = std::sqrt(chosen.variance_with(static_cast<double>(plan.samples)));
    plan.first_noise = std::sqrt(chosen.variance_with(1));
    plan.cpu_s = compared.cpu_s_per_sample(best) * static_cast<double>(plan.samples) *
                 request.scene.size.x * request.scene.size.y;
    const Look at{request, first, open, plan.candidates, chosen, compared.spread()};
    plan.lines = {camera_line(at), spectral_line(at), dispersion_line(at)};
    plan.options = options_of(at, plan.samples);
    return plan;
}

Session open_planned(const PlanRequest& request, TbbExecutor& executor, const Notice& notice) {
    std::vector<std::string> said;
    Session first = open_first(request, executor, said);
    const std::string decision = first.spectral_decision;
    const PlanOpen open(request.scene, first);
    std::string why, dispersion;
    std::optional<SceneRequest> other;  // than what was opened
    if (open.parted) {
        const Parted parted = part_wavelengths(first, executor);
        if (parted.hero()) other = parted.scene;
        why = fmt::format("dispersion of {} spreads {:.2g} px", first.dispersive_lens,
                          parted.spread_px);
        dispersion = word_of(*parted.scene.camera.dispersion);
    }
    const double most_samples = 0.25 * request.scene.size.x * request.scene.size.y;
    const int models = (open.spectral ? 1 : 0) + (open.dispersion ? 2 : 1);
    const auto fit = [&](int pixels, double samples) {
        return pixels * kPilotReplicates * samples * models <= most_samples;
    };
    if (open.any() && fit(kFewPixels, kLeastSamples)) {
        PlanComparison compared(request, first, open,
                                fit(kPixels, kEnoughSamples) ? kPixels : kFewPixels, executor);
        if (open.spectral) compared.add_rgb();
        if (open.dispersion) compared.add_shared();
        compared.look(most_samples, false);
        const Candidates all = compared.candidates();
        const auto& chosen =
            *std::find_if(all.begin(), all.end(), [](const auto& c) { return c.inside; });
        const Look at{request, first, open, all, chosen, compared.spread()};
        // What the look does not clear stays as it is.
        const bool simpler = &chosen != &all.back();
        std::string found = simpler ? at_most(chosen) : off(all.front());
        if (simpler) {
            other = chosen.scene;
            if (request.scene.spectral.mode == SpectralMode::Auto)
                other->spectral.because =
                    at.chose("rgb") ? fmt::format("it is {}, though {}", found, at.depends())
                                    : at.depends();
        }
        if (open.dispersion) {
            found = simpler ? "one ray for all wavelengths, " + found : off(*find(all, "shared"));
            if (simpler) dispersion = "shared";
        }
        why = why.empty() ? found : why + ": " + found;
    }
    Session session = other ? reopened(*other, first, executor) : std::move(first);
    for (const std::string& text : said)
        notice(text == decision ? session.spectral_decision : text);
    if (!dispersion.empty()) notice(fmt::format("dispersion: {}, as {}", dispersion, why));
    if (!why.empty())
        session.metadata.emplace_back("petzval:plan",
                                      fmt::format("{}: {}", percent(request.tolerance), why));
    return session;
}

}  // namespace petzval
