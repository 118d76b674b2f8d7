// SPDX-License-Identifier: Apache-2.0
#include "camera/targets/stop_search.h"

#include <algorithm>

#include "core/sampling/warp.h"

namespace petzval::camera {
namespace {

/// Distance from a target's middle, in its radii, from which on a straight step may miss it; and
/// steps at most.
constexpr float kFar = 1;
constexpr int kCorrections = 2;

}  // namespace

void trace_landings(const StopCamera& camera, std::span<const TargetView> views,
                    std::span<const V2f> stop_mm, std::span<std::optional<V2f>> out) {
    std::array<StopPoint, 8> points;
    for (size_t i = 0; i < 8; ++i) {
        // Lanes that are left over repeat the last.
        const size_t k = std::min(i, views.size() - 1);
        points[i] = {views[k].film, stop_mm[k], views[k].nm};
    }
    const std::array<StopRay, 8> rays = rays_through(camera, points);
    for (size_t i = 0; i < views.size(); ++i) {
        out[i].reset();
        if (!rays[i].exists) continue;
        const auto parts = views[i].map->parts(rays[i]);
        f4 ray;
        for (int k = 0; k < 4; ++k) ray[k] = static_cast<float>(parts[size_t(k)]);
        out[i] = landing(ray, *views[i].target);
    }
}

void correct(const StopCamera& camera, std::span<StopSearch> searches) {
    struct Ellipse {
        StopSearch* of;
        size_t shape;
    };
    std::array<Ellipse, 8> batch;
    size_t count = 0;
    // A middle that was far off is moved by a straight step, and looked at once more.
    const auto trace = [&] {
        for (int round = 0; round < kCorrections && count > 0; ++round) {
            std::array<TargetView, 8> views;
            std::array<V2f, 8> stop_mm;
            std::array<std::optional<V2f>, 8> landed;
            for (size_t i = 0; i < count; ++i) {
                views[i] = batch[i].of->view;
                stop_mm[i] = views[i].map->stop_mm(batch[i].of->region.middle(batch[i].shape));
            }
            trace_landings(camera, {views.data(), count}, {stop_mm.data(), count},
                           {landed.data(), count});
            size_t far = 0;
            for (size_t i = 0; i < count; ++i) {
                if (!landed[i]) continue;
                batch[i].of->region.correct(batch[i].shape, *landed[i]);
                if (landed[i]->length() > kFar) batch[far++] = batch[i];
            }
            count = far;
        }
        count = 0;
    };
    for (StopSearch& search : searches) {
        for (size_t shape = 0; shape < search.region.size(); ++shape) {
            // Beyond the disc the map is not known well enough to lead anywhere near.
            if (!search.region.is_ellipse(shape) || search.region.middle(shape).length() > 1)
                continue;
            batch[count++] = {&search, shape};
            if (count == batch.size()) trace();
        }
    }
    trace();
}

FilmEllipse::FilmEllipse(const TargetView& view, V2f frame_px, V2f stop_mm, V2f landing)
    : motion_(view.map->rays_by_film(view.film), *view.target, view.map->on_disc(stop_mm)),
      landing_(landing) {
    motion_.right /= frame_px.x, motion_.down /= frame_px.y;
}

V2f FilmEllipse::sample(V2f u) const {
    return motion_.film_for(uniform_disk(u) * kCorrectedReach - landing_);
}

float FilmEllipse::density_per_px2(V2f offset_px) const {
    const V2f there = landing_ + motion_.right * offset_px.x + motion_.down * offset_px.y;
    if (!(there.length2() <= sqr(kCorrectedReach))) return 0;
    return motion_.area() / (kPi * sqr(kCorrectedReach));
}

}  // namespace petzval::camera
