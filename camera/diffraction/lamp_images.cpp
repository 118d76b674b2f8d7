// SPDX-License-Identifier: Apache-2.0
#include "camera/diffraction/lamp_images.h"

#include <algorithm>
#include <cmath>

#include "camera/diffraction/star_aim.h"
#include "camera/ray_bundle.h"
#include "camera/setup/film_region.h"
#include "camera/targets/target_grid.h"
#include "core/sampling/prepass_seed.h"
#include "core/sampling/sampler.h"

namespace petzval::camera {
namespace {

/// Cells of the search across the frame, and how far beyond it they go, in frames.
constexpr int kCells = 24, kBeyond = kCells / 2;
/// Rays of a cell that tell which lamps it may see, and the margin for what lies between them.
constexpr int kRays = 32;
constexpr float kMargin = 0.5f;
/// Share of the frame's film points whose stars are so bright that every second sample looks for
/// them, at least.
constexpr float kBright = 0.1f;
/// Cells of choices: their size, how many there may be across, and points tried in each.
constexpr int kCell_px = 4, kMostChoices = 256;
constexpr uint32_t kTried = 3;

/// Pixels so fine that no filter reaches beyond an image.
constexpr int kFine_px = 1 << 24;
/// Ratio of luminances up to which things that overlap are parts of one lamp.
constexpr double kAlike = 3;

bool overlap(const FilmCell& a, const FilmCell& b) {
    return a.first.x < b.last.x && b.first.x < a.last.x && a.first.y < b.last.y &&
           b.first.y < a.last.y;
}
FilmCell around(const FilmCell& a, const FilmCell& b) {
    return {{std::min(a.first.x, b.first.x), std::min(a.first.y, b.first.y)},
            {std::max(a.last.x, b.last.x), std::max(a.last.y, b.last.y)}};
}

/// A lamp on the film.
struct LampOnFilm {
    FilmCell at;
    double light = 0;  ///< share of rays that meet it, by area of the film, and its luminance
    double nits = 0;
};

/// Lamps on the film and around it, the brightest first.
std::vector<LampOnFilm> lamps_on_film(const TargetCamera& aims,
                                      std::span<const SmallFeature> lamps) {
    std::vector<LampOnFilm> found(lamps.size());
    for (size_t n = 0; n < lamps.size(); ++n) found[n].nits = lamps[n].radiance;
    for (int j = -kBeyond; j < kCells + kBeyond; ++j)
        for (int i = -kBeyond; i < kCells + kBeyond; ++i) {
            const FilmCell cell{V2f(float(i), float(j)) / float(kCells),
                                V2f(float(i + 1), float(j + 1)) / float(kCells)};
            const RayBundle bundle =
                bundle_of(aims, cell, number_of(PrepassSeed::TargetCells), {i, j}, kRays);
            std::shared_ptr<const StopMap> map;
            for (size_t n = 0; n < lamps.size(); ++n) {
                if (!passes(bundle, lamps[n], kMargin)) continue;
                if (!map && !(map = aims.map(cell))) break;
                const auto seen = aims.listed(target_of(lamps[n]), *map, V2i(kFine_px));
                if (!seen) continue;
                const FilmCell part = seen->seen_from.within(cell);
                if (!(part.area() > 0)) continue;
                LampOnFilm& f = found[n];
                f.at = f.light > 0 ? around(f.at, part) : part;
                f.light += double(seen->met) * double(part.area()) * f.nits;
            }
        }
    std::erase_if(found,
                  [](const LampOnFilm& f) { return !(f.light > 0) || !std::isfinite(f.light); });
    std::ranges::stable_sort(
        found, [](const LampOnFilm& a, const LampOnFilm& b) { return a.light > b.light; });
    return found;
}

/// The same with the parts of one lamp, which have one star, put together.
std::vector<LampOnFilm> whole(std::vector<LampOnFilm> found) {
    for (size_t n = 0; n < found.size(); ++n)
        for (size_t m = n + 1; m < found.size();) {
            LampOnFilm &a = found[n], &b = found[m];
            if (overlap(a.at, b.at) &&
                std::max(a.nits, b.nits) < kAlike * std::min(a.nits, b.nits)) {
                a.at = around(a.at, b.at);
                a.light += b.light;
                found.erase(found.begin() + ptrdiff_t(m));
                m = n + 1;
            } else {
                ++m;
            }
        }
    return found;
}

}  // namespace

LampImages::LampImages(const TargetCamera& aims, V2i frame_px, std::span<const SmallFeature> lamps,
                       const FilmSpread& spread) {
    // Corners of a box that are no lamp's are left to the pattern's own draws.
    constexpr float wider = 1.1f;
    for (const LampOnFilm& lamp : whole(lamps_on_film(aims, lamps))) {
        if (images_.size() == kMost) break;
        const V2f half = (lamp.at.last - lamp.at.first) / 2;
        float pick = 0.5f;
        const SpreadHere here = spread.at(lamp.at.first + half, pick);
        if (!here.pattern) continue;
        const auto away = [&](V2f by) {
            const V2f edge = spread.cosines(lamp.at.first + half + by).cosines;
            return FilmSpread::frequency(here.here.cosines, edge, kMiddle_nm).length();
        };
        images_.push_back({lamp.at.first + half, half, float(lamp.light / double(lamp.at.area())),
                           here, wider * std::max(away({half.x, 0}), away({0, half.y}))});
    }
    if (!images_.empty()) find_choices(frame_px, spread);
}

void LampImages::find_choices(V2i frame_px, const FilmSpread& spread) {
    const auto cells = [](int px) { return std::clamp(px / kCell_px, 1, kMostChoices); };
    cells_ = {cells(frame_px.x), cells(frame_px.y)};
    choices_.resize(size_t(cells_.x) * size_t(cells_.y));
    for (size_t k = 0; k < choices_.size(); ++k)
        for (uint32_t i = 0; i < kTried; ++i) {
            const V2f in_cell = Sampler(SamplerKind::Owen, 0, {0, int(k), i}).get2(Dim::Film);
            const V2f cell(float(k % size_t(cells_.x)), float(k / size_t(cells_.x)));
            add_lights((cell + in_cell) / V2f(cells_), spread, choices_[k]);
        }
    std::vector<float> sums;
    for (const Choice& c : choices_) sums.push_back(c.sum);
    const auto bright = sums.begin() + ptrdiff_t((1 - kBright) * float(sums.size() - 1));
    std::ranges::nth_element(sums, bright);
    for (Choice& c : choices_) c.chance = c.sum > 0 ? c.sum / (c.sum + *bright) : 0;
}

void LampImages::add_lights(V2f film, const FilmSpread& spread, Choice& out) const {
    constexpr int points = 8;
    const V2f here = spread.cosines(film).cosines;
    for (size_t i = 0; i < images_.size(); ++i) {
        const Image& image = images_[i];
        const DiffractionPattern& pattern = *image.spread.pattern;
        const V2f middle = FilmSpread::frequency(here, image.spread.here.cosines, kMiddle_nm);
        float share = 0;
        if (const auto aim = StarAim::at(pattern.far(), middle, image.disc_radius)) {
            share = pattern.far_share() * aim->share();
        } else {
            const float side = 2 * image.disc_radius / points;
            for (int k = 0; k < points * points; ++k) {
                const V2f at(float(k % points) + 0.5f, float(k / points) + 0.5f);
                share += pattern.density(middle + at * side - V2f(image.disc_radius)) * sqr(side);
            }
        }
        if (!std::isfinite(share)) continue;
        out.light[i] += image.light * share;
        out.sum += image.light * share;
    }
}

std::optional<V2f> LampImages::draw(const Choice& choice, const FilmSpread& spread, V2f cosines,
                                    float pick, V2f u) const {
    float left = pick / choice.chance * choice.sum;
    size_t i = 0;
    while (i + 1 < images_.size() && left >= choice.light[i]) left -= choice.light[i++];
    const Image& image = images_[i];
    const FarPattern& far = image.spread.pattern->far();
    const V2f middle = FilmSpread::frequency(cosines, image.spread.here.cosines, kMiddle_nm);
    if (const auto aim = StarAim::at(far, middle, image.disc_radius))
        return spread.film_of(cosines, aim->draw(u), kMiddle_nm);
    return image.middle + (u * 2.f - V2f(1.f)) * image.half;
}

float LampImages::density(const Choice& choice, V2f cosines, V2f place,
                          const StopCosines::At& there) const {
    if (!(choice.sum > 0)) return 0;
    float sum = 0;
    for (size_t i = 0; i < images_.size(); ++i) {
        const Image& image = images_[i];
        // A disc is wider than its image by little.
        constexpr float beside = 4;
        const V2f to = place - image.middle;
        if (std::fabs(to.x) > beside * image.half.x && std::fabs(to.y) > beside * image.half.y)
            continue;
        const FarPattern& far = image.spread.pattern->far();
        const V2f middle = FilmSpread::frequency(cosines, image.spread.here.cosines, kMiddle_nm);
        if (const auto aim = StarAim::at(far, middle, image.disc_radius))
            sum += choice.light[i] *
                   aim->density(FilmSpread::frequency(cosines, there.cosines, kMiddle_nm)) *
                   FilmSpread::per_film(there, kMiddle_nm);
        else if (std::fabs(to.x) <= image.half.x && std::fabs(to.y) <= image.half.y)
            sum += choice.light[i] / (4 * image.half.x * image.half.y);
    }
    return choice.chance * sum / choice.sum;
}

}  // namespace petzval::camera
