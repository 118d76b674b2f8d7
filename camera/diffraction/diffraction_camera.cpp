// SPDX-License-Identifier: Apache-2.0
#include "camera/diffraction/diffraction_camera.h"

#include <algorithm>

namespace petzval {
namespace {

void weigh(CameraSample& sample, const f4& lanes, float mis, bool to_target) {
    for (CameraPath& path : sample) {
        path.weight *= lanes;
        path.mis_weight *= mis;
        path.to_target |= to_target;
    }
}

/// Dominant wavelengths of sRGB's primaries against D65, which stand for light in RGB.
constexpr f4 kPrimaries_nm{611.4f, 549.1f, 464.3f, 587.6f};

float lane_nm(const Bands& bands, int lane) {
    return bands.spectral ? bands.nm[lane] : kPrimaries_nm[lane];
}

}  // namespace

// Both draws find light of all lanes: a lane's light is what is seen from the displaced point,
// times the density of light aimed there to come here, over the density of the mean lane's draw and
// of the lamps' together. The first two differ by how wide cosines lie on the film here and there.
auto DiffractionCamera::displaced(const FilmPoint& at, const Bands& bands) const -> OfSample {
    const FilmSpread& spread = light_->spread;
    OfSample out{{at.film, splat(1.f), 1.f}, {}};
    float pick = at.sampler.get1(Dim::DiffractionPick);
    const auto [pattern, here] = spread.at(at.film, pick);
    if (!pattern || !(here.per_film > 0)) return out;
    const int count = lane_count(bands.on);
    const float of_lane = pick * float(count);
    int drawn = 0, left = std::min(int(of_lane), count - 1);
    const float rest = std::min(of_lane - float(left), kOneMinus);
    while (!bands.on[drawn] || left-- > 0) ++drawn;
    const V2f v = pattern->draw(rest, at.sampler.get2(Dim::Diffraction));
    static constexpr LampImages::Choice kNone;
    const LampImages::Choice& choice =
        light_->lamps.empty() ? kNone : light_->lamps.choice(at.film);
    const auto weighed = [&](V2f film) {
        Displaced moved{film, f4{}, 0};
        const StopCosines::At there = spread.cosines(film);
        f4 density{};
        for (int i = 0; i < 4; ++i) {
            if (!bands.on[i]) continue;
            const float nm = lane_nm(bands, i);
            density[i] = pattern->density(FilmSpread::frequency(here.cosines, there.cosines, nm)) *
                         FilmSpread::per_film(there, nm);
        }
        const float mean = hsum(density) / float(count);
        const float both = mean + light_->lamps.density(choice, here.cosines, film, there);
        if (!(mean > 0) || !std::isfinite(both)) return moved;
        moved.mis = mean / both;
        moved.lanes = density * splat(here.per_film / (there.per_film * mean));
        return moved;
    };
    const auto film = spread.film_of(here.cosines, v, lane_nm(bands, drawn));
    out.by_pattern = film ? weighed(*film) : Displaced{at.film, f4{}, 0};
    if (const float star = at.sampler.get1(Dim::DiffractionPick, 1); star < choice.chance)
        if (const auto place = light_->lamps.draw(choice, spread, here.cosines, star,
                                                  at.sampler.get2(Dim::Diffraction, 1)))
            out.to_lamp = weighed(*place);
    return out;
}

void DiffractionCamera::sample_all(std::span<const FilmPoint> points, std::span<const Bands> bands,
                                   std::span<CameraSample> out) const {
    std::array<FilmPoint, kMostFilmPoints> moved, to_lamps;
    std::array<OfSample, kMostFilmPoints> of;
    std::array<Bands, kMostFilmPoints> bands_to_lamps;
    std::array<size_t, kMostFilmPoints> whose{};
    size_t count = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        of[i] = displaced(points[i], bands[i]);
        moved[i] = points[i];
        moved[i].film = of[i].by_pattern.film;
        if (!of[i].to_lamp) continue;
        to_lamps[count] = points[i];
        to_lamps[count].film = of[i].to_lamp->film;
        bands_to_lamps[count] = bands[i];
        whose[count++] = i;
    }
    rays_->sample_all({moved.data(), points.size()}, bands, out);
    for (size_t i = 0; i < points.size(); ++i)
        weigh(out[i], of[i].by_pattern.lanes, of[i].by_pattern.mis, false);
    if (count == 0) return;
    std::array<CameraSample, kMostFilmPoints> stars;
    rays_->sample_all({to_lamps.data(), count}, {bands_to_lamps.data(), count},
                      {stars.data(), count});
    for (size_t k = 0; k < count; ++k) {
        const Displaced& lamp = *of[whose[k]].to_lamp;
        weigh(stars[k], lamp.lanes, lamp.mis, true);
        for (const CameraPath& path : stars[k]) out[whose[k]].add() = path;
    }
}

}  // namespace petzval
