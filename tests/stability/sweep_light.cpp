// SPDX-License-Identifier: Apache-2.0
// Light that is hard to find: tiny suns and lamps, and highlights out of focus.
#include <fmt/format.h>

#include <numbers>

#include "camera/models/thin_lens.h"
#include "tests/stability/sweeps.h"
#include "tests/stability/world.h"

namespace petzval::stability {
namespace {

constexpr uint32_t kLightSamples = 1u << 16;
/// Samples for 1 % of error are 1e4 times the relative variance.
constexpr double kMost = 1e4;

Ray straight_down(const Sampler& sampler) {
    const V2f u = sampler.get2(Dim::Film);
    Ray ray;
    ray.origin = {0.01f * (u.x - 0.5f), 1.f, 0.01f * (u.y - 0.5f)};
    ray.direction = {0, -1, 0};
    return ray;
}

void place_floor(World& world) {
    world.place(quad(V3f(-50, 0, 50), V3f(100, 0, 0), V3f(0, 0, -100)), diffuse(0.5f));
}

Measured lit(const World& world, integrator::Technique technique, int max_depth = 1) {
    integrator::PathOptions options;
    options.max_depth = max_depth;
    options.technique = technique;
    return measure(world, options, kLightSamples, straight_down);
}

std::string variance_of(const Measured& m) {
    if (!(m.found > 0)) return fmt::format("none of {} found it", kLightSamples);
    return m.relative_variance < 1e-9 ? "below 1e-9" : number(m.relative_variance);
}

// A floor under a black sky with one texel of a sun that gives 100.
World under_sun(int width) {
    World world;
    place_floor(world);
    const int height = width / 2, x = width / 3, y = height / 5;
    std::vector<float> rgb(3 * static_cast<size_t>(width) * height);
    const double solid_angle =
        2 * std::numbers::pi / width *
        (std::cos(std::numbers::pi * y / height) - std::cos(std::numbers::pi * (y + 1) / height));
    for (int i = 0; i < 3; ++i)
        rgb[3 * (static_cast<size_t>(y) * width + x) + size_t(i)] =
            static_cast<float>(100 / solid_angle);
    world.scene.sky = Sky::picture(rgb, width, height, 0, 1);
    world.finish();
    return world;
}

// A floor under a square lamp of that side 10 m up, with or without a pane of glass between.
World under_lamp(double side_m, bool pane) {
    World world;
    place_floor(world);
    const auto a = static_cast<float>(side_m);
    world.place(quad(V3f(-a / 2, 10, -a / 2), V3f(a, 0, 0), V3f(0, 0, a)), glowing(1 / (a * a)));
    if (pane) {
        const Material glass = clear_glass(1.5f);
        world.place(quad(V3f(-50, 5, -50), V3f(100, 0, 0), V3f(0, 0, 100)), glass);
        world.place(quad(V3f(-50, 5.1f, 50), V3f(100, 0, 0), V3f(0, 0, -100)), glass);
    }
    world.finish();
    return world;
}

}  // namespace

Finding tiny_sun() {
    Finding f{.method = "A sun of one texel", .fails = "variance"};
    f.sweep = fmt::format(
        "A matt floor under a black sky whose one bright texel is the sun, always of the same "
        "illuminance, by the width of the picture: variance of one sample over the mean squared, "
        "from {} independent samples, by light samples, by samples of the surface, and by both.",
        kLightSamples);
    f.table.columns = {"sky's width (texels)", "both (as rendered)", "light samples only",
                       "surface samples only"};
    double worst_both = 0;
    std::optional<double> blind;
    for (const int width : {16, 64, 256, 512, 1024}) {
        const World world = under_sun(width);
        const Measured both = lit(world, integrator::Technique::Mis);
        const Measured surface = lit(world, integrator::Technique::BsdfOnly);
        add_row(f, std::to_string(width), variance_of(both),
                variance_of(lit(world, integrator::Technique::LightOnly)), variance_of(surface));
        worst_both = std::fmax(worst_both, both.relative_variance);
        if (!blind && surface.relative_variance > kMost) blind = width;
    }
    f.where = fmt::format(
        "Without light samples the variance passes {} (1 % of error in 1e8 samples) at a width of "
        "{} (the sun itself would fill a texel of 680); as rendered it is {} at most, at every "
        "width",
        number(kMost), number(blind), number(worst_both));
    f.instead =
        "Light samples and surface samples are weighed against each other by the power "
        "heuristic; the sky is drawn from as it is looked up, between its texels too.";
    return f;
}

Finding tiny_lamp() {
    Finding f{.method = "Lamps of millimetres",
              .fails = "variance; no answer for punctual lights behind glass with a volume"};
    f.sweep = fmt::format(
        "A matt floor 10 m below a square lamp, always of the same illuminance, by the lamp's "
        "side: variance of one sample over the mean squared, from {} independent samples, as for "
        "the sun; and as rendered with a slab of glass between lamp and floor.",
        kLightSamples);
    f.table.columns = {"side (m)", "both (as rendered)", "light samples only",
                       "surface samples only", "as rendered behind glass"};
    for (const double side : {3., 1., 0.1, 0.01, 1e-3, 1e-4}) {
        const World world = under_lamp(side, false);
        add_row(f, side, variance_of(lit(world, integrator::Technique::Mis)),
                variance_of(lit(world, integrator::Technique::LightOnly)),
                variance_of(lit(world, integrator::Technique::BsdfOnly)),
                variance_of(lit(under_lamp(side, true), integrator::Technique::Mis, 8)));
    }
    const auto above = [](double most, double least_side, bool pane,
                          integrator::Technique technique, int max_depth) {
        const auto fails = [=](double side) {
            return lit(under_lamp(side, pane), technique, max_depth).relative_variance > most;
        };
        return first_failure(10, least_side, fails, 2);
    };
    const auto surface = above(kMost, 1e-3, false, integrator::Technique::BsdfOnly, 1);
    const auto glass = above(kMost, 1e-3, true, integrator::Technique::Mis, 8);
    const auto both = above(1, 1e-6, false, integrator::Technique::Mis, 1);
    f.where = fmt::format(
        "Without light samples the variance passes {} (1 % of error in 1e8 samples) below a side "
        "of {} m, and so it does as rendered behind glass below {} m: what no path of {} finds "
        "looks dark. Without glass: {}",
        number(kMost), number(surface), number(glass), kLightSamples,
        both ? "above 1 below a side of " + number(*both) + " m"
             : std::string("never above 1 down to a micrometre"));
    f.instead =
        "Lamps are drawn from by light samples. They go through thin panes, but not through glass "
        "with a volume: there only paths that happen to meet the lamp bring its light. Punctual "
        "lights and the sun of a glTF file, which no path can meet, do not shine through it at "
        "all.";
    return f;
}

namespace {

constexpr double kLightFocal_mm = 50, kFilm_px_mm = 0.006, kFocus_m = 1, kBehind_m = 10;

struct Highlight {
    Measured all;
    double owen_gain = 0;  ///< variance of means of 256: independent points over Owen-scrambled
};

// The middle pixel of a picture of a square lamp out of focus; every path finds it or does not.
Highlight highlight(double side_m, double fstop) {
    const World world = lamp_ahead(side_m, kBehind_m);
    const camera::ThinLensCamera camera({M44f(), 0.47f, 1.5f,
                                         camera::Iris(camera::Disk{}, kLightFocal_mm / (2 * fstop)),
                                         float(kFocus_m)});
    const V2f pixel(0.5f + 0.0007f, 0.5f + 0.0004f);
    const auto ray = [&](const Sampler& sampler) {
        return camera.sample({pixel, sampler}, Bands::rgb())[0].ray;
    };
    Highlight out;
    out.all = measure(world, integrator::PathOptions(), 1u << 17, ray, SamplerKind::Owen);
    constexpr uint32_t kMeans = 128, kEach = 256;
    const integrator::PathTracer tracer(world.scene, *world.bvh, *world.lights,
                                        integrator::PathOptions());
    integrator::PathStats stats;
    double variance = 0;
    for (uint32_t seed = 0; seed < kMeans; ++seed) {
        double mean = 0;
        for (uint32_t i = 0; i < kEach; ++i) {
            const Sampler sampler(SamplerKind::Owen, seed, {0, 0, i});
            FilmSample sample;
            mean +=
                double(tracer.radiance({ray(sampler)}, Bands::rgb(), sampler, sample, stats)[0]) /
                kEach;
        }
        variance += std::pow(mean - out.all.mean, 2) / kMeans;
    }
    const double p = out.all.mean;
    out.owen_gain = p * (1 - p) / kEach / variance;
    return out;
}

double confusion_m(double fstop) {
    return kLightFocal_mm / fstop * 1e-3 * (kBehind_m - kFocus_m) / kFocus_m;
}

}  // namespace

Finding defocused_highlights() {
    Finding f{.method = "Highlights out of focus", .fails = "variance"};
    f.sweep = fmt::format(
        "A thin lens of {:g} mm in focus at {:g} m, and a square highlight of 1 nit {:g} m away on "
        "black: a pixel within its blur. By the highlight's side and the f-number: the circle of "
        "confusion on the film in pixels of 6 um and at the highlight, the share of it that the "
        "highlight fills, variance of one sample over the mean squared, samples for 10 % of error, "
        "and by what Owen-scrambled points divide the variance of 256 samples. No rays to targets.",
        kLightFocal_mm, kFocus_m, kBehind_m);
    f.table.columns = {"side (m)", "f/",       "blur (px)",        "blur there (m)",
                       "share",    "variance", "samples for 10 %", "gain of Owen"};
    const double film_mm = kLightFocal_mm / (1 - kLightFocal_mm / (kFocus_m * 1e3));
    for (const double fstop : {1.4, 5.6})
        for (const double side : {0.1, 0.03, 0.01, 3e-3}) {
            const Highlight h = highlight(side, fstop);
            const double there_m = confusion_m(fstop);
            const double blur_px = there_m / kBehind_m * film_mm / kFilm_px_mm;
            const double v = h.all.relative_variance;
            add_row(f, side, fstop, blur_px, there_m,
                    side * side / (std::numbers::pi / 4 * there_m * there_m), v, v / 0.01,
                    h.all.found * 32768 > 100 && h.all.found < 1 ? number(h.owen_gain) : "");
        }
    const auto below = [](double fstop, double most) {
        return first_failure(0.2, 1e-4, [=](double side) {
            return highlight(side, fstop).all.relative_variance > most;
        });
    };
    const auto hundred = below(1.4, 99), thousand = below(1.4, 999);
    f.where = fmt::format(
        "The variance is 1 / share - 1, share being the highlight's part of its circle of "
        "confusion: at f/1.4, with a blur of {} m there, above 99 below a side of {} m and above "
        "999 below {} m ({} of the blur's width)",
        number(confusion_m(1.4)), number(hundred), number(thousand),
        percent(thousand.value_or(0) / confusion_m(1.4)));
    f.instead =
        "Rays are sent to lamps and to highlights that a search finds (`--method targets=auto`, "
        "next "
        "row). Of others no light sample passes a lens: noise falls with the samples, the sooner "
        "for scrambled points.";
    return f;
}

}  // namespace petzval::stability
