// SPDX-License-Identifier: Apache-2.0
#include "camera/diffraction/lamp_images.h"

#include <algorithm>
#include <cmath>

#include "camera/diffraction/star_aim.h"
#include "camera/ray_bundle.h"
#include "camera/setup/film_region.h"
#include "core/sampling/prepass_seed.h"
#include "core/sampling/sampler.h"

namespace petzval {
namespace {

/// Cells of the search across the frame, and how far beyond it they go, in frames.
constexpr int kCells = 24, kBeyond = kCells / 2;
/// Rays of a cell that tell which lamps it may see, and the margin for what lies between them.
constexpr int kRays = 32;
constexpr float kMargin = 0.5f;
/// Share of the frame's film points whose stars are so bright that every second sample looks for
/// them, at least.
constexpr float kBright = 0.1f;
constexpr uint32_t kTried = 1024;

Target target_of(const SmallFeature& lamp) {
    return {lamp.centre, lamp.at_infinity ? std::tan(lamp.reach_m) : lamp.reach_m,
            lamp.at_infinity};
}

}  // namespace

LampImages::LampImages(const TargetCamera& aims, V2i frame_px,
                       std::span<const SmallFeature> features, const FilmSpread& spread) {
    struct Found {
        FilmCell at;
        double met = 0;  ///< share of rays, by area of the film
        double light = 0;
    };
    std::vector<Found> found(features.size());
    for (int j = -kBeyond; j < kCells + kBeyond; ++j)
        for (int i = -kBeyond; i < kCells + kBeyond; ++i) {
            const FilmCell cell{V2f(float(i), float(j)) / float(kCells),
                                V2f(float(i + 1), float(j + 1)) / float(kCells)};
            const RayBundle bundle =
                bundle_of(aims, cell, number_of(PrepassSeed::TargetCells), {i, j}, kRays);
            std::shared_ptr<const StopMap> map;
            bool tried = false;
            for (size_t n = 0; n < features.size(); ++n) {
                if (!passes(bundle, features[n], kMargin)) continue;
                if (!tried) map = aims.map(cell), tried = true;
                if (!map) break;
                const auto seen = aims.listed(target_of(features[n]), *map, frame_px);
                if (!seen) continue;
                FilmOctagon octagon = seen->seen_from;
                for (size_t k = 0; k < 2; ++k)
                    octagon.low[k] += octagon.beyond, octagon.high[k] -= octagon.beyond;
                const FilmCell part = octagon.within(cell);
                if (!(part.area() > 0)) continue;
                Found& f = found[n];
                if (f.met == 0) f.at = part;
                f.at.first = {std::min(f.at.first.x, part.first.x),
                              std::min(f.at.first.y, part.first.y)};
                f.at.last = {std::max(f.at.last.x, part.last.x),
                             std::max(f.at.last.y, part.last.y)};
                f.met += double(seen->met) * double(part.area());
                f.light = f.met * features[n].radiance;
            }
        }
    std::ranges::stable_sort(found,
                             [](const Found& a, const Found& b) { return a.light > b.light; });
    // Corners of a box that are no lamp's are left to the pattern's own draws.
    constexpr float wider = 1.1f;
    for (const Found& f : found) {
        if (!(f.light > 0) || !std::isfinite(f.light) || images_.size() == kMost) continue;
        Image image{(f.at.first + f.at.last) / 2,
                    (f.at.last - f.at.first) / 2,
                    float(f.light / double(f.at.area())),
                    {},
                    0};
        float pick = 0.5f;
        image.spread = spread.at(image.middle, pick);
        if (!image.spread.pattern) continue;
        image.disc_radius =
            wider * std::max(image.spread.frequency({image.half.x, 0}, kMiddle_nm).length(),
                             image.spread.frequency({0, image.half.y}, kMiddle_nm).length());
        images_.push_back(image);
    }
    if (images_.empty()) return;
    std::vector<float> lights_of;
    for (uint32_t i = 0; i < kTried; ++i) {
        const V2f film = Sampler(SamplerKind::Owen, 0, {0, 0, i}).get2(Dim::Film);
        lights_of.push_back(lights(film).sum);
    }
    const auto usual = lights_of.begin() + ptrdiff_t((1 - kBright) * float(lights_of.size() - 1));
    std::ranges::nth_element(lights_of, usual);
    usual_ = *usual;
}

auto LampImages::lights(V2f film) const -> Choice {
    constexpr int points = 3;
    Choice out;
    for (size_t i = 0; i < images_.size(); ++i) {
        const Image& image = images_[i];
        const DiffractionPattern& pattern = *image.spread.pattern;
        const V2f middle = image.frequency_from(film);
        float share = 0;
        if (StarAim::can(pattern.far(), middle, image.disc_radius)) {
            share = pattern.far_share() * StarAim(pattern.far(), middle, image.disc_radius).share();
        } else {
            for (int k = 0; k < points * points; ++k) {
                const V2f at(float(k % points) - 1, float(k / points) - 1);
                share += image.spread.density(
                    image.middle + image.half * at * (2.f / points) - film, kMiddle_nm);
            }
            share *= 4 * image.half.x * image.half.y / (points * points);
        }
        out.light[i] = std::isfinite(share) ? image.light * share : 0;
        out.sum += out.light[i];
    }
    return out;
}

auto LampImages::choice(V2f film) const -> Choice {
    Choice out = lights(film);
    out.chance = out.sum > 0 ? out.sum / (out.sum + usual_) : 0;
    return out;
}

V2f LampImages::draw(const Choice& choice, V2f film, float pick, V2f u) const {
    float left = pick / choice.chance * choice.sum;
    size_t i = 0;
    while (i + 1 < images_.size() && left >= choice.light[i]) left -= choice.light[i++];
    const Image& image = images_[i];
    const FarPattern& far = image.spread.pattern->far();
    const V2f middle = image.frequency_from(film);
    if (StarAim::can(far, middle, image.disc_radius))
        return image.spread.displacement(StarAim(far, middle, image.disc_radius).draw(u),
                                         kMiddle_nm);
    return image.middle + (u * 2.f - V2f(1.f)) * image.half - film;
}

float LampImages::density(const Choice& choice, V2f film, V2f displacement) const {
    if (!(choice.sum > 0)) return 0;
    float sum = 0;
    for (size_t i = 0; i < images_.size(); ++i) {
        const Image& image = images_[i];
        const FarPattern& far = image.spread.pattern->far();
        const V2f middle = image.frequency_from(film);
        if (StarAim::can(far, middle, image.disc_radius)) {
            const V2f v = image.spread.frequency(displacement, kMiddle_nm);
            if ((v - middle).length2() > sqr(image.disc_radius)) continue;
            sum += choice.light[i] * StarAim(far, middle, image.disc_radius).density(v) /
                   image.spread.area(kMiddle_nm);
        } else {
            const V2f off = film + displacement - image.middle;
            if (std::fabs(off.x) <= image.half.x && std::fabs(off.y) <= image.half.y)
                sum += choice.light[i] / (4 * image.half.x * image.half.y);
        }
    }
    return choice.chance * sum / choice.sum;
}

}  // namespace petzval
