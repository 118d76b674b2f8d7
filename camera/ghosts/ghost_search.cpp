// SPDX-License-Identifier: Apache-2.0
#include "camera/ghosts/ghost_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "camera/ghosts/lens_face.h"
#include "core/sampling/warp.h"
#include "core/spectrum/glass.h"

namespace petzval::camera {
namespace {

/// Parts of the first surface along its diameter. Batches of eight rays through each that tell its
/// region; and that tell whether any light passes, of a part of the whole.
constexpr int kParts = 8;
constexpr uint32_t kBatches = 4, kFirstBatches = 32;
/// A part is divided in four, so many times at most, where few of the points of its region see the
/// lamp: fewer than a share; the last times, fewer than another. And at first where few of its rays
/// pass all rims.
constexpr int kDivisions = 6, kLastDivisions = 1, kDivisionsByRims = 2;
constexpr double kBad = 0.02;
/// After some divisions more come only where the last made a region so many times as good.
constexpr double kHelps = 1;
constexpr int kTried = 3;

/// Square of the first surface, across the axis.
struct Part {
    V2d corner_mm;
    double side_mm;
};

/// Rays of a lamp by way of a pair.
class LampRays {
  public:
    LampRays(const GhostOptics& optics, const std::vector<LampDraws>& draws, uint32_t pair,
             const GhostLamp& lamp)
        : optics_(optics),
          lens_(optics.lens()),
          draws_(draws),
          pair_(optics.pairs()[pair]),
          lamp_(lamp),
          reach_mm_(lens_.prescription().surfaces.front().semi_diameter_mm) {
        const V3d to_lamp = lamp.centre_mm / lamp.centre_mm.length();
        const V3d beside = std::fabs(to_lamp.x) < 0.9 ? V3d(1, 0, 0) : V3d(0, 1, 0);
        constexpr double kBeyond = 0.55;
        reach_of_film_ =
            V2d(optics.camera().input().film_width_mm, optics.camera().input().film_height_mm) *
            kBeyond;
        across_ = to_lamp.cross(beside).normalized();
        along_ = to_lamp.cross(across_);
    }
    /// Rays through a square of the first surface; none where it lies beside.
    /// Clip::Yes: only those that no rim stops.
    [[nodiscard]] std::vector<GhostRecord> through(const Part& part, uint32_t batches,
                                                   Clip clip) const {
        std::vector<GhostRecord> out;
        const double half = part.side_mm / 2;
        if ((part.corner_mm + V2d(half)).length() > reach_mm_ + 1.5 * half) return out;
        for (uint32_t batch = 0; batch < batches; ++batch) trace(part, draws_[batch], clip, out);
        for (GhostRecord& r : out) r.light_mm2 /= 8 * batches;
        return out;
    }
    [[nodiscard]] Part whole() const { return {V2d(-reach_mm_), 2 * reach_mm_}; }

  private:
    void trace(const Part&, const LampDraws&, Clip, std::vector<GhostRecord>&) const;

    const GhostOptics& optics_;
    const Lens& lens_;
    const std::vector<LampDraws>& draws_;
    GhostPair pair_;
    GhostLamp lamp_;
    double reach_mm_;
    V2d reach_of_film_;  ///< and a little beyond
    V3d across_, along_;
};

void LampRays::trace(const Part& part, const LampDraws& draws, Clip clip,
                     std::vector<GhostRecord>& out) const {
    LensRay<f8> ray;
    std::array<float, 8> enters{};
    for (int i = 0; i < 8; ++i) {
        const V2d at = part.corner_mm + draws.in_part[size_t(i)] * part.side_mm;
        const V2d on_lamp = draws.on_lamp[size_t(i)];
        ray.direction.z[i] = 1;
        const auto face = at.length() <= reach_mm_ ? face_point(lens_, 0, at) : std::nullopt;
        if (!face) continue;
        const V3d off = (across_ * on_lamp.x + along_ * on_lamp.y) * lamp_.radius_mm;
        V3d d =
            lamp_.at_infinity ? -(lamp_.centre_mm + off) : face->point_mm - (lamp_.centre_mm + off);
        d.normalize();
        const double cosine = d.dot(face->normal);
        if (!(cosine > 0)) continue;
        enters[size_t(i)] = float(cosine / face->normal.z);
        ray.origin.x[i] = float(face->point_mm.x), ray.origin.y[i] = float(face->point_mm.y),
        ray.origin.z[i] = float(face->point_mm.z);
        ray.direction.x[i] = float(d.x), ray.direction.y[i] = float(d.y),
        ray.direction.z[i] = float(d.z);
    }
    f8 inside{};
    for (int i = 0; i < 8; ++i) inside[i] = enters[size_t(i)] > 0 ? 1.f : 0.f;
    PlanePoint<f8> rear(f8{}, f8{});
    const auto observe = [&](const LensHit<f8>& hit, const GhostStep&) {
        const f8 &x = hit.point.x, &y = hit.point.y;
        const float rim2 = lens_.surfaces<float>()[size_t(hit.surface)].semi_diameter2_mm2;
        inside = x * x + y * y <= rim2 ? inside : f8{};
        if (hit.surface == lens_.last()) rear.x = x, rear.y = y;
        if (hit.surface != lens_.stop()) return;
        for (int i = 0; i < 8; ++i)
            if (inside[i] > 0) inside[i] *= optics_.camera().optics().transmits({x[i], y[i]});
    };
    const m8 passed =
        trace_ghost<f8>(lens_, pair_, Towards::Film, clip, draws.indices, ray, observe);
    const double z_mm = optics_.camera().input().film_mm - lens_.vertex_mm(lens_.last());
    for (int i = 0; i < 8; ++i) {
        if (!passed[i] || !(enters[size_t(i)] > 0) || !(ray.direction.z[i] > 0)) continue;
        const double t = (z_mm - double(ray.origin.z[i])) / double(ray.direction.z[i]);
        const V2d film(double(ray.origin.x[i]) + t * double(ray.direction.x[i]),
                       double(ray.origin.y[i]) + t * double(ray.direction.y[i]));
        const V2d at_rear(double(rear.x[i]), double(rear.y[i]));
        if (!is_finite(film) || at_rear.length() > 2 * optics_.rear_mm()) continue;
        const bool on_film =
            std::fabs(film.x) < reach_of_film_.x && std::fabs(film.y) < reach_of_film_.y;
        const double enters_mm2 =
            on_film ? double(enters[size_t(i)] * inside[i]) * part.side_mm * part.side_mm : 0;
        out.push_back(
            {film, at_rear, draws.on_lamp[size_t(i)], double(wave_of(draws.nm[i])), enters_mm2});
    }
}

/// Search of one pair's regions.
class PairSearch {
  public:
    /// unit: light on the film for each mm^2 of light that enters.
    PairSearch(const GhostOptics& optics, const LampRays& rays, uint32_t pair, double unit,
               int most_parts)
        : rays_(rays),
          pair_(pair),
          unit_(unit),
          rear_mm_(float(optics.rear_mm())),
          most_parts_(most_parts) {
        const V2f corner = optics.camera().film_mm(V2f(0.f));
        film_ = {std::fabs(corner.x), std::fabs(corner.y)};
    }
    /// How a square is searched: in count x count parts, each divided so many times at most.
    struct Level {
        int count, divisions;
        uint32_t batches;  ///< of rays that tell whether light passes a part
        double saw = 0;    ///< share of the points that saw the lamp, of the region of the square
    };
    /// Finds the regions of a square.
    void find(const Part& whole, const Level&);
    [[nodiscard]] GhostSearch::Found found() && { return std::move(found_); }

  private:
    [[nodiscard]] bool meets_film(const GhostRegion& r) const {
        return r.film_low.x <= film_.x && r.film_high.x >= -film_.x && r.film_low.y <= film_.y &&
               r.film_high.y >= -film_.y;
    }

    /// Region where a few rays reach the film and too few of those beside them exist to tell where:
    /// the whole of the last surface, for film points about theirs.
    [[nodiscard]] GhostRegion around(const std::vector<V2d>& lit_mm) const {
        constexpr float kAbout = 0.1f;  // of the film's half size
        GhostRegion out{};
        out.film_low = out.film_high = out.film = V2f(lit_mm[0]);
        for (const V2d& p : lit_mm) {
            out.film_low = {std::min(out.film_low.x, float(p.x)),
                            std::min(out.film_low.y, float(p.y))};
            out.film_high = {std::max(out.film_high.x, float(p.x)),
                             std::max(out.film_high.y, float(p.y))};
        }
        out.film_low -= film_ * kAbout, out.film_high += film_ * kAbout;
        out.half = V2f(rear_mm_);
        return out;
    }

    const LampRays& rays_;
    uint32_t pair_;
    double unit_;
    float rear_mm_;
    int most_parts_;
    V2f film_;
    GhostSearch::Found found_;
};

void PairSearch::find(const Part& whole, const Level& level) {
    const auto [count, divisions, batches, saw] = level;
    const double side = whole.side_mm / count;
    const auto part_of = [&, n = count](int k) {
        return Part{whole.corner_mm + V2d(k % n, k / n) * side, side};
    };
    std::vector<double> light_mm2;
    std::vector<std::vector<V2d>> lit_mm;  // film points that the light reaches
    for (int k = 0; k < count * count; ++k) {
        light_mm2.push_back(0), lit_mm.emplace_back();
        for (const GhostRecord& r : rays_.through(part_of(k), batches, Clip::Yes)) {
            light_mm2.back() += r.light_mm2;
            if (r.light_mm2 > 0) lit_mm.back().push_back(r.film_mm);
        }
    }
    const auto light_near = [&, n = count](int k) {
        double near = 0;
        for (int j = std::max(k / n - 1, 0); j <= std::min(k / n + 1, n - 1); ++j)
            for (int i = std::max(k % n - 1, 0); i <= std::min(k % n + 1, n - 1); ++i)
                near = std::max(near, light_mm2[size_t(j * n + i)]);
        return near;
    };
    for (int k = 0; k < count * count; ++k) {
        ++found_.parts;
        const double near = light_near(k), light = light_mm2[size_t(k)];
        if (!(near > 0)) continue;
        const std::vector<GhostRecord> records = rays_.through(part_of(k), kBatches, Clip::No);
        const bool tells = records.size() >= kLeastRecords;
        auto [region, sees, open] = tells ? straight_region(records) : StraightRegion{};
        const bool by_rims = open < kSeesEnough && divisions > kDivisions - kDivisionsByRims;
        const bool is_bad = sees < (divisions > kLastDivisions ? kSeesEnough : kBad);
        if (divisions > 0 && light > 0 && found_.parts < most_parts_ &&
            ((is_bad && (divisions > kDivisions - kTried || sees > kHelps * saw)) || by_rims)) {
            const size_t before = found_.regions.size();
            // As many rays as it takes to meet the light again.
            const double rays = 8. * batches / double(lit_mm[size_t(k)].size());
            find(part_of(k),
                 {2, divisions - 1, std::clamp(uint32_t(rays / 4), kBatches, kFirstBatches), sees});
            if (found_.regions.size() > before)
                continue;  // else its rays slip through between others
        }
        if (!tells || !meets_film(region)) {
            if (!(light > 0)) continue;
            region = around(lit_mm[size_t(k)]);
        }
        region.pair = pair_;
        // Of the part of its film points that the film has: the light counts there alone.
        const V2f low(std::max(region.film_low.x, -film_.x), std::max(region.film_low.y, -film_.y)),
            high(std::min(region.film_high.x, film_.x), std::min(region.film_high.y, film_.y));
        const V2f size = high - low;
        // Rays between those that were traced may pass where these did not.
        constexpr double kLeastShare = 0.05;
        region.light = float(unit_ * std::max(light, kLeastShare * near) / double(size.x * size.y));
        found_.regions.push_back(region);
    }
}

}  // namespace

GhostSearch::GhostSearch(const GhostOptics& optics) : optics_(optics), draws_(kFirstBatches) {
    for (uint32_t batch = 0; batch < draws_.size(); ++batch) {
        LampDraws& draws = draws_[batch];
        for (uint32_t i = 0; i < 8; ++i) {
            const Sampler sampler(SamplerKind::Owen, 1, {0, 0, 8 * batch + i});
            draws.in_part[i] = V2d(sampler.get2(Dim::Lens));
            draws.on_lamp[i] = V2d(uniform_disk(sampler.get2(Dim::LightPoint)));
            draws.nm[int(i)] = 400 + 300 * sampler.get1(Dim::Wavelength);
        }
        draws.indices = optics.lens().indices(draws.nm);
    }
}

auto GhostSearch::find(uint32_t pair, const GhostLamp& lamp, int most_parts) const -> Found {
    const LampRays rays(optics_, draws_, pair, lamp);
    const double unit = lamp.nits_sr * double(optics_.reflects(optics_.pairs()[pair]));
    PairSearch search(optics_, rays, pair, unit, most_parts);
    search.find(rays.whole(), {kParts, kDivisions, kFirstBatches});
    return std::move(search).found();
}

}  // namespace petzval::camera
