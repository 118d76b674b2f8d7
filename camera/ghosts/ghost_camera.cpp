// SPDX-License-Identifier: Apache-2.0
#include "camera/ghosts/ghost_camera.h"

#include <algorithm>

#include "core/spectrum/glass.h"

namespace petzval::camera {
namespace {

/// What surfaces in front of a lamp reflect is left to the rays over all pairs, mostly.
constexpr float kEffortBesideLamp = 1.f / 16;

}  // namespace

/// A film point, and what its ghosts have in common.
struct GhostCamera::Place {
    V2f film_mm;
    const Bands& bands;
    bool shared;  ///< all lanes go along one ray
    LensIndices<f4> indices;
    f4 coats_nm, wave;
};

GhostCamera::GhostCamera(std::shared_ptr<const Camera> in_order, GhostOptics optics,
                         std::shared_ptr<const GhostDraws> draws)
    : in_order_(std::move(in_order)),
      optics_(std::move(optics)),
      draws_(std::move(draws)),
      line_d_(optics_.lens().exact_indices(splat(float(kLineD_nm)))) {}

void GhostCamera::sample_all(std::span<const FilmPoint> points, std::span<const Bands> bands,
                             std::span<CameraSample> out) const {
    if (in_order_)
        in_order_->sample_all(points, bands, out);
    else
        std::ranges::fill(out, CameraSample());
    if (optics_.pairs().empty()) return;
    for (size_t i = 0; i < points.size(); ++i) add_ghosts(points[i], bands[i], out[i]);
}

void GhostCamera::add_ghosts(const FilmPoint& point, const Bands& bands, CameraSample& out) const {
    const LensCamera& camera = optics_.camera();
    const bool shared = one_ray(bands, camera.input().dispersion);
    const f4 nm = bands.spectral ? bands.nm : splat(float(kLineD_nm));
    Place place{camera.film_mm(point.film),
                bands,
                shared,
                shared ? line_d_ : optics_.lens().indices(bands.nm),
                nm,
                f4{}};
    if (!shared)
        for (int i = 0; i < 4; ++i) place.wave[i] = wave_of(nm[i]);
    const auto [over_all, through_region] =
        draws_->draw(place.film_mm, place.wave[bands.hero], point.sampler);
    if (through_region) add_rays(place, *through_region, bands.on, kEffortBesideLamp, out);
    if (over_all) add_rays(place, *over_all, shared ? bands.on : only_lane(bands.hero), 1, out);
}

// A point that one lane's wavelength led to may have been drawn for each of them: the lanes take
// turns as heroes, and their mean density counts.
void GhostCamera::add_rays(const Place& place, const GhostDraw& drawn, m4 lanes, float effort,
                           CameraSample& out) const {
    const float rear_mm = float(optics_.rear_mm());
    if (!(drawn.rear_mm.length2() <= rear_mm * rear_mm)) return;
    const auto found = optics_.ray(optics_.pairs()[drawn.pair], place.film_mm, drawn.rear_mm,
                                   place.indices, place.coats_nm, lanes);
    if (!found) return;
    const int on = lane_count(place.bands.on);
    std::array<float, 4> waves{};
    size_t count = 0;
    for (int i = 0; i < 4; ++i)
        if (place.bands.on[i]) waves[count++] = place.wave[i];
    const float density =
        draws_->density(place.film_mm, {waves.data(), place.shared ? 1 : count}, drawn);
    const LensCamera& camera = optics_.camera();
    const float scale = camera.gain() * found->sr_per_mm2 / (density * effort) * float(on) /
                        float(lane_count(lanes));
    const auto add = [&](m4 of, int lane) {
        CameraPath& path = out.add();
        path.ray = camera.in_world(lane_of(found->ray, lane));
        path.lanes = of;
        path.weight = zero_off(of, found->share * splat(scale));
        path.mis_weight = effort;
        path.hero_decided = !place.shared;
        path.to_target = path.of_ghost = true;
    };
    if (place.shared) return add(lanes, 0);
    for (int i = 0; i < 4; ++i)
        if (found->share[i] > 0) add(only_lane(i), i);
}

}  // namespace petzval::camera
