// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/exposure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/setup/tracer.h"
#include "core/sampling/prepass_seed.h"
#include "integrator/path/path.h"
#include "integrator/prepass/pilot_batch.h"
#include "integrator/prepass/pilot_pixels.h"

namespace petzval::apps {
namespace {

constexpr double kMidGrey = 0.18;
/// Shares of the pixels: what is brighter may be brighter than white, or is left out of what is
/// nearly the brightest.
constexpr double kMayClip = 0.1, kBrightest = 0.05;
constexpr double kDarkest = 0.01;  ///< of the nearly brightest
constexpr double kMostEv = 100;    ///< as far as --exposure goes

constexpr std::array<integrator::PilotTurn, 4> kTurns{
    {{2048, 32}, {16384, 4}, {131072, 1}, {1 << 20, 1}}};

/// Luminance below which a pixel is as good as black on a display: level 25 of 255 in sRGB.
constexpr double kBlack = 0.01;
/// Shares of the pixels with light from which a picture is mostly black, almost black, almost
/// white.
constexpr double kMostlyDark = 0.5, kLeastDark = 0.9, kLeastWhite = 0.9;
/// Exposures that differ by less look alike. A picture that is black in most places may be meant
/// so: it would have to be much brighter.
constexpr double kAlike_ev = 1, kMuchBrighter_ev = 3;

/// Luminance of a pixel as a picture shows it: what is partly transparent is not darker for it.
double shown_luminance(const V4f& c) {
    const double light = double(luminance({c.x, c.y, c.z}));
    return c.w > 0 ? light / double(c.w) : light;
}

/// What a turn of the pilot saw: luminances above 0.
struct Seen {
    std::vector<double> scene, all;
    /// Those of pixels that show something of the scene, or of all where hardly any do.
    [[nodiscard]] const std::vector<double>& of_interest() const {
        return scene.size() >= integrator::kEnoughLitPixels ||
                       all.size() < integrator::kEnoughLitPixels
                   ? scene
                   : all;
    }
};

Seen look(const RenderSetup& setup, const integrator::RenderJob& job,
          const integrator::PathTracer<>& tracer, const integrator::PilotTurn& turn,
          integrator::TbbExecutor& executor) {
    const V2i size = setup.from.asked.size;
    const integrator::PilotBatch batch{
        size,       integrator::pilot_pixels(size, turn.pixels, job.seed),
        0,          turn.samples,
        {job.seed}, {Aov::Depth}};
    struct Pixel {
        double luminance;
        bool scene;
    };
    std::vector<Pixel> found(batch.pixels.size());
    render_pilot(tracer, *setup.view.camera, job, batch, executor,
                 [&](const integrator::PilotFilm& film) {
                     found[film.pixel] = {shown_luminance(film.colour), film.layer.x > 0};
                 });
    Seen seen;
    for (const Pixel& pixel : found) {
        if (!(pixel.luminance > 0)) continue;
        seen.all.push_back(pixel.luminance);
        if (pixel.scene) seen.scene.push_back(pixel.luminance);
    }
    return seen;
}

/// Value that a share of sorted values is above.
double above(const std::vector<double>& sorted, double share) {
    const auto last = static_cast<double>(sorted.size() - 1);
    return sorted[static_cast<size_t>(std::floor(last * (1 - share)))];
}

}  // namespace

FoundExposure exposure_for(std::vector<double> luminances) {
    if (luminances.empty()) return {};
    std::sort(luminances.begin(), luminances.end());
    const double least = kDarkest * above(luminances, kBrightest);
    double logs = 0;
    for (const double l : luminances) logs += std::log(std::max(l, least));
    const double average = std::exp(logs / static_cast<double>(luminances.size()));
    const double gain = std::min(kMidGrey / average, 1 / above(luminances, kMayClip));
    const double tenths = std::round(10 * std::clamp(std::log2(gain), -kMostEv, kMostEv));
    return {static_cast<float>((tenths + 0.0) / 10), average};
}

FoundExposure find_exposure(const RenderSetup& setup, const integrator::RenderJob& job,
                            const integrator::PathOptions& options,
                            integrator::TbbExecutor& executor) {
    const integrator::PathTracer<> tracer = tracer_of(setup, options);
    integrator::RenderJob pilot;
    pilot.sampler = job.sampler;
    pilot.filter = job.filter;
    pilot.observer = setup.view.observer;
    pilot.seed = hash32(job.seed, number_of(PrepassSeed::Exposure));
    Seen seen;
    for (const integrator::PilotTurn& turn : kTurns) {
        seen = look(setup, pilot, tracer, turn, executor);
        if (seen.of_interest().size() >= integrator::kEnoughLitPixels) break;
    }
    return exposure_for(seen.of_interest());
}

Brightness brightness_of(const Film& film, float exposure_ev) {
    const double gain = std::exp2(double(exposure_ev));
    const Rect crop = film.crop();
    uint64_t lit = 0, dark = 0, white = 0;
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            const double light = gain * shown_luminance(film.colour(x, y));
            lit += light > 0;
            dark += light > 0 && light < kBlack;
            white += light > 1;
        }
    if (lit == 0) return Brightness::Black;
    const auto share = [lit](uint64_t n) {
        return static_cast<double>(n) / static_cast<double>(lit);
    };
    if (share(dark) >= kLeastDark) return Brightness::AlmostBlack;
    if (share(dark) >= kMostlyDark) return Brightness::MostlyBlack;
    return share(white) >= kLeastWhite ? Brightness::AlmostWhite : Brightness::Normal;
}

std::optional<std::string> exposure_advice(Brightness brightness, const FoundExposure& found,
                                           float exposure_ev, const std::string& white_cause) {
    if (brightness == Brightness::Normal) return std::nullopt;
    if (!(found.log_average > 0))
        return "the picture is black, and no ⟨exposure⟩ can help: no light was found (petzval info "
               "tells whether the file has lights)";
    const bool mostly = brightness == Brightness::MostlyBlack;
    const float change_ev = found.ev - exposure_ev;
    if (mostly ? change_ev < kMuchBrighter_ev : std::fabs(change_ev) < kAlike_ev)
        return std::nullopt;
    const double above_ev = std::log2(found.log_average / kMidGrey) + double(exposure_ev);
    const bool white = brightness == Brightness::AlmostWhite;
    return fmt::format(
        "the picture is {} {}: its log-average is {:.1f} EV {} mid-grey; try ⟨exposure⟩ {} or "
        "⟨exposure⟩ auto{}",
        mostly ? "mostly" : "almost", white ? "white" : "black", std::fabs(above_ev),
        above_ev < 0 ? "below" : "above", found.ev,
        white && !white_cause.empty() ? ". " + white_cause : "");
}

}  // namespace petzval::apps
