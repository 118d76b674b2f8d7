// SPDX-License-Identifier: Apache-2.0
#include "camera/ghosts/ghost_pupils.h"

#include <algorithm>

#include "camera/ghosts/lens_face.h"
#include "core/sampling/warp.h"
#include "core/spectrum/glass.h"

namespace petzval {
namespace {

/// Share of the choice of a pair that is the same for all of them, and of the points that are drawn
/// from all of the last surface.
constexpr float kEven = 0.1f, kWhole = 0.25f;
constexpr uint32_t kBatches = 16, kRays = 256;
/// Rays that pass so many radii of the iris beside its middle still tell where it is seen.
constexpr double kBeside = 1.5;

bool is_after(const GhostRegion& a, const GhostRegion& b) {
    return a.area_mm2() < b.area_mm2();
}

}  // namespace

GhostPupils::GhostPupils(const GhostOptics& optics)
    : optics_(optics), line_d_(optics.lens().exact_indices(splat8(float(kLineD_nm)))) {
    float all = 0;
    for (uint32_t k = 0; k < optics.pairs().size(); ++k) {
        regions_.push_back(region_of(optics.pairs()[k]));
        chances_.push_back(light_of(k, regions_.back()));
        all += chances_.back();
    }
    float sum = 0;
    const float even = kEven / float(chances_.size());
    for (float& chance : chances_) {
        chance = all > 0 ? (1 - kEven) * chance / all + even : even / kEven;
        up_to_.push_back(sum += chance);
    }
}

GhostRegion GhostPupils::region_of(GhostPair pair) const {
    GhostRegion best = region_at(pair, 0);
    // The stop lies between the two: light crosses it three times.
    if (pair.second < optics_.lens().stop() && optics_.lens().stop() < pair.first)
        for (const int crossing : {1, 2})
            best = std::min(best, region_at(pair, crossing), is_after);
    return best;
}

// Twice: at first all rays of the last surface tell, then those close to what was found.
GhostRegion GhostPupils::region_at(GhostPair pair, int crossing) const {
    const auto rear_mm = float(optics_.rear_mm());
    GhostRegion whole{};
    whole.half = V2f(rear_mm);
    GhostRegion found = whole;
    for (int i = 0; i < 3; ++i) {
        const std::vector<GhostRecord> records = crossings(pair, crossing, found);
        if (records.size() < 2 * kLeastRecords) break;
        found = straight_region(records).region;
    }
    return found.area_mm2() < whole.area_mm2() ? found : whole;
}

std::vector<GhostRecord> GhostPupils::crossings(GhostPair pair, int crossing,
                                                const GhostRegion& from) const {
    const LensCamera& camera = optics_.camera();
    const Lens& lens = optics_.lens();
    const double radius_mm = double(camera.input().iris.bounding_radius_mm());
    const double to_film_mm = camera.input().film_mm - lens.vertex_mm(lens.last());
    std::vector<GhostRecord> all, near;
    for (uint32_t batch = 0; batch < kBatches; ++batch) {
        std::array<GhostRecord, 8> records{};
        LensRay<f8> ray;
        ray.counted_from = lens.last();
        for (int i = 0; i < 8; ++i) {
            const Sampler sampler(SamplerKind::Owen, 2, {0, 0, 8 * batch + uint32_t(i)});
            GhostRecord& r = records[size_t(i)];
            const V2f film_mm = camera.film_mm(sampler.get2(Dim::Film));
            r.film_mm = V2d(film_mm);
            // Twice as wide, so that straight lines have something to hold on to.
            r.rear_mm = V2d(from.at(film_mm, 0, sampler.get2(Dim::Lens), 2));
            const double beyond = r.rear_mm.length() / optics_.rear_mm();
            if (beyond > 1) r.rear_mm /= beyond;
            const auto face = face_point(lens, lens.last(), r.rear_mm);
            if (!face) return {};
            const V3d way =
                (face->point_mm - V3d(r.film_mm.x, r.film_mm.y, to_film_mm)).normalized();
            ray.origin.x[i] = float(face->point_mm.x), ray.origin.y[i] = float(face->point_mm.y),
            ray.origin.z[i] = float(face->point_mm.z);
            ray.direction.x[i] = float(way.x), ray.direction.y[i] = float(way.y),
            ray.direction.z[i] = float(way.z);
        }
        int count = 0;
        m8 there{};
        const auto observe = [&](const LensHit<f8>& hit, const GhostStep&) {
            if (hit.surface != lens.stop() || count++ != crossing) return;
            there = hit.reached;
            for (int i = 0; i < 8; ++i)
                records[size_t(i)].in_disc =
                    V2d(double(hit.point.x[i]), double(hit.point.y[i])) / radius_mm;
        };
        static_cast<void>(
            trace_ghost<f8>(lens, pair, Towards::Scene, Clip::No, line_d_, ray, observe));
        for (int i = 0; i < 8; ++i) {
            const GhostRecord& r = records[size_t(i)];
            if (!there[i] || !is_finite(r.in_disc)) continue;
            all.push_back(r);
            if (r.in_disc.length() < kBeside) near.push_back(r);
        }
    }
    return near.size() >= 2 * kLeastRecords ? near : all;
}

float GhostPupils::light_of(uint32_t pair, const GhostRegion& region) const {
    const f4 line_d = splat(float(kLineD_nm));
    const LensIndices<f4> indices = optics_.lens().exact_indices(line_d);
    const auto rear_mm = float(optics_.rear_mm());
    float sum = 0;
    for (uint32_t n = 0; n < kRays; ++n) {
        const Sampler sampler(SamplerKind::Owen, 0, {int(pair), 0, n});
        const V2f film_mm = optics_.camera().film_mm(sampler.get2(Dim::Film));
        const V2f rear = region.at(film_mm, 0, sampler.get2(Dim::Lens));
        if (!(rear.length() <= rear_mm)) continue;
        if (const auto found =
                optics_.ray(optics_.pairs()[pair], film_mm, rear, indices, line_d, m4{-1, 0, 0, 0}))
            sum += found->share[0] * found->sr_per_mm2 * region.area_mm2();
    }
    return sum;
}

GhostDraw GhostPupils::draw(V2f film_mm, float pick, V2f u) const {
    const auto pair = std::min(size_t(std::ranges::upper_bound(up_to_, pick) - up_to_.begin()),
                               up_to_.size() - 1);
    const auto number = static_cast<uint32_t>(pair);
    if (u.x < kWhole)
        return {number, uniform_disk({u.x / kWhole, u.y}) * static_cast<float>(optics_.rear_mm())};
    return {number, regions_[pair].at(film_mm, 0, {(u.x - kWhole) / (1 - kWhole), u.y})};
}

float GhostPupils::density(V2f film_mm, const GhostDraw& drawn) const {
    const GhostRegion& region = regions_[drawn.pair];
    const float within =
        region.contains(film_mm, 0, drawn.rear_mm) ? (1 - kWhole) / region.area_mm2() : 0.f;
    return chances_[drawn.pair] * (kWhole / optics_.rear_mm2() + within);
}

}  // namespace petzval
