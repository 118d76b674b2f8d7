// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/rare_light.h"

#include <algorithm>
#include <cmath>

#include "core/spectrum/bands.h"
#include "io/image/symmetric_mse.h"

namespace petzval::apps {
namespace {

constexpr uint32_t kRaysToLamps = 256;
/// Clusters of lamps of a class of brightness where they are targets.
constexpr size_t kMostTargetedLamps = 128;
/// Pixels of a lamp's disc that tell how many rays are sent to it.
constexpr int64_t kPixelsOfDisc = 256;
/// The density of rays at a lamp is that of this many nearest ones.
constexpr size_t kNearest = 16;

/// Share of the light on its disc from which on a lamp decides how bright that is: half of it, for
/// a lamp whose area and share of the rays are known to a factor of two.
constexpr double kMostOfTheLight = 0.25;

/// Times as often as ordinary rays those that are sent to a lamp meet it where they decide.
constexpr double kDecisive = 4;

/// Share of the disc around a cluster of lamps that one lamp fills at least: a square has 0.3.
constexpr double kFilled = 0.1;

/// Ray of a random film point in a region; nothing where the lens lets none through.
std::optional<Ray> ray_in(const RenderSetup& setup, V2i size_px, const camera::FilmRegion& region,
                          uint32_t i) {
    // The distances of the nearest tell a density where rays know nothing of each other.
    const Sampler sampler(SamplerKind::Independent, 1, {0, 0, i});
    const V2f within = sampler.get2(Dim::Film);
    const auto area = static_cast<double>(region.area_px());
    const auto [x, y] =
        region.pixel(std::min(static_cast<int64_t>(double(within.x) * area), region.area_px() - 1));
    const float rest = static_cast<float>(double(within.x) * area);
    const V2f film((float(x) + rest - std::floor(rest)) / float(size_px.x),
                   (float(y) + within.y) / float(size_px.y));
    const Observer& observer = setup.view.observer;
    const Bands bands =
        observer.spectral() ? observer.draw(sampler.get1(Dim::Wavelength)) : Bands::rgb();
    const camera::CameraSample seen = setup.view.still->sample({film, sampler}, bands);
    if (seen.empty()) return std::nullopt;
    return seen[0].ray;
}

/// Squared distance at which a ray passes a lamp, in metres, or radians at infinity.
double square_distance(const Ray& ray, const SmallFeature& lamp) {
    if (lamp.at_infinity) return double((ray.direction - lamp.centre).length2());
    const V3f to = lamp.centre - ray.origin;
    const float along = to.dot(ray.direction);
    return along > 0 ? double((to - along * ray.direction).length2()) : INFINITY;
}

/// Whether a thing is one lamp, not several far apart.
bool is_alone(const SmallFeature& lamp) {
    const double across = double(kPi) * double(lamp.radius_m) * double(lamp.radius_m);
    return lamp.area_m2 >= kFilled * across;
}

/// Rays of a sample of a pixel that are sent to a lamp and meet it, on average. Of several lamps
/// far apart, targets may hold some and not others: they do not count.
double sent_to(const RenderSetup& setup, V2i size_px, std::array<int, 2> pixel,
               const SeenLamp& lamp) {
    const camera::TargetGrid* grid = setup.view.targets.get();
    if (!grid || !lamp.alone) return 0;
    const V2f film((float(pixel[0]) + 0.5f) / float(size_px.x),
                   (float(pixel[1]) + 0.5f) / float(size_px.y));
    const camera::TargetCell& cell = grid->at(film);
    const auto along = camera::FilmOctagon::along(film);
    double sum = 0;
    for (const camera::ListedTarget& listed : cell.targets) {
        const camera::Target& target = grid->targets[listed.number];
        if (!listed.seen_from.contains(along) || target.at_infinity != lamp.feature.at_infinity ||
            (target.centre - lamp.feature.centre).length() > lamp.feature.radius_m)
            continue;
        const double disc = double(kPi) * double(target.radius_m) * double(target.radius_m);
        sum += double(listed.chance) * std::min(1., lamp.feature.area_m2 / disc);
    }
    return sum > 0 ? sum * cell.rays / double(cell.chances(along)) : 0;
}

bool is_hidden(const Bvh& bvh, const Ray& ray, const SmallFeature& lamp) {
    Ray shadow;
    shadow.origin = ray.origin;
    if (lamp.at_infinity) {
        shadow.direction = lamp.centre;
    } else {
        shadow.direction = lamp.centre - ray.origin;
        const float distance = shadow.direction.length();
        shadow.t_max = std::max(0.f, 0.999f - lamp.radius_m / distance);
    }
    return bvh.occluded(shadow);
}

}  // namespace

std::vector<SeenLamp> seen_lamps(const RenderSetup& setup, V2i size_px,
                                 const std::vector<SmallFeature>& features,
                                 const std::vector<camera::FilmRegion>& regions) {
    std::vector<SeenLamp> out;
    for (size_t n = 0; n < features.size(); ++n) {
        const SmallFeature& lamp = features[n];
        if (!lamp.is_lamp() || regions[n].rects.empty()) continue;
        std::vector<double> squares;
        bool visible = false;
        for (uint32_t i = 0; i < kRaysToLamps; ++i) {
            const auto ray = ray_in(setup, size_px, regions[n], i);
            squares.push_back(ray ? square_distance(*ray, lamp) : INFINITY);
            visible |= ray && i % 8 == 0 && !is_hidden(*setup.prepared.bvh, *ray, lamp);
        }
        if (!visible) continue;
        std::nth_element(squares.begin(), squares.begin() + kNearest - 1, squares.end());
        const double disk = double(kPi) * squares[kNearest - 1];
        // A lamp that is larger than the disk is met by all rays within it.
        const double shown = disk > 0 ? std::min(1., lamp.area_m2 / disk) : 1;
        out.push_back({regions[n].area_px(), shown * kNearest / kRaysToLamps, is_alone(lamp), lamp,
                       &regions[n]});
    }
    return out;
}

std::vector<SmallFeature> features_of(const RenderSetup& setup) {
    const Scene& scene = *setup.prepared.scene;
    return setup.view.targets ? small_features_of(scene, kMostTargetedLamps)
                              : small_features_of(scene);
}

// Of several far apart, the disc of their area.
void SmallLamps::add(const SeenLamp& lamp) {
    const SmallFeature& thing = lamp.feature;
    ++(thing.at_infinity ? spots : lamps);
    double& largest = thing.at_infinity ? largest_spot_rad : largest_lamp_m;
    const double radius =
        lamp.alone ? double(thing.radius_m) : std::sqrt(thing.area_m2 / double(kPi));
    largest = std::max(largest, 2 * radius);
}

std::vector<LampSamples> samples_of_lamps(const RenderSetup& setup, V2i size_px, double nits) {
    std::vector<SmallFeature> features = features_of(setup);
    std::erase_if(features,
                  [&](const SmallFeature& f) { return !f.is_lamp() || f.radiance < nits; });
    std::vector<camera::FilmRegion> regions =
        camera::film_regions(*setup.view.still, size_px, features);
    std::vector<LampSamples> out;
    for (const SeenLamp& lamp : seen_lamps(setup, size_px, features, regions)) {
        const int64_t pixels = std::min(kPixelsOfDisc, lamp.area_px);
        double sent = 0;
        for (int64_t i = 0; i < pixels; ++i)
            sent += sent_to(setup, size_px, lamp.region->pixel(i * lamp.area_px / pixels), lamp);
        const double met = double(lamp.area_px) * (lamp.probability + sent / double(pixels));
        out.push_back({lamp, *lamp.region, std::ceil(kEnoughPaths / met)});
        out.back().lamp.region = nullptr;
    }
    return out;
}

SmallLamps seldom_met(const RenderSetup& setup, V2i size_px, double samples, double nits) {
    SmallLamps out;
    for (const LampSamples& one : samples_of_lamps(setup, size_px, samples * nits)) {
        if (samples >= one.samples) continue;
        out.add(one.lamp);
        out.samples = std::max(out.samples, one.samples);
    }
    return out;
}

std::vector<V3d> least_means(const Pilot& pilot, const PilotModel& model,
                             const std::vector<SeenLamp>& lamps) {
    std::vector<V3d> out(pilot.pixels(), V3d(0.));
    for (const SeenLamp& lamp : lamps) {
        if (!lamp.alone) continue;
        std::vector<size_t> on_disc;
        V3d sum(0.);
        double sent = 0;
        for (size_t p = 0; p < pilot.pixels(); ++p) {
            const auto [x, y] = pilot.chosen().pixels[p].pixel;
            if (!lamp.region->contains(x, y)) continue;
            on_disc.push_back(p);
            sent += sent_to(model.setup(), pilot.size_px(), {x, y}, lamp);
            for (const V3d& v : model.means(p)) sum += v / double(kPilotReplicates);
        }
        if (on_disc.empty()) continue;
        const double met = lamp.probability + sent / static_cast<double>(on_disc.size());
        if (kPilotReplicates * model.samples() * met >= 1) continue;
        sum /= static_cast<double>(on_disc.size());
        const double expected = lamp.feature.radiance * lamp.probability;
        const double seen = double(luminance(Rgb(float(sum.x), float(sum.y), float(sum.z))));
        // Other light is better known, and uneven.
        if (expected < kMostOfTheLight * seen) continue;
        for (const size_t p : on_disc)
            for (int c = 0; c < 3; ++c) out[p][c] = std::max({out[p][c], sum[c], expected});
    }
    return out;
}

RareLight rare_light(const Pilot& pilot, const PilotModel& model,
                     const std::vector<SeenLamp>& lamps, bool has_lamps, double floor) {
    RareLight out;
    const V2i size = pilot.size_px();
    const double pixels = double(size.x) * double(size.y);
    for (const SeenLamp& lamp : lamps) {
        double in_region = 0, light = 0, sent = 0;
        for (size_t p = 0; p < pilot.pixels(); ++p) {
            const auto [x, y] = pilot.chosen().pixels[p].pixel;
            if (!lamp.region->contains(x, y)) continue;
            ++in_region;
            sent += sent_to(model.setup(), size, {x, y}, lamp);
            for (const V3d& v : model.means(p))
                light +=
                    double(luminance(Rgb(float(v.x), float(v.y), float(v.z)))) / kPilotReplicates;
        }
        const double samples = kPilotReplicates * model.samples();
        const double behind = in_region > 0 ? light / in_region : 0;
        const double share = static_cast<double>(lamp.area_px) / pixels;
        if (samples * (in_region * lamp.probability + sent) >= kEnoughPaths) {
            // Found as well, or nearly, without rays that are sent there.
            if (sent < kDecisive * in_region * lamp.probability) continue;
            ++out.targeted;
            out.spared += share * lamp.square() / (behind * behind + floor * floor);
            continue;
        }
        const double with = behind + lamp.feature.radiance * lamp.probability;
        out.seldom.add(lamp);
        if (with > 0) out.noise += share * lamp.square() / (with * with + floor * floor);
        out.lost += share * io::symmetric_square(behind, with, floor);
    }
    const auto seldom = [&](const integrator::ChanceFinds& found) {
        return has_lamps && found.bounces > 0 && double(found.lamps) < kEnoughPaths;
    };
    out.mirrored = seldom(model.stats().mirrored);
    out.caustic = seldom(model.stats().caustic);
    out.behind_glass = model.setup().prepared.lost_light.size();
    return out;
}

}  // namespace petzval::apps
