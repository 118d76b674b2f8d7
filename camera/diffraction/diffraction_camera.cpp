// SPDX-License-Identifier: Apache-2.0
#include "camera/diffraction/diffraction_camera.h"

#include <algorithm>

namespace petzval {
namespace {

/// Displacement, in frames, up to which the pupil is as good as the same.
constexpr float kSamePupil = 1.f / 256;

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
// of the lamps' together.
auto DiffractionCamera::displaced(const FilmPoint& at, const Bands& bands) const -> OfSample {
    OfSample out{{at.film, splat(1.f), 1.f}, {}};
    const float node = at.sampler.get1(Dim::DiffractionPick);
    float pick = node;
    const SpreadHere here = light_->spread.at(at.film, pick);
    if (!here.pattern) return out;
    const int count = lane_count(bands.on);
    const float of_lane = pick * float(count);
    int drawn = 0, left = std::min(int(of_lane), count - 1);
    const float rest = std::min(of_lane - float(left), kOneMinus);
    while (!bands.on[drawn] || left-- > 0) ++drawn;
    const V2f v = here.pattern->draw(rest, at.sampler.get2(Dim::Diffraction));
    static constexpr LampImages::Choice kNone;
    const LampImages::Choice& choice =
        light_->lamps.empty() ? kNone : light_->lamps.choice(at.film);
    const auto densities = [&](const SpreadHere& spread, V2f by) {
        f4 of_lanes{};
        for (int i = 0; i < 4; ++i)
            if (bands.on[i]) of_lanes[i] = spread.density(by, lane_nm(bands, i));
        return of_lanes;
    };
    const auto weighed = [&](V2f by) {
        Displaced there{at.film + by, f4{}, 0};
        const f4 drawn_so = densities(here, by);
        const float mean = hsum(drawn_so) / float(count);
        const float both = mean + light_->lamps.density(choice, at.film, by);
        if (!(both > 0) || !std::isfinite(both)) return there;
        f4 aimed_there = drawn_so;
        if (std::max(std::fabs(by.x), std::fabs(by.y)) > kSamePupil) {
            float again = node;
            const SpreadHere pupil = light_->spread.at(there.film, again);
            if (!pupil.pattern) return there;
            aimed_there = densities(pupil, by);
        }
        // Layers and coverage do without the lamps' share.
        there.mis = mean > 0 ? mean / both : 1;
        there.lanes = aimed_there / splat(both * there.mis);
        return there;
    };
    out.by_pattern = weighed(here.displacement(v, lane_nm(bands, drawn)));
    if (const float star = at.sampler.get1(Dim::DiffractionPick, 1); star < choice.chance)
        out.to_lamp = weighed(
            light_->lamps.draw(choice, at.film, star, at.sampler.get2(Dim::Diffraction, 1)));
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
