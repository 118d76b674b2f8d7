// SPDX-License-Identifier: Apache-2.0
#include "camera/ghosts/ghost_pupils.h"

#include <algorithm>

#include "camera/ghosts/lens_face.h"
#include "core/sampling/warp.h"
#include "core/spectrum/glass.h"

namespace petzval::camera {
namespace {

/// Share of the choice of a pair that is the same for all of them, and of the points that are drawn
/// from all of the last surface.
constexpr float kEven = 0.25f, kWhole = 0.25f;
constexpr uint32_t kPupilBatches = 12, kRays = 512;
constexpr int kSteps = 4;
constexpr size_t kNearest = 24;
/// Rays that pass so many radii of the iris beside its middle still tell where it is seen; and so
/// many of the nearest, where these are fewer.
constexpr double kBeside = 1.5;

bool is_after(const GhostRegion& a, const GhostRegion& b) {
    return a.area_mm2() < b.area_mm2();
}

}  // namespace

GhostPupils::GhostPupils(const GhostOptics& optics, const RunTasks& run)
    : optics_(optics),
      line_d_(optics.lens().exact_indices(splat8(float(kLineD_nm)))),
      regions_(optics.pairs().size() * kCells),
      chances_(optics.pairs().size()) {
    run(chances_.size(), [&](size_t k) {
        for (int cell = 0; cell < kCells; ++cell)
            regions_[k * kCells + size_t(cell)] = region_of(optics.pairs()[k], cell);
        chances_[k] = light_of(uint32_t(k));
    });
    float all = 0, sum = 0;
    for (const float chance : chances_) all += chance;
    const float even = kEven / float(chances_.size());
    for (float& chance : chances_) {
        chance = all > 0 ? (1 - kEven) * chance / all + even : even / kEven;
        up_to_.push_back(sum += chance);
    }
}

int GhostPupils::cell_of(V2f film) {
    const auto cell = [](float at, int count) {
        return std::clamp(static_cast<int>(at * static_cast<float>(count)), 0, count - 1);
    };
    return cell(film.y, kDown) * kAcross + cell(film.x, kAcross);
}

V2f GhostPupils::film_mm(int cell, V2f u) const {
    return optics_.camera().film_mm((V2f(float(cell % kAcross), float(cell / kAcross)) + u) /
                                    V2f(kAcross, kDown));
}

const GhostRegion& GhostPupils::region(uint32_t pair, V2f film_mm) const {
    return regions_[pair * kCells + size_t(cell_of(optics_.camera().film_of(film_mm)))];
}

GhostRegion GhostPupils::region_of(GhostPair pair, int cell) const {
    GhostRegion best = region_at(pair, cell, 0);
    // The stop lies between the two: light crosses it three times.
    if (pair.second < optics_.lens().stop() && optics_.lens().stop() < pair.first)
        for (const int crossing : {1, 2})
            best = std::min(best, region_at(pair, cell, crossing), is_after);
    return best;
}

// At first rays through all of the last surface tell, then those close to what was found.
GhostRegion GhostPupils::region_at(GhostPair pair, int cell, int crossing) const {
    const auto rear_mm = float(optics_.rear_mm());
    GhostRegion whole{};
    whole.half = V2f(rear_mm);
    GhostRegion found = whole;
    for (int i = 0; i < kSteps; ++i) {
        const std::vector<GhostRecord> records = crossings(pair, cell, crossing, found);
        if (records.size() < 2 * kLeastRecords) break;
        found = straight_region(records).region;
    }
    return found.area_mm2() < whole.area_mm2() ? found : whole;
}

std::vector<GhostRecord> GhostPupils::crossings(GhostPair pair, int cell, int crossing,
                                                const GhostRegion& from) const {
    const LensCamera& camera = optics_.camera();
    const Lens& lens = optics_.lens();
    const double radius_mm = double(camera.input().iris.bounding_radius_mm());
    const double to_film_mm = camera.input().film_mm - lens.vertex_mm(lens.last());
    std::vector<GhostRecord> all;
    for (uint32_t batch = 0; batch < kPupilBatches; ++batch) {
        std::array<GhostRecord, 8> records{};
        LensRay<f8> ray;
        ray.counted_from = lens.last();
        for (int i = 0; i < 8; ++i) {
            const Sampler sampler(SamplerKind::Owen, 2, {0, 0, 8 * batch + uint32_t(i)});
            GhostRecord& r = records[size_t(i)];
            const V2f film = film_mm(cell, sampler.get2(Dim::Film));
            r.film_mm = V2d(film);
            // Twice as wide, so that straight lines have something to hold on to.
            r.rear_mm = V2d(from.at(film, 0, sampler.get2(Dim::Lens), 2));
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
            if (there[i] && is_finite(r.in_disc)) all.push_back(r);
        }
    }
    const auto from_middle = [](const GhostRecord& r) { return r.in_disc.length(); };
    std::ranges::stable_sort(all, {}, from_middle);
    const auto near = std::ranges::lower_bound(all, kBeside, {}, from_middle) - all.begin();
    all.resize(std::min(all.size(), std::max(size_t(near), kNearest)));
    return all;
}

float GhostPupils::light_of(uint32_t pair) const {
    const f4 line_d = splat(float(kLineD_nm));
    const LensIndices<f4> indices = optics_.lens().exact_indices(line_d);
    const auto rear_mm = float(optics_.rear_mm());
    float sum = 0;
    for (uint32_t n = 0; n < kRays; ++n) {
        const Sampler sampler(SamplerKind::Owen, 0, {int(pair), 0, n});
        const V2f film_mm = optics_.camera().film_mm(sampler.get2(Dim::Film));
        const GhostRegion& from = region(pair, film_mm);
        const V2f rear = from.at(film_mm, 0, sampler.get2(Dim::Lens));
        if (!(rear.length() <= rear_mm)) continue;
        if (const auto found =
                optics_.ray(optics_.pairs()[pair], film_mm, rear, indices, line_d, m4{-1, 0, 0, 0}))
            sum += found->share[0] * found->sr_per_mm2 * from.area_mm2();
    }
    return sum;
}

uint32_t GhostPupils::pair(float pick) const {
    const auto found = std::ranges::upper_bound(up_to_, pick) - up_to_.begin();
    return static_cast<uint32_t>(std::min(size_t(found), up_to_.size() - 1));
}

V2f GhostPupils::point_mm(uint32_t pair, V2f film_mm, V2f u) const {
    if (u.x < kWhole)
        return uniform_disk({u.x / kWhole, u.y}) * static_cast<float>(optics_.rear_mm());
    return region(pair, film_mm).at(film_mm, 0, {(u.x - kWhole) / (1 - kWhole), u.y});
}

float GhostPupils::density(V2f film_mm, const GhostDraw& drawn) const {
    const GhostRegion& from = region(drawn.pair, film_mm);
    const float within =
        from.contains(film_mm, 0, drawn.rear_mm) ? (1 - kWhole) / from.area_mm2() : 0.f;
    return kWhole / optics_.rear_mm2() + within;
}

}  // namespace petzval::camera
