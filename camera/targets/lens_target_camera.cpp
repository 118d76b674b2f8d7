// SPDX-License-Identifier: Apache-2.0
#include "camera/targets/lens_target_camera.h"

#include <algorithm>
#include <utility>

namespace petzval {
namespace {

/// Directions that ray aiming finds are this near to the true ones.
constexpr float kSameDirection = 2e-3f;

}  // namespace

LensTargetCamera::LensTargetCamera(std::shared_ptr<const LensCamera> camera)
    : camera_(std::move(camera)),
      targets_(
          *camera_->input().lens, camera_->optics().aimer(), camera_->input().entrance_pupil_mm,
          double(camera_->input().iris.bounding_radius_mm()), camera_->input().iris.area_mm2()) {}

std::optional<PreparedTarget> LensTargetCamera::prepared(const Target& target) const {
    const V2f half_mm(V2d(camera_->input().film_width_mm / 2, camera_->input().film_height_mm / 2));
    auto out = targets_.prepared({camera_->pose(), target}, half_mm);
    if (out) out->place = camera_->film_of(out->place);
    return out;
}

std::optional<ListedTarget> LensTargetCamera::listed(const PreparedTarget& target,
                                                     const FilmCell& cell) const {
    const V2f a = camera_->film_mm(cell.first), b = camera_->film_mm(cell.last);
    auto out = targets_.listed(
        target, camera_->film_mm(cell.nearest(target.place)),
        {V2f(std::min(a.x, b.x), std::min(a.y, b.y)), V2f(std::max(a.x, b.x), std::max(a.y, b.y))});
    if (out) out->place = cell.nearest(target.place);
    return out;
}

void LensTargetCamera::sample_beside(std::span<const FilmPoint> points,
                                     std::span<const Bands> bands,
                                     std::span<const TargetList> listed,
                                     std::span<CameraSample> out) const {
    const Batch all = camera_->batch(points, bands);
    LeadRays rays = camera_->optics().aim(all.at, all.indices);
    std::array<TargetList, kMostFilmPoints> lists;
    std::copy(listed.begin(), listed.end(), lists.begin());
    const std::array<float, kMostFilmPoints> density = to_targets(all, rays, lists);
    camera_->finish(all, rays, out);
    weigh(out, density);
}

void LensTargetCamera::sample_targets(std::span<const FilmPoint> points,
                                      std::span<const Bands> bands,
                                      std::span<const TargetList> listed,
                                      std::span<CameraSample> out) const {
    const Batch all = camera_->batch(points, bands);
    std::array<TargetList, kMostFilmPoints> lists;
    std::array<Sampler, kMostFilmPoints> samplers;
    PlanePoint<f8> film(f8{}, f8{});
    for (size_t i = 0; i < kMostFilmPoints; ++i) {
        const int lane = static_cast<int>(i);
        film.x[lane] = all.at.film_mm[i].x, film.y[lane] = all.at.film_mm[i].y;
        if (i < points.size()) lists[i] = listed[i], samplers[i] = points[i].sampler;
    }
    const TargetChoice choice = LensTargets::choose(lists, {samplers.data(), points.size()});
    const FoundDirections found = targets_.find({film, all.indices, lists}, choice);
    LeadRays rays;
    static_cast<AimedRay<f8>&>(rays.aimed) =
        camera_->optics().aimer().cross<f8>(film, found.l, found.m, all.indices);
    rays.stop_mm = {rays.aimed.ray.origin.x, rays.aimed.ray.origin.y};
    // Where the pupil folds, draws of the stop find one of the rays that cross it at a point. Only
    // that one counts, with targets and without.
    const FoundRays back =
        camera_->optics().aimer().aim(film, rays.stop_mm, all.indices, all.at.nm);
    const f8 off_l = back.l - found.l, off_m = back.m - found.m;
    rays.aimed.found = found.found & rays.aimed.ray.alive() & back.found &
                       (off_l * off_l + off_m * off_m < sqr(kSameDirection));
    const std::array<float, kMostFilmPoints> density = to_targets(all, rays, lists);
    for (size_t i = 0; i < points.size(); ++i)
        if (!(density[i] > 0.f)) rays.aimed.found[static_cast<int>(i)] = 0;
    camera_->finish(all, rays, out);
    weigh(out, density);
}

// Balance heuristic of the two ways in which a ray may be drawn.
void LensTargetCamera::weigh(std::span<CameraSample> samples,
                             const std::array<float, kMostFilmPoints>& to_targets) {
    for (size_t i = 0; i < samples.size(); ++i) {
        if (!(to_targets[i] > 0.f)) continue;
        const float density = samples[i].density;
        for (CameraPath& path : samples[i]) path.mis_weight = density / (density + to_targets[i]);
    }
}

// Of one lane, or where lanes part and share a direction, the mean over lanes: each may have been
// the one that it was drawn for.
std::array<float, kMostFilmPoints> LensTargetCamera::to_targets(
    const Batch& all, const LeadRays& rays,
    const std::array<TargetList, kMostFilmPoints>& listed) const {
    std::array<float, kMostFilmPoints> out{};
    std::array<TargetList, kMostFilmPoints> lists = listed;
    bool any_listed = false;
    for (size_t i = 0; i < kMostFilmPoints; ++i) {
        if (!rays.aimed.found[static_cast<int>(i)]) lists[i] = {};
        any_listed = any_listed || !lists[i].empty();
    }
    if (!any_listed) return out;
    PlanePoint<f8> film(f8{}, f8{});
    if (all.of_hero) {
        for (int i = 0; i < 8; ++i)
            film.x[i] = all.at.film_mm[size_t(i)].x, film.y[i] = all.at.film_mm[size_t(i)].y;
        const f8 density = targets_.density({film, all.indices, lists}, rays.aimed.l, rays.aimed.m);
        for (int i = 0; i < 8; ++i) out[static_cast<size_t>(i)] = density[i];
        return out;
    }
    for (size_t first = 0; first < all.points.size(); first += 2) {
        const std::array<size_t, 2> pair{first, std::min(first + 1, all.points.size() - 1)};
        const LensIndices<f8> indices =
            camera_->input().lens->indices(joined(all.bands[pair[0]].nm, all.bands[pair[1]].nm));
        f8 l{}, m{};
        TargetPoints at{film, indices, {}};
        for (int i = 0; i < 8; ++i) {
            const size_t lane = static_cast<size_t>(i), point = pair[lane / 4];
            const Bands& bands = all.bands[point];
            at.film_mm.x[i] = all.at.film_mm[point].x, at.film_mm.y[i] = all.at.film_mm[point].y;
            l[i] = rays.aimed.l[static_cast<int>(point)];
            m[i] = rays.aimed.m[static_cast<int>(point)];
            if (bands.on[i % 4]) at.targets[lane] = lists[point];
        }
        const f8 density = targets_.density(at, l, m);
        for (size_t k = 0; k < 2; ++k) {
            const int begin = static_cast<int>(4 * k);
            out[pair[k]] =
                (density[begin] + density[begin + 1] + density[begin + 2] + density[begin + 3]) /
                static_cast<float>(lane_count(all.bands[pair[k]].on));
        }
    }
    return out;
}

}  // namespace petzval
