// SPDX-License-Identifier: Apache-2.0
// Rays to targets: where they bring little, and what their search misses.
#include <fmt/format.h>

#include <numbers>

#include "camera/lens/focus.h"
#include "camera/lens/paraxial.h"
#include "camera/models/thin_lens.h"
#include "camera/targets/make_target_camera.h"
#include "tests/stability/shipped_lens.h"
#include "tests/stability/sweeps.h"
#include "tests/stability/world.h"

namespace petzval::stability {
namespace {

constexpr double kTargetsFocal_mm = 50, kAway_m = 10;
constexpr uint32_t kTargetsSamples = 1u << 15;
/// Share of ordinary rays that pass a target which is well out of focus, at most.
constexpr float kOutOfFocus = 0.05f;
const V2i kFrame_px(960, 640);
constexpr int kRoom = camera::TargetCell::kMostTargets;

std::unique_ptr<camera::TargetCamera> thin(double fstop, double focus_m) {
    return camera::target_camera(std::make_shared<camera::ThinLensCamera>(camera::ThinLens{
        M44f(), 0.47f, 1.5f, camera::Iris(camera::Disk{}, kTargetsFocal_mm / (2 * fstop)),
        float(focus_m)}));
}

/// A pixel in the middle of the film, with a filter as wide as itself.
const Filter kBox(FilterKind::Box, 0.5f);
camera::FilmPoint draw(V2f middle, V2f frame_px, const Sampler& sampler) {
    const V2f offset_px = kBox.sample(sampler.get2(Dim::Film));
    return {middle + offset_px / frame_px, sampler, {&kBox, offset_px, frame_px}};
}
const V2f kPixel = (V2f(kFrame_px) / 2.f + V2f(0.5f)) / V2f(kFrame_px);
const camera::FilmCell kCell{kPixel - V2f(8) / V2f(kFrame_px), kPixel + V2f(8) / V2f(kFrame_px)};

/// Makes targets those of a camera, of equal chances, for all of the film. Returns what is listed.
std::vector<camera::ListedTarget> use(camera::TargetCamera& camera, const camera::FilmCell& cell,
                                      const std::vector<camera::Target>& targets) {
    camera::TargetGrid grid{{1, 1}, {{camera.map(cell), {}}}, targets};
    std::vector<camera::ListedTarget>& list = grid.lists[0].targets;
    for (const camera::Target& target : targets)
        if (const auto listed = grid.lists[0].map
                                    ? camera.listed(target, *grid.lists[0].map, kFrame_px)
                                    : std::nullopt)
            list.push_back(*listed);
    for (camera::ListedTarget& listed : list) listed.chance = 1.f / static_cast<float>(list.size());
    std::vector<camera::ListedTarget> out = list;
    camera.set_targets(std::make_shared<const camera::TargetGrid>(std::move(grid)));
    return out;
}

/// Relative variance of samples of a pixel, each an ordinary ray and one to a target.
double variance_with(const World& world, const camera::Camera& camera) {
    const integrator::PathTracer tracer(world.scene, *world.bvh, *world.lights,
                                        integrator::PathOptions());
    integrator::PathStats stats;
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < kTargetsSamples; ++i) {
        const Sampler sampler(SamplerKind::Independent, 1, {0, 0, i});
        const camera::FilmPoint point = draw(kPixel, V2f(kFrame_px), sampler);
        const Bands bands = Bands::rgb();
        double light = 0;
        for (const camera::CameraPath& path : camera.sample(point, bands)) {
            FilmSample none;
            light += double((path.weight * path.mis_weight *
                             tracer.radiance({path.ray, path.lanes, path.hero_decided}, bands,
                                             sampler, none, stats))[0]);
        }
        sum += light;
        squares += light * light;
    }
    return squares * kTargetsSamples / (sum * sum) - 1;
}

struct Sent {
    double variance = 0, met = 0;  ///< met: share of ordinary rays that pass the target
};

/// Where the middle of the lens sees a point through the pixel.
V3f ahead(V2f off_m) {
    const float away = static_cast<float>(kAway_m), half = std::tan(0.47f / 2) * away;
    return V3f((2 * kPixel.x - 1) * half * 1.5f + off_m.x, (1 - 2 * kPixel.y) * half + off_m.y,
               -away);
}
void place_lamp(World& world, const V3f& at, float side_m) {
    world.place(quad(at - V3f(side_m / 2, side_m / 2, 0), V3f(side_m, 0, 0), V3f(0, side_m, 0)),
                glowing(1));
}

/// A square lamp with a target around it.
Sent sent_to(double side_m, double fstop, double focus_m) {
    World world;
    const V3f at = ahead(V2f(0.f));
    const auto side = static_cast<float>(side_m);
    place_lamp(world, at, side);
    world.finish();
    const auto camera = thin(fstop, focus_m);
    const auto listed = use(*camera, kCell, {{at, side / std::numbers::sqrt2_v<float>}});
    if (listed.empty()) return {};
    return {variance_with(world, *camera), double(listed[0].met)};
}

/// Lamps side by side, of which so many are targets: variance of the light of all.
double variance_of_many(int lamps, int targets) {
    constexpr float kSide_m = 0.004f;
    World world;
    const auto camera = thin(1.4, 1);
    std::vector<camera::Target> list;
    for (int i = 0; i < lamps; ++i) {
        const V3f at = ahead(V2f(float(i % 8) - 3.5f, float(i / 8) - 3.5f) * 0.02f);
        place_lamp(world, at, kSide_m);
        if (i < targets) list.push_back({at, kSide_m * 0.71f});
    }
    world.finish();
    use(*camera, kCell, list);
    return variance_with(world, *camera);
}

/// Of rays of a traced lens that pass a target, the share that no region holds.
struct Missed {
    double away_m = 0;
    int hits = 0, missed = 0;

    [[nodiscard]] double share() const { return hits > 0 ? double(missed) / hits : 0; }
};

/// Focal lengths from the film at which a lens is in focus when it is near.
constexpr double kNear = 10;

/// A lens that ships, in focus as it ships or near; nothing where it cannot be.
std::optional<ShippedLens> shipped(const std::string& name, bool near) {
    ShippedLens lens(name);
    if (!near) return lens;
    const double focal_mm = camera::first_order(*lens.lens, kLineD_nm).focal_length_mm;
    auto focused_lens = camera::focused(*lens.lens, lens.lens->film_mm() - kNear * focal_mm);
    if (!focused_lens) return std::nullopt;
    lens.lens = std::make_shared<const camera::Lens>(*std::move(focused_lens));
    return lens;
}

// The cell is half a millimetre wide.
Missed missed_by(const ShippedLens& lens, double of_circle) {
    constexpr uint32_t kRays = 1u << 18;
    const auto aims = camera::target_camera(std::make_shared<camera::LensCamera>(
        lens.input(2 * lens.half_circle_mm, 2 * lens.half_circle_mm)));
    camera::TargetCamera& camera = *aims;
    const V2f film(static_cast<float>(0.5 - 0.5 * of_circle), 0.5f);
    const camera::FilmPoint middle{film, Sampler(SamplerKind::Owen, 3, {0, 0, 0})};
    const camera::CameraSample seen = camera.sample(middle, Bands::rgb());
    Missed out;
    if (seen.empty()) return out;
    const Ray& ray = seen[0].ray;
    const V2f half(static_cast<float>(0.125 / lens.half_circle_mm));
    const camera::FilmCell cell{film - half, film + half};
    camera::Target target;
    bool is_listed = false;
    for (const float away_m : {2.f, 1.f, 0.5f, 0.25f, 0.12f}) {
        target = {ray.origin + away_m * ray.direction, 1e-3f * away_m, false};
        const auto listed = use(camera, cell, {target});
        out.away_m = double(away_m);
        is_listed = !listed.empty() && listed[0].met < kOutOfFocus && !listed[0].is_sharp;
        if (is_listed) break;
    }
    if (!is_listed) return out;
    const camera::TargetCell* const of_all = &camera.targets()->lists[0];
    std::array<camera::FilmPoint, camera::kMostFilmPoints> points;
    std::array<Bands, camera::kMostFilmPoints> bands;
    std::array<const camera::TargetCell*, camera::kMostFilmPoints> cells;
    std::array<camera::CameraSample, camera::kMostFilmPoints> found;
    bands.fill(Bands::rgb());
    cells.fill(of_all);
    for (uint32_t first = 0; first < kRays; first += camera::kMostFilmPoints) {
        // One pixel is the cell.
        for (uint32_t i = 0; i < camera::kMostFilmPoints; ++i)
            points[i] = draw(film, V2f(1.f) / (half * 2.f),
                             Sampler(SamplerKind::Independent, 4, {0, 0, first + i}));
        camera.sample_beside(points, bands, cells, found);
        for (const camera::CameraSample& sample : found)
            for (const camera::CameraPath& path : sample) {
                const V3f to = target.centre - path.ray.origin;
                const float along = to.dot(path.ray.direction);
                if ((along * path.ray.direction - to).length() > target.radius_m) continue;
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
        "by side, of which some are targets. A pixel of {} x {} with a box filter.",
        kTargetsFocal_mm, kAway_m, kFrame_px.x, kFrame_px.y);
    f.table.columns = {"lamps", "targets", "side (m)", "focus (m)", "met", "variance"};
    for (const double focus_m : {1., 3., 8., 10.})
        for (const double side_m : {0.1, 0.01, 0.001}) {
            const Sent s = sent_to(side_m, 1.4, focus_m);
            add_row(f, 1, 1, side_m, focus_m, s.met, s.variance);
        }
    for (const auto& [lamps, targets] :
         {std::pair(8, 8), std::pair(64, 64), std::pair(kRoom, kRoom), std::pair(kRoom + 1, kRoom)})
        add_row(f, lamps, targets, 0.004, 1., "", variance_of_many(lamps, targets));
    const auto in_focus = first_failure(
        1, 9.99, [](double focus_m) { return !(sent_to(0.01, 1.4, focus_m).met < 0.25); });
    f.where = fmt::format(
        "The variance does not depend on the lamp's size: {} for 0.1 m, {} for a millimetre, where "
        "ordinary rays have 1 / share; in focus, where the millimetre is {} pixels wide, it "
        "is {}. From a focus of {} m on, until it is sharp, a lamp of 10 mm at {:g} m is "
        "passed by a quarter of the rays and is no target. Of {} lamps one is "
        "no target: {} in place of {}",
        number(sent_to(0.1, 1.4, 1).variance), number(sent_to(0.001, 1.4, 1).variance),
        number(1e-3 * kFrame_px.y / (2 * kAway_m * std::tan(0.47 / 2))),
        number(sent_to(0.001, 1.4, kAway_m).variance), number(in_focus), kAway_m, kRoom + 1,
        number(variance_of_many(kRoom + 1, kRoom)), number(variance_of_many(kRoom, kRoom)));
    f.instead = fmt::format(
        "Lamps in focus that are wider than a pixel are met by ordinary rays, and of smaller ones "
        "the film point is drawn. A list has room for {}: of more lamps in one pixel, the others "
        "stay with ordinary rays, as does what the search for highlights does not find.",
        kRoom);
    return f;
}

Finding search_for_targets() {
    Finding f{.method = "The search for rays to targets", .fails = "variance"};
    f.sweep = fmt::format(
        "Every lens that ships, wide open, line d, in focus as it ships and at {:g} focal lengths "
        "from the film, with a target that a ray of the stop passes, a 500th as wide as it is far "
        "away, at the first of 2, 1, 0.5, 0.25 and 0.12 m where at most 5 % of the rays pass it: "
        "2^18 rays of a quarter of a millimetre of film, by its place in the image circle; those "
        "that pass the target, and the share of them that no region holds.",
        kNear);
    f.table.columns = {"lens",         "focus",          "of the circle",
                       "distance (m)", "rays that pass", "not found"};
    int hits = 0, missed = 0;
    double worst = 0;
    std::string name;
    for (const io::LensSummary& summary : io::list_lenses())
        for (const bool near : {false, true}) {
            const auto lens = shipped(summary.name, near);
            if (!lens) continue;
            for (const double of_circle : {0., 0.5, 0.95}) {
                const Missed m = missed_by(*lens, of_circle);
                add_row(f, summary.name, near ? "near" : "as it ships", of_circle, m.away_m, m.hits,
                        m.hits > 0 ? percent(m.share()) : "");
                hits += m.hits, missed += m.missed;
                if (m.hits > 100 && m.share() > worst) worst = m.share(), name = summary.name;
            }
        }
    f.where = fmt::format(
        "Regions cover all ways on which light gets from a target to a film point. Of {} rays that "
        "pass a target {} lie in none",
        hits, missed);
    if (missed > 0) f.where += fmt::format("; at worst {} for {}", percent(worst), name);
    f.instead =
        "What no region holds is left to ordinary rays, with their whole weight: bright single "
        "pixels at the rims of discs. The mean is right. Targets that are sharp draw the film "
        "point within its pixel, and miss next to nothing.";
    return f;
}

}  // namespace petzval::stability
