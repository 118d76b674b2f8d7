// SPDX-License-Identifier: Apache-2.0
// Rays to targets: where they bring little, and what their search misses.
#include <fmt/format.h>

#include <numbers>

#include "camera/models/thin_lens.h"
#include "camera/targets/make_target_camera.h"
#include "tests/stability/shipped_lens.h"
#include "tests/stability/sweeps.h"
#include "tests/stability/world.h"

namespace petzval::stability {
namespace {

constexpr double kFocal_mm = 50, kAway_m = 10;
constexpr uint32_t kSamples = 1u << 15;
/// Share of ordinary rays that pass a target which is well out of focus, at most.
constexpr float kOutOfFocus = 0.05f;
const V2f kPixel(0.5007f, 0.5004f);
const FilmCell kCell{V2f(0.5f), V2f(0.501f)};

std::unique_ptr<TargetCamera> thin(double fstop, double focus_m) {
    return target_camera(std::make_shared<ThinLensCamera>(
        ThinLens{M44f(), 0.47f, 1.5f, Iris(Disk{}, kFocal_mm / (2 * fstop)), float(focus_m)}));
}

Target facing(const V3f& centre, double radius_m) {
    return {centre, unit(centre), static_cast<float>(radius_m), false};
}

/// Makes a list of a camera, of equal chances, for all of the film.
void use(TargetCamera& camera, std::vector<ListedTarget> list) {
    TargetGrid grid{{1, 1}, {}, {}};
    for (ListedTarget& target : list) target.chance = 1.f / static_cast<float>(list.size());
    grid.lists.push_back(std::move(list));
    camera.set_targets(std::make_shared<const TargetGrid>(std::move(grid)));
}

/// Relative variance of samples of a pixel, each an ordinary ray and one to a target.
double variance_with(const World& world, const Camera& camera) {
    const PathTracer tracer(world.scene, *world.bvh, *world.lights, PathOptions());
    PathStats stats;
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < kSamples; ++i) {
        const Sampler sampler(SamplerKind::Independent, 1, {0, 0, i});
        const FilmPoint point{kPixel, sampler};
        const Bands bands = Bands::rgb();
        double light = 0;
        for (const CameraPath& path : camera.sample(point, bands)) {
            FilmSample none;
            light += double((path.weight * path.mis_weight *
                             tracer.radiance({path.ray, path.lanes, path.hero_decided}, bands,
                                             sampler, none, stats))[0]);
        }
        sum += light;
        squares += light * light;
    }
    return squares * kSamples / (sum * sum) - 1;
}

struct Sent {
    double variance = 0, met = 0;  ///< met: share of ordinary rays that pass the target
};

/// A square lamp out of focus, with a target around it.
Sent sent_to(double side_m, double fstop, double focus_m) {
    const World world = lamp_ahead(side_m, kAway_m);
    const auto camera = thin(fstop, focus_m);
    const auto ready = camera->prepared(
        facing(V3f(0, 0, static_cast<float>(-kAway_m)), side_m / std::numbers::sqrt2));
    const auto listed = ready ? camera->listed(*ready, kCell) : std::nullopt;
    if (!listed) return {};
    use(*camera, {*listed});
    return {variance_with(world, *camera), double(listed->met)};
}

/// Lamps side by side, of which so many are targets: variance of the light of all.
double variance_of_many(int lamps, int targets) {
    constexpr float kSide_m = 0.004f;
    World world;
    const auto camera = thin(1.4, 1);
    std::vector<ListedTarget> list;
    for (int i = 0; i < lamps; ++i) {
        const V3f at(0.02f * (float(i % 8) - 3.5f), 0.02f * (float(i / 8) - 3.5f),
                     static_cast<float>(-kAway_m));
        world.place(
            quad(at - V3f(kSide_m / 2, kSide_m / 2, 0), V3f(kSide_m, 0, 0), V3f(0, kSide_m, 0)),
            glowing(1));
        if (i < targets)
            list.push_back(*camera->listed(*camera->prepared(facing(at, kSide_m * 0.71)), kCell));
    }
    world.finish();
    use(*camera, list);
    return variance_with(world, *camera);
}

/// Of rays of a traced lens that pass a target, the share that its search does not find.
struct Missed {
    double away_m = 0;
    int hits = 0, missed = 0;

    [[nodiscard]] double share() const { return hits > 0 ? double(missed) / hits : 0; }
};

// The cell is half a millimetre wide.
Missed missed_by(const std::string& name, double of_circle) {
    constexpr uint32_t kRays = 1u << 18;
    const ShippedLens lens(name);
    const auto aims = target_camera(
        std::make_shared<LensCamera>(lens.input(2 * lens.half_circle_mm, 2 * lens.half_circle_mm)));
    TargetCamera& camera = *aims;
    const V2f film(static_cast<float>(0.5 - 0.5 * of_circle), 0.5f);
    const FilmPoint middle{film, Sampler(SamplerKind::Owen, 3, {0, 0, 0})};
    const CameraSample seen = camera.sample(middle, Bands::rgb());
    Missed out;
    if (seen.empty()) return out;
    const Ray& ray = seen[0].ray;
    const V2f half(static_cast<float>(0.125 / lens.half_circle_mm));
    const FilmCell cell{film - half, film + half};
    Target target;
    std::optional<ListedTarget> listed;
    for (const float away_m : {2.f, 1.f, 0.5f, 0.25f, 0.12f}) {
        target = {ray.origin + away_m * ray.direction, -ray.direction, 1e-3f * away_m, false};
        const auto ready = camera.prepared(target);
        listed = ready ? camera.listed(*ready, cell) : std::nullopt;
        out.away_m = double(away_m);
        if (listed && listed->met < kOutOfFocus) break;
        listed.reset();
    }
    if (!listed) return out;
    use(camera, {*listed});
    for (uint32_t i = 0; i < kRays; ++i) {
        const Sampler sampler(SamplerKind::Independent, 4, {0, 0, i});
        const V2f at = cell.first + sampler.get2(Dim::Film) * (cell.last - cell.first);
        for (const CameraPath& path : camera.sample({at, sampler}, Bands::rgb())) {
            if (path.to_target) continue;
            const V3f to = target.centre - path.ray.origin;
            const float t = to.dot(target.normal) / path.ray.direction.dot(target.normal);
            if ((t * path.ray.direction - to).length() > target.radius_m) continue;
            ++out.hits;
            out.missed += path.mis_weight > 0.99f;
        }
    }
    return out;
}

}  // namespace

Finding rays_to_targets() {
    Finding f{.method = "Rays to targets", .fails = "variance"};
    f.sweep = fmt::format(
        "A thin lens of {:g} mm at f/1.4 and a square lamp {:g} m away on black, with a target "
        "around it: variance of one sample over the mean squared, by the lamp's side and the "
        "distance in focus, and the share of ordinary rays that pass the target. Then lamps side "
        "by side, of which some are targets.",
        kFocal_mm, kAway_m);
    f.table.columns = {"lamps", "targets", "side (m)", "focus (m)", "met", "variance"};
    for (const double focus_m : {1., 3., 8.})
        for (const double side_m : {0.1, 0.01, 0.001}) {
            const Sent s = sent_to(side_m, 1.4, focus_m);
            // Near focus the disc of a small lamp does not reach the pixel.
            if (!std::isfinite(s.variance)) continue;
            add_row(f, 1, 1, side_m, focus_m, s.met, s.variance);
        }
    for (const auto& [lamps, targets] : {std::pair(8, 8), std::pair(16, 16), std::pair(17, 16),
                                         std::pair(64, 16), std::pair(64, 64)})
        add_row(f, lamps, targets, 0.004, 1., "", variance_of_many(lamps, targets));
    const auto in_focus = first_failure(
        1, 9.99, [](double focus_m) { return !(sent_to(0.01, 1.4, focus_m).met < 0.25); });
    f.where = fmt::format(
        "The variance does not depend on the lamp's size: {} for 0.1 m, {} for a millimetre, where "
        "ordinary rays have 1 / share. From a focus of {} m on, a lamp of 10 mm at {:g} m is "
        "passed by a quarter of the rays and is no target. One lamp of 17 that is no target brings "
        "the variance back: {} in place of {}",
        number(sent_to(0.1, 1.4, 1).variance), number(sent_to(0.001, 1.4, 1).variance),
        number(in_focus), kAway_m, number(variance_of_many(17, 16)),
        number(variance_of_many(16, 16)));
    f.instead =
        "Lamps near focus are met by ordinary rays. A list has room for 16: of more lamps in one "
        "pixel, the others stay with ordinary rays, as does what the search for highlights does "
        "not find.";
    return f;
}

Finding search_for_targets() {
    Finding f{.method = "The search for rays to targets", .fails = "variance"};
    f.sweep =
        "Every lens that ships, wide open, line d, in focus as it ships, with a target that a ray "
        "of the stop passes, a 500th as wide as it is far away, at the first of 2, 1, 0.5, 0.25 "
        "and 0.12 m where at most 5 % of the rays pass it: 2^18 rays of a quarter of a millimetre "
        "of film, by its place in the image circle; those that pass the target, and the share of "
        "them that the search does not find.";
    f.table.columns = {"lens", "of the circle", "distance (m)", "rays that pass", "not found"};
    double worst = 0;
    std::string name;
    for (const LensSummary& summary : list_lenses())
        for (const double of_circle : {0., 0.5, 0.95}) {
            const Missed m = missed_by(summary.name, of_circle);
            add_row(f, summary.name, of_circle, m.away_m, m.hits,
                    m.hits > 0 ? percent(m.share()) : "");
            if (m.hits > 100 && m.share() > worst) worst = m.share(), name = summary.name;
        }
    f.where = fmt::format(
        "Of the rays that pass a target, {} are not found at worst ({}): beside caustics, where "
        "two ways meet, and at folds of the pupil",
        percent(worst), name);
    f.instead =
        "What the search does not find is left to ordinary rays, with their whole weight: bright "
        "single pixels at the rims of discs. The mean is right.";
    return f;
}

}  // namespace petzval::stability
