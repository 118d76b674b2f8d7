// SPDX-License-Identifier: Apache-2.0
#include "camera/bench/light_walk.h"

#include <algorithm>
#include <cmath>

#include "camera/lens/trace.h"

namespace petzval::camera {
namespace {

V3d lane_of(const Vec3<d4>& v, int lane) {
    return {v.x[lane], v.y[lane], v.z[lane]};
}

}  // namespace

LightWalk::LightWalk(const Lens& lens, const LensCoats& coats, double nm)
    : lens_(lens), coats_(coats), nm_(nm), indices_(lens.exact_indices(broadcast<d4>(nm))) {
    for (const Glass& glass : lens.media()) absorption_per_mm_.push_back(glass.absorption(nm));
}

LightMeeting LightWalk::meet(const LightRay& in) const {
    LightMeeting out;
    out.point_mm = in.origin_mm;
    out.passed.share = out.reflected.share = 0;
    const bool to_film = in.towards == Towards::Film;
    if (in.reflections > 0 && (in.direction.z > 0) != to_film) {
        out.stopped = in.share;
        return out;
    }
    const auto& surface = lens_.surfaces<double>()[size_t(in.next)];
    const int from = to_film ? surface.medium_before : surface.medium_after;
    const int into = to_film ? surface.medium_after : surface.medium_before;
    // Lane 0 is refracted. Lane 1 is reflected: as if refracted into an index of the other sign,
    // which gives the ray along its line backwards (Welford 1986, Aberrations of Optical Systems,
    // ch. 4).
    LensIndices<d4> indices;
    indices.of_medium[from] = indices_.of_medium[from];
    indices.of_medium[into] = indices_.of_medium[into];
    if (from != into) indices.of_medium[into][1] = -indices_.of_medium[from][1];
    LensRay<d4> ray;
    const double vertex_mm = lens_.vertex_mm(in.next);
    const auto lanes = [](const V3d& v) {
        return Vec3<d4>{broadcast<d4>(v.x), broadcast<d4>(v.y), broadcast<d4>(v.z)};
    };
    ray.counted_from = in.next;
    ray.origin = lanes(in.origin_mm - V3d(0, 0, vertex_mm));
    ray.direction = lanes(in.direction);
    double cosine = 0, distance_mm = 0;
    const auto observe = [&](const LensHit<d4>& hit) {
        if (!hit.reached[0]) return;
        cosine = hit.cosine[0], distance_mm = hit.distance_mm[0];
        out.point_mm = lane_of(hit.point, 0) + V3d(0, 0, vertex_mm);
    };
    static_cast<void>(
        trace_lens<d4>({lens_, in.towards, {in.next, in.next}, Clip::Yes}, indices, ray, observe));
    const double arrived =
        in.share * std::exp(-absorption_per_mm_[size_t(from)] * std::max(distance_mm, 0.));
    out.absorbed = in.share - arrived;
    if (ray.status(1) != RayStatus::Passed) {
        out.stopped = arrived;
        return out;
    }
    SurfaceShares shares =
        coats_.at(in.next, in.towards,
                  {indices_.of_medium[from][0], indices_.of_medium[into][0], cosine, nm_});
    if (ray.status(0) != RayStatus::Passed)
        shares.reflected += std::exchange(shares.transmitted, 0);
    out.absorbed += arrived * shares.absorbed();
    const auto goes_on = [&](int lane, double share) {
        LightRay next = in;
        next.origin_mm = out.point_mm;
        next.direction = lane_of(ray.direction, lane) * (lane == 1 ? -1. : 1.);
        next.share = arrived * share;
        next.next += (to_film ? 1 : -1) * (lane == 1 ? -1 : 1);
        return next;
    };
    out.passed = goes_on(0, shares.transmitted);
    out.reflected = goes_on(1, shares.reflected);
    out.reflected.towards = to_film ? Towards::Scene : Towards::Film;
    if (in.reflections < 2) out.reflected.mirrors[size_t(in.reflections)] = in.next;
    ++out.reflected.reflections;
    return out;
}

void LightWalk::follow(const LightRay& ray, const std::function<void(const LightEnd&)>& end,
                       bool beyond_two) {
    open_.assign(1, ray);
    while (!open_.empty()) {
        const LightRay next = open_.back();
        open_.pop_back();
        follow_one(next, end, beyond_two);
    }
}

void LightWalk::follow_one(LightRay ray, const std::function<void(const LightEnd&)>& end,
                           bool beyond_two) {
    const auto tell = [&](LightFate fate, double share) {
        if (!(share > 0)) return;
        LightRay at = ray;
        at.share = share;
        end({fate, at});
    };
    while (ray.share > 0) {
        if (ray.next < 0) return tell(LightFate::BeforeLens, ray.share);
        if (ray.next > lens_.last())
            return tell(ray.direction.z > 0 ? LightFate::BehindLens : LightFate::Stopped,
                        ray.share);
        LightMeeting met = meet(ray);
        tell(LightFate::Absorbed, met.absorbed);
        tell(LightFate::Stopped, met.stopped);
        LightRay& passed = met.passed;
        LightRay& reflected = met.reflected;
        if (met.stopped > 0) return;
        if (ray.reflections < 2) {
            if (reflected.share > 0) open_.push_back(reflected);
        } else if (ray.reflections == 2) {
            waiting_ += beyond_two ? reflected.share : 0;
            if (waiting_ >= kShareAtOnce) {
                reflected.share = std::floor(waiting_ / kShareAtOnce) * kShareAtOnce;
                waiting_ -= reflected.share;
                open_.push_back(reflected);
            }
        } else {
            const double both = passed.share + reflected.share;
            const bool passes = random_() * 0x1p-32 * both < passed.share;
            ray = passes ? passed : reflected;
            ray.share = both;
            continue;
        }
        ray = passed;
    }
}

}  // namespace petzval::camera
