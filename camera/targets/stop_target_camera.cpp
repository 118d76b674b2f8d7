// SPDX-License-Identifier: Apache-2.0
#include "camera/targets/stop_target_camera.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "camera/targets/list_target.h"
#include "core/sampling/warp.h"

namespace petzval::camera {
namespace {

/// Whether the ray that the map has for a point of the stop is near a target: other rays are
/// neither sent nor asked for their density.
bool is_near(const TargetView& view, const f4& ray, V2f stop) {
    const float reach = reach_at(*view.map, *view.target, stop);
    return landing(ray, *view.target).length2() <= reach * reach;
}
bool is_near(const TargetView& view, V2f stop_mm) {
    const V2f stop = view.map->on_disc(stop_mm);
    return is_near(view, at(view.map->rays(view.film, view.nm), stop), stop);
}

}  // namespace

StopTargetCamera::StopTargetCamera(StopCamera camera)
    : camera_(std::move(camera)), pose_(pose_of(camera_)), iris_mm2_(iris_area_mm2(camera_)) {}

std::shared_ptr<const StopMap> StopTargetCamera::map(const FilmCell& cell) const {
    return StopMap::of(camera_, cell);
}

std::optional<ListedTarget> StopTargetCamera::listed(const Target& target, const StopMap& map,
                                                     V2i frame_px) const {
    return list_target(target, map, pose_, frame_px, iris_mm2_);
}

float StopTargetCamera::density_of_stop(const TargetView& view, const StopMap::Rays& rays,
                                        V2f stop_mm) const {
    StopSearch search(view, rays);
    if (search.region.empty()) return 0;
    correct(camera_, {&search, 1});
    return search.region.density(view.map->on_disc(stop_mm)) / view.map->stretch_mm2();
}

// The stop is drawn evenly.
float StopTargetCamera::density_of_film(const TargetView& view, const FilmPoint& point,
                                        V2f stop_mm) const {
    const float drawn = point.pixel.filter->density_per_px2(point.pixel.offset_px);
    if (!(drawn > 0)) return 0;
    TargetView of_pixel = view;
    of_pixel.film = middle_of_pixel(point);
    std::optional<V2f> landed;
    trace_landings(camera_, {&of_pixel, 1}, {&stop_mm, 1}, {&landed, 1});
    if (!landed) return 0;
    const FilmEllipse ellipse(of_pixel, point.pixel.frame_px, stop_mm, *landed);
    return ellipse.density_per_px2(point.pixel.offset_px) / (drawn * kPi * view.map->stretch_mm2());
}

float StopTargetCamera::density_to_targets(const StopCrossings& crossings, const FilmPoint& point,
                                           const TargetCell& cell, const Aimed* aimed) const {
    const auto along = FilmOctagon::along(middle_of_pixel(point));
    const float all = cell.chances(along);
    if (!(all > 0)) return 0;
    float sum = 0;
    for (size_t k = 0; k < crossings.lanes; ++k) {
        const StopMap::Rays rays = cell.map->rays(point.film, crossings.nm[k]);
        const V2f stop_mm = crossings.stop_mm[k], stop = cell.map->on_disc(stop_mm);
        const f4 ray = at(rays, stop);
        for (const ListedTarget& target : cell.targets) {
            if (!target.seen_from.contains(along)) continue;
            const float by_film = target.film_share(along),
                        by_stop = target.seen_from.contains_point(point.film) ? 1 - by_film : 0;
            if (!(by_film + by_stop > 0)) continue;
            const TargetView view{cell.map.get(), &target, point.film, crossings.nm[k]};
            if (!is_near(view, ray, stop)) continue;
            // The region that a ray was drawn from need not be found again.
            const bool is_own =
                aimed && aimed->target == &target && aimed->density >= 0 && crossings.lanes == 1;
            float density = 0;
            if (by_film > 0) density += by_film * density_of_film(view, point, stop_mm);
            if (by_stop > 0)
                density +=
                    by_stop * (is_own ? aimed->density : density_of_stop(view, rays, stop_mm));
            sum += crossings.stretch[k] * target.chance * density;
        }
    }
    return sum / (static_cast<float>(crossings.lanes) * all);
}

void StopTargetCamera::sample(std::span<const FilmPoint> points, std::span<const Bands> bands,
                              CellsOfPoints cells, const StopPoints& stop_mm,
                              std::span<CameraSample> out, std::span<const Aimed> aimed) const {
    std::array<bool, kMostFilmPoints> asked{};
    for (size_t i = 0; i < points.size(); ++i) asked[i] = cells[i] != nullptr;
    std::array<StopCrossings, kMostFilmPoints> crossings{};
    sample_through(camera_, points, bands, stop_mm, out, asked, crossings);
    for (size_t i = 0; i < points.size(); ++i) {
        if (!asked[i] || out[i].empty() || crossings[i].lanes == 0) continue;
        const float density = static_cast<float>(rays_of(*cells[i], points[i], bands[i])) *
                              density_to_targets(crossings[i], points[i], *cells[i],
                                                 aimed.empty() ? nullptr : &aimed[i]);
        if (!(density > 0)) continue;
        const float share = out[i].density / (out[i].density + density);
        for (CameraPath& path : out[i]) path.mis_weight = share;
    }
}

void StopTargetCamera::sample_beside(std::span<const FilmPoint> points,
                                     std::span<const Bands> bands, CellsOfPoints cells,
                                     std::span<CameraSample> out) const {
    sample(points, bands, cells, drawn_stop_mm(camera_, points), out);
}

// Points of the stop whose rays pass the picked targets, for the film points that have one.
void StopTargetCamera::aim_at_stop(const Batch& batch, const PickedViews& views, uint32_t ray,
                                   std::vector<Aimed>& out) const {
    std::vector<StopSearch> searches;
    searches.reserve(batch.points.size());
    std::array<size_t, kMostFilmPoints> of{};
    for (size_t i = 0; i < batch.points.size(); ++i) {
        const std::optional<PickedView>& view = views[i];
        if (!view || view->draws_film || !view->target->seen_from.contains_point(view->film))
            continue;
        of[searches.size()] = i;
        searches.emplace_back(*view, view->map->rays(view->film, view->nm));
        if (searches.back().region.empty()) searches.pop_back();
    }
    correct(camera_, searches);
    for (size_t n = 0; n < searches.size(); ++n) {
        const FilmPoint& point = batch.points[of[n]];
        const Sampler numbers = sampler(batch, of[n], ray);
        const V2f stop = searches[n].region.sample(numbers.get2(Dim::TargetPick).y,
                                                   numbers.get2(Dim::TargetPoint));
        const TargetView& view = searches[n].view;
        Aimed aimed{of[n], point, view.map->stop_mm(stop), view.target};
        aimed.density =
            searches[n].region.density(view.map->on_disc(aimed.stop_mm)) / view.map->stretch_mm2();
        if (is_near(view, aimed.stop_mm)) out.push_back(aimed);
    }
}

// Any point of the stop, and a film point of the pixel that sees the picked target through it.
void StopTargetCamera::aim_at_film(const Batch& batch, const PickedViews& views, uint32_t ray,
                                   std::vector<Aimed>& out) const {
    for (size_t i = 0; i < batch.points.size(); ++i) {
        if (!views[i] || !views[i]->draws_film) continue;
        TargetView view = *views[i];
        Aimed aimed{i, batch.points[i], {}, view.target};
        view.film = middle_of_pixel(aimed.point);
        aimed.stop_mm =
            view.map->stop_mm(uniform_disk(sampler(batch, i, ray).get2(Dim::TargetPoint)));
        std::optional<V2f> landed;
        trace_landings(camera_, {&view, 1}, {&aimed.stop_mm, 1}, {&landed, 1});
        if (!landed) continue;
        PixelFilter& pixel = aimed.point.pixel;
        const FilmEllipse ellipse(view, pixel.frame_px, aimed.stop_mm, *landed);
        pixel.offset_px = ellipse.sample(sampler(batch, i, ray).get2(Dim::TargetFilm));
        aimed.point.film = view.film + pixel.offset_px / pixel.frame_px;
        view.film = aimed.point.film;
        if (pixel.filter->value(pixel.offset_px) > 0 && is_near(view, aimed.stop_mm))
            out.push_back(aimed);
    }
}

std::optional<StopTargetCamera::PickedView> StopTargetCamera::picked(const Batch& batch, size_t i,
                                                                     uint32_t ray) const {
    const TargetCell* const cell = batch.cells[i];
    if (!cell || ray >= rays_of(*cell, batch.points[i], batch.bands[i])) return std::nullopt;
    const auto along = FilmOctagon::along(middle_of_pixel(batch.points[i]));
    const float all = cell->chances(along);
    if (!(all > 0)) return std::nullopt;
    float u = all * sampler(batch, i, ray).get2(Dim::TargetPick).x;
    const ListedTarget* found = nullptr;
    for (const ListedTarget& target : cell->targets) {
        if (!target.seen_from.contains(along)) continue;
        found = &target;
        if (u < target.chance) break;
        u -= target.chance;
    }
    return PickedView{
        {cell->map.get(), found, batch.points[i].film, leading_nm(camera_, batch.bands[i])},
        u < found->film_share(along) * found->chance};
}

Sampler StopTargetCamera::sampler(const Batch& batch, size_t i, uint32_t ray) const {
    return batch.points[i].sampler.branch(rays_of(*batch.cells[i], batch.points[i], batch.bands[i]),
                                          ray);
}

uint32_t StopTargetCamera::rays_of(const TargetCell& cell, const FilmPoint& point,
                                   const Bands& bands) const {
    return is_led(camera_, point, bands) ? cell.rays : 1;
}

void StopTargetCamera::sample_targets(std::span<const FilmPoint> points,
                                      std::span<const Bands> bands, CellsOfPoints cells,
                                      std::span<CameraSample> out) const {
    const Batch batch{points, bands, cells};
    uint32_t rays = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        out[i] = {};
        if (cells[i]) rays = std::max(rays, rays_of(*cells[i], points[i], bands[i]));
    }
    for (uint32_t ray = 0; ray < rays; ++ray) {
        std::vector<Aimed> aimed;
        PickedViews views;
        for (size_t i = 0; i < points.size(); ++i) views[i] = picked(batch, i, ray);
        aim_at_stop(batch, views, ray, aimed);
        aim_at_film(batch, views, ray, aimed);
        const size_t count = aimed.size();
        if (count == 0) continue;
        std::array<FilmPoint, kMostFilmPoints> sent;
        std::array<Bands, kMostFilmPoints> sent_bands;
        std::array<const TargetCell*, kMostFilmPoints> sent_cells{};
        StopPoints stop_mm{};
        for (size_t n = 0; n < count; ++n) {
            sent[n] = aimed[n].point, stop_mm[n] = aimed[n].stop_mm;
            sent_bands[n] = bands[aimed[n].of], sent_cells[n] = cells[aimed[n].of];
        }
        std::array<CameraSample, kMostFilmPoints> found;
        sample({sent.data(), count}, {sent_bands.data(), count}, {sent_cells.data(), count},
               stop_mm, {found.data(), count}, aimed);
        // Rounding, and what the map has off the target, leave a ray that the densities do not
        // know.
        for (size_t n = 0; n < count; ++n)
            for (const CameraPath& path : found[n])
                if (path.mis_weight < 1) {
                    CameraPath& sent_path = out[aimed[n].of].add();
                    sent_path = path;
                    sent_path.target_ray = static_cast<uint8_t>(ray);
                    sent_path.target_rays = static_cast<uint8_t>(
                        rays_of(*sent_cells[n], points[aimed[n].of], sent_bands[n]));
                }
    }
}

}  // namespace petzval::camera
