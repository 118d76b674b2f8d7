// SPDX-License-Identifier: Apache-2.0
#include "camera/diffraction/diffraction_camera.h"

#include <algorithm>

namespace petzval::camera {
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
    const auto film = spread.film_of(here.cosines, v, lane_nm(bands, drawn));
    const float shared = light_->shared;
    if (v.length2() < sqr(shared)) {
        if (film) out.by_pattern.film = *film;
    } else {
        out.by_pattern = {at.film, f4{}, 0, true};
    }
    const auto weighed = [&](V2f place) {
        Displaced moved{place, f4{}, 0, true};
        const StopCosines::At there = spread.cosines(place);
        f4 density{};
        for (int i = 0; i < 4; ++i) {
            if (!bands.on[i]) continue;
            const float nm = lane_nm(bands, i);
            const V2f by = FilmSpread::frequency(here.cosines, there.cosines, nm);
            if (by.length2() < sqr(shared)) continue;
            density[i] = pattern->density(by) * FilmSpread::per_film(there, nm);
        }
        const float mean = hsum(density) / float(count);
        const float both = mean + light_->lamps.density(choice, here.cosines, place, there);
        if (!(mean > 0) || !std::isfinite(both)) return moved;
        moved.mis = mean / both;
        moved.lanes = density * splat(here.per_film / (there.per_film * mean));
        return moved;
    };
    if (out.by_pattern.is_far && film) out.by_pattern = weighed(*film);
    if (const float star = at.sampler.get1(Dim::DiffractionPick, 1); star < choice.chance)
        if (const auto place = light_->lamps.draw(choice, spread, here.cosines, star,
                                                  at.sampler.get2(Dim::Diffraction, 1)))
            out.to_lamp = weighed(*place);
    return out;
}

void DiffractionCamera::sample_all(std::span<const FilmPoint> points, std::span<const Bands> bands,
                                   std::span<CameraSample> out) const {
    // A batch of film points, those whose samples it finds, and what they are displaced by.
    struct Part {
        std::array<FilmPoint, kMostFilmPoints> points;
        std::array<Bands, kMostFilmPoints> bands;
        std::array<size_t, kMostFilmPoints> whose;
        std::array<Displaced, kMostFilmPoints> moved;
        size_t count = 0;

        void add(const FilmPoint& point, const Bands& of, size_t i, const Displaced& by) {
            points[count] = point, bands[count] = of, whose[count] = i, moved[count] = by;
            points[count++].film = by.film;
        }
    };
    Part near, far, stars;
    for (size_t i = 0; i < points.size(); ++i) {
        const OfSample of = displaced(points[i], bands[i]);
        (of.by_pattern.is_far ? far : near).add(points[i], bands[i], i, of.by_pattern);
        if (of.to_lamp) stars.add(points[i], bands[i], i, *of.to_lamp);
    }
    for (const Part* part : {&near, &far, &stars}) {
        if (part->count == 0) continue;
        std::array<CameraSample, kMostFilmPoints> found;
        (part == &near ? rays_ : far_)
            ->sample_all({part->points.data(), part->count}, {part->bands.data(), part->count},
                         {found.data(), part->count});
        for (size_t k = 0; k < part->count; ++k) {
            const Displaced& by = part->moved[k];
            weigh(found[k], by.lanes, by.mis, part == &stars);
            CameraSample& sample = out[part->whose[k]];
            if (part == &stars)
                for (const CameraPath& path : found[k]) sample.add() = path;
            else
                sample = found[k];
        }
    }
}

float shared_frequency(const FilmSpread& spread, V2i frame_px) {
    constexpr float shared_px = 1.f / 3;
    const float px = 1 / std::sqrt(float(frame_px.x) * float(frame_px.y));
    return shared_px * px * std::sqrt(FilmSpread::per_film(spread.cosines(V2f(0.5f)), kMiddle_nm));
}

}  // namespace petzval::camera
