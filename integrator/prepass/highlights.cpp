// SPDX-License-Identifier: Apache-2.0
#include "integrator/prepass/highlights.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "camera/ray_bundle.h"
#include "core/sampling/prepass_seed.h"
#include "integrator/prepass/image_fit.h"

namespace petzval::integrator {
namespace {

constexpr int kCell_px = 16;
constexpr int kRaysOfCell = 16;
/// Rays of the search for a pixel; and more, where something is found, for each image so many.
constexpr double kSearchRays = 1. / 16, kMoreRays = 1;
constexpr int64_t kRaysOfImage = 400;
/// Objects that are looked at by themselves: at most so many for a cell, of so many that are tried.
constexpr size_t kObjectsOfCell = 4, kMostTried = 8192;
/// Lamps that are looked for in a surface, strongest first.
constexpr size_t kMostLamps = 16;
/// Images that are found at most.
constexpr size_t kMostFound = 1024;
/// Searches for a lamp in an object that may fail, or find an image again, before it is given up.
constexpr int kMostFailures = 6;
/// Points of the lens for which an image is looked for.
constexpr size_t kEyes = 8;

std::vector<Source> sources_of(const Scene& scene, std::span<const SmallFeature> features) {
    std::vector<Source> out;
    for (const SmallFeature& t : features)
        if (t.is_lamp() && t.reach_m > 0 && std::isfinite(t.reach_m) && std::isfinite(t.radiance))
            out.push_back({t.centre, t.at_infinity, t.reach_m, t.radiance, t.radiance * t.area_m2});
    for (const Light& light : scene.lights) {
        const auto add = [&](const V3f& at, bool at_infinity, Rgb colour) {
            const double sent = double(luminance(colour));
            if (sent > 0 && std::isfinite(sent)) out.push_back({at, at_infinity, 0, sent, sent});
        };
        if (const auto* point = std::get_if<PointLight>(&light))
            add(point->position, false, point->intensity_cd);
        if (const auto* spot = std::get_if<SpotLight>(&light))
            add(spot->position, false, spot->intensity_cd);
        if (const auto* measured = std::get_if<ProfileLight>(&light))  // on average
            add(measured->position, false,
                measured->factor * (scene.profiles[measured->profile].flux_lm() / (4 * kPi)));
        if (const auto* sun = std::get_if<SunLight>(&light); sun && !sun->has_disc())
            add(-sun->direction, true, sun->illuminance_lx);
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Source& a, const Source& b) { return a.strength > b.strength; });
    if (out.size() > kMostLamps) out.resize(kMostLamps);
    return out;
}

/// A ray from the lens, and the polished surface that it meets.
struct Start {
    V3f eye, direction;
    uint32_t instance;
    size_t cell;
    Way way;
};

/// Whether two images are one, as seen from the lens: how far away it is, is known less well.
bool is_same(const SmallFeature& a, const SmallFeature& b, const V3f& eye) {
    constexpr float kSameDistance = 0.1f;
    if (a.at_infinity != b.at_infinity) return false;
    const V3f apart = b.centre - a.centre;
    const float reach_m = 2 * std::max(a.reach_m, b.reach_m);
    if (a.at_infinity) return apart.length() < reach_m;
    const V3f to = a.centre - eye;
    const float along = apart.dot(unit(to));
    return (apart - along * unit(to)).length() < reach_m &&
           std::fabs(along) < kSameDistance * to.length();
}

struct FoundImage {
    SmallFeature feature;
    uint32_t instance;  ///< object that shows it
    V3f place;          ///< its point
};

/// The image of a lamp near a start, as that point of the lens and others see it.
std::optional<FoundImage> image_from(HighlightSearch& search, const Start& start,
                                     const std::vector<Ray>& eyes, const Source& lamp) {
    const auto found = search.image(start.eye, start.direction, lamp, start.way);
    if (!found || search.is_hidden(*found, lamp)) return std::nullopt;
    std::vector<LampImage> images{*found};
    for (const Ray& ray : eyes) {
        const V3f& eye = ray.origin;
        if (images.size() == kEyes) break;
        if (eye == start.eye) continue;
        if (const auto more =
                search.image(eye, unit(found->met.first - eye), lamp, start.way, &*found))
            images.push_back(*more);
    }
    const auto feature = lamp_of(std::move(images), lamp);
    if (!feature) return std::nullopt;
    return FoundImage{*feature, found->met.surface.hit.instance, found->met.first};
}

bool may_be_polished(const Material& m) {
    return m.roughness <= kMostRoughness || m.metallic_roughness_texture.present() ||
           (m.coat > 0 && m.coat_roughness <= kMostRoughness);
}

/// An object, roughly.
struct Ball {
    V3f middle;
    float radius_m;
};

/// Balls about objects; boxes of meshes are found as they are asked for.
class Balls {
  public:
    explicit Balls(const Scene& scene) : scene_(scene), of_mesh_(scene.meshes.size()) {}

    [[nodiscard]] Ball of(uint32_t instance) {
        const Instance& placed = scene_.instances[instance];
        Box3f& box = of_mesh_[placed.mesh];
        if (box.isEmpty())
            for (const V3f& p : scene_.meshes[placed.mesh].positions) box.extendBy(p);
        V3f middle, corner;
        placed.to_world.multVecMatrix(box.center(), middle);
        placed.to_world.multVecMatrix(box.max, corner);
        return {middle, (corner - middle).length()};
    }

  private:
    const Scene& scene_;
    std::vector<Box3f> of_mesh_;
};

/// Adds the polished surfaces that a ray of a cell meets first.
void look(HighlightSearch& search, const Ray& ray, size_t cell, std::vector<Start>& starts) {
    const auto shaded = search.first(ray);
    if (!shaded) return;
    for (const Way way : {Way::Mirrored, Way::Through})
        if (const auto met = search.met(*shaded, ray.direction, way))
            starts.push_back({ray.origin, ray.direction, met->surface.hit.instance, cell, way});
}

/// What the cells of a frame see.
struct SeenCells {
    std::vector<camera::RayBundle> bundles;
    V3f eye{0.f};                                   ///< mean of their origins
    std::map<uint32_t, std::vector<Start>> starts;  ///< by object

    /// Cell that looks towards a point, as seen from the middle of the lens; none beyond the frame.
    [[nodiscard]] std::optional<size_t> towards(const V3f& point) const {
        std::optional<size_t> best;
        float most = -1;
        const V3f direction = unit(point - eye);
        for (size_t n = 0; n < bundles.size(); ++n) {
            if (bundles[n].rays.empty()) continue;
            const float cosine = direction.dot(bundles[n].direction);
            if (cosine > most && cosine >= bundles[n].least_cosine) best = n, most = cosine;
        }
        return best;
    }
};

/// Rays that meet polished surfaces, the objects by turns.
std::vector<Start> in_turns(const std::map<uint32_t, std::vector<Start>>& by_object) {
    // First one of each object, then another of each. Neighbours see the same: they are mixed.
    struct Turn {
        size_t turn;
        Start start;
    };
    std::vector<Turn> turns;
    for (const auto& [instance, starts] : by_object) {
        std::vector<size_t> order(starts.size());
        std::iota(order.begin(), order.end(), 0);
        std::sort(order.begin(), order.end(), [](size_t a, size_t b) {
            return hash32(static_cast<uint32_t>(a)) < hash32(static_cast<uint32_t>(b));
        });
        for (size_t n = 0; n < order.size(); ++n) turns.push_back({n, starts[order[n]]});
    }
    std::stable_sort(turns.begin(), turns.end(),
                     [](const Turn& a, const Turn& b) { return a.turn < b.turn; });
    std::vector<Start> out;
    for (const Turn& turn : turns) out.push_back(turn.start);
    return out;
}

SeenCells cells_of(const camera::Camera& camera, const Scene& scene, const Bvh& bvh, V2i frame_px,
                   Balls& balls, const camera::RunTasks& run) {
    const V2i cells = frame_px / kCell_px;
    SeenCells out;
    out.bundles.resize(static_cast<size_t>(cells.x) * static_cast<size_t>(cells.y));
    std::vector<std::vector<Start>> starts(out.bundles.size());
    camera::run_cells(run, cells, [&](size_t n, V2i place) {
        HighlightSearch search(scene, bvh, INT64_MAX);
        const camera::FilmCell cell{V2f(place) / V2f(cells), V2f(place + V2i(1, 1)) / V2f(cells)};
        out.bundles[n] =
            camera::bundle_of(camera, cell, number_of(PrepassSeed::Highlights), place, kRaysOfCell);
        for (const Ray& ray : out.bundles[n].rays) look(search, ray, n, starts[n]);
    });
    for (const std::vector<Start>& of_cell : starts)
        for (const Start& start : of_cell) out.starts[start.instance].push_back(start);
    for (const camera::RayBundle& bundle : out.bundles)
        out.eye += bundle.origin / static_cast<float>(out.bundles.size());
    // Small objects are passed by.
    size_t left = out.bundles.size() * kObjectsOfCell;
    HighlightSearch search(scene, bvh, INT64_MAX);
    const size_t step = scene.instances.size() / kMostTried + 1;
    for (size_t n = 0; n < scene.instances.size() && left > 0; n += step) {
        const Instance& instance = scene.instances[n];
        const auto number = static_cast<uint32_t>(n);
        if (!may_be_polished(scene.materials[scene.meshes[instance.mesh].material]) ||
            out.starts.contains(number))
            continue;
        const V3f middle = balls.of(number).middle;
        const auto cell = out.towards(middle);
        if (!cell) continue;
        const V3f eye = out.bundles[*cell].rays.front().origin;
        std::vector<Start> starts_there;
        look(search, {eye, unit(middle - eye)}, *cell, starts_there);
        for (const Start& start : starts_there)
            if (start.instance == number) out.starts[number].push_back(start);
        --left;
    }
    return out;
}

}  // namespace

std::vector<SmallFeature> highlights(const camera::Camera& camera, const Scene& scene,
                                     const Bvh& bvh, V2i frame_px,
                                     std::span<const SmallFeature> features,
                                     const camera::RunTasks& run) {
    const std::vector<Source> lamps = sources_of(scene, features);
    if (lamps.empty() || frame_px.x < kCell_px || frame_px.y < kCell_px) return {};
    const double pixels = double(frame_px.x) * double(frame_px.y);
    Balls balls(scene);
    const SeenCells seen = cells_of(camera, scene, bvh, frame_px, balls, run);
    HighlightSearch search(scene, bvh, static_cast<int64_t>(kSearchRays * pixels));
    auto more_rays = static_cast<int64_t>(kMoreRays * pixels);
    std::map<std::tuple<uint32_t, size_t, Way>, int> failures;  // by object, lamp and way
    // Where the last object showed a lamp, from its middle, in its radii.
    std::map<std::pair<size_t, Way>, V3f> places;
    std::vector<SmallFeature> out;
    for (const Start& start : in_turns(seen.starts))
        for (size_t l = 0; l < lamps.size(); ++l) {
            const Source& lamp = lamps[l];
            if (!search.may_go_on() || out.size() == kMostFound) return out;
            const auto [entry, is_first] = failures.try_emplace({start.instance, l, start.way});
            int& failed = entry->second;
            if (failed > kMostFailures || (start.way == Way::Through && !lamp.has_size())) continue;
            // Another object showed it about there: drops and balls are alike.
            std::optional<FoundImage> image;
            const std::vector<Ray>& eyes = seen.bundles[start.cell].rays;
            const Ball ball = balls.of(start.instance);
            const auto shown = places.find({l, start.way});
            if (is_first && shown != places.end()) {
                Start there = start;
                there.direction = unit(ball.middle + ball.radius_m * shown->second - start.eye);
                image = image_from(search, there, eyes, lamp);
                if (image && image->instance != start.instance) image.reset();  // it stands before
            }
            if (!image) image = image_from(search, start, eyes, lamp);
            const auto same = [&](const SmallFeature& other) {
                return is_same(other, image->feature, start.eye);
            };
            if (!image || std::any_of(out.begin(), out.end(), same)) {
                ++failed;
                continue;
            }
            places[{l, start.way}] = (image->place - ball.middle) / ball.radius_m;
            out.push_back(image->feature);
            // Where there is something to find, the search goes on.
            const int64_t more = std::min(more_rays, kRaysOfImage);
            search.allow(more);
            more_rays -= more;
        }
    return out;
}

}  // namespace petzval::integrator
