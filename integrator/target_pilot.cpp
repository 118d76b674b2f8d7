// SPDX-License-Identifier: Apache-2.0
#include "integrator/target_pilot.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/film/film.h"
#include "core/spectrum/colour.h"
#include "integrator/path.h"

namespace petzval {
namespace {

constexpr uint32_t kSeed = 0x74617267;  ///< so that no sample is one of the picture
/// Samples of a cell, and rays to each of its targets.
constexpr uint32_t kOrdinary = 16, kSent = 8;
/// Ratio of efforts that is worth it: they are known no better.
constexpr double kWorthIt = 0.8;

/// Costs in steps of a path, each a ray or a vertex: that of a sample's lens, of a ray to a target
/// through a thin lens and through a traced one, and for each start of the latter. From counts of
/// instructions.
constexpr double kLensCost = 4, kThinCost = 1, kTracedCost = 8, kStartCost = 4;

double steps(const PathStats& s) {
    return double(s.camera_rays + s.bounce_rays + s.shadow_rays + s.vertices);
}

/// Sums over the samples of a cell, or over the rays to one of its targets. Luminance.
struct Found {
    double counted = 0, counted2 = 0;  ///< what the shares leave, and its square
    double whole2 = 0;                 ///< square of ordinary rays in the same direction
    double cost = 0;

    void add(double whole, double share) {
        counted += share * whole;
        counted2 += share * whole * share * whole;
        whole2 += share * whole * whole;
    }
    void scale(double by) {
        counted *= by, counted2 *= by, whole2 *= by, cost *= by;
    }
};

class CellPilot {
  public:
    CellPilot(const Camera& camera, const PathTracer<>& tracer, const Observer& observer)
        : camera_(camera), tracer_(tracer), observer_(observer) {}

    /// Samples at places of a cell; to: a target, or none for ordinary ones.
    template <class PlaceOf>
    [[nodiscard]] Found samples(V2i cell, uint32_t count, const ListedTarget* to,
                                const PlaceOf& place_of) const {
        Found out;
        PathStats stats;
        for (uint32_t first = 0; first < count; first += kMostFilmPoints) {
            std::array<FilmPoint, kMostFilmPoints> points;
            std::array<Bands, kMostFilmPoints> bands;
            std::array<CameraSample, kMostFilmPoints> paths;
            std::array<TargetList, kMostFilmPoints> lists;
            for (uint32_t i = 0; i < kMostFilmPoints; ++i) {
                const Sampler sampler(SamplerKind::Owen, kSeed, {cell.x, cell.y, first + i});
                bands[i] = observer_.spectral()
                               ? observer_.draw(sampler.get1(Dim::Wavelength))
                               : Bands::rgb();
                points[i] = {place_of(first + i, sampler.get2(Dim::Film)), sampler};
            }
            if (to) {
                lists.fill({to, 1});
                camera_.sample_targets(points, bands, lists, paths);
            } else {
                camera_.sample_all(points, bands, paths);
            }
            for (uint32_t i = 0; i < kMostFilmPoints; ++i) {
                if (paths[i].empty()) continue;
                f4 light{};
                for (const CameraPath& path : paths[i]) {
                    FilmSample none;
                    light += path.weight * tracer_.radiance(path.ray, bands[i], points[i].sampler,
                                                            false, none, stats, path.lanes,
                                                            path.led, to ? path.share : 1.f);
                }
                out.add(std::fabs(double(luminance(to_rgb(light, bands[i])))),
                        double(paths[i][0].share));
            }
        }
        out.cost = steps(stats);
        out.scale(1. / count);
        return out;
    }

  private:
    const Camera& camera_;
    const PathTracer<>& tracer_;
    const Observer& observer_;
};

/// The part of a list with the least effort: variance times cost. What a target's light would add
/// to the variance of ordinary rays is known from the rays that are sent to it, however seldom
/// ordinary ones meet it: by the same shares as the light itself.
std::vector<ListedTarget> best_part(std::vector<ListedTarget> list, const Found& ordinary,
                                    const std::vector<Found>& sent) {
    std::vector<size_t> order(list.size());
    std::iota(order.begin(), order.end(), 0);
    const auto spread = [&](size_t k) {
        return sent[k].whole2 - sent[k].counted * sent[k].counted;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return spread(a) > spread(b); });
    double rest = ordinary.counted2 - ordinary.counted * ordinary.counted;
    for (const size_t k : order) rest += spread(k);
    double least = kWorthIt * rest * (ordinary.cost + kLensCost), roots = 0, light = 0, cost = 0;
    size_t best = 0;
    for (size_t n = 0; n < order.size(); ++n) {
        const size_t k = order[n];
        const double root = std::sqrt(sent[k].counted2);
        if (!(root > 0)) break;
        rest -= spread(k);
        roots += root;
        light += sent[k].counted;
        const int starts = list[k].start_count;
        cost += root * (sent[k].cost + (starts > 0 ? kTracedCost + kStartCost * starts : kThinCost));
        const double variance = rest + std::max(0., roots * roots - light * light);
        const double effort = variance * (ordinary.cost + kLensCost + cost / roots);
        if (effort < least) least = effort, best = n + 1;
    }
    std::vector<ListedTarget> out;
    double sum = 0;
    for (size_t n = 0; n < best; ++n) sum += std::sqrt(sent[order[n]].counted2);
    for (size_t n = 0; n < best; ++n) {
        out.push_back(list[order[n]]);
        out.back().chance = static_cast<float>(std::sqrt(sent[order[n]].counted2) / sum);
    }
    return out;
}

}  // namespace

std::shared_ptr<const TargetGrid> targets_that_pay(const Camera& camera, const Scene& scene,
                                                   const Bvh& bvh, const LightChoice& lights,
                                                   const Observer& observer, V2i frame_px) {
    const TargetGrid* all = camera.targets();
    if (!all) return nullptr;
    const PathTracer<> tracer(scene, bvh, lights, {});
    const CellPilot pilot(camera, tracer, observer);
    auto out = std::make_shared<TargetGrid>();
    out->cells = all->cells;
    bool any = false;
    for (int j = 0; j < all->cells.y; ++j)
        for (int i = 0; i < all->cells.x; ++i) {
            const size_t index = static_cast<size_t>(j) * all->cells.x + i;
            std::vector<ListedTarget>& kept = out->lists.emplace_back();
            if (all->lists[index].empty()) continue;
            const FilmCell cell = all->cell(i, j, frame_px);
            const auto within = [&](V2f u) { return cell.first + u * (cell.last - cell.first); };
            const Found ordinary =
                pilot.samples({i, j}, kOrdinary, nullptr,
                              [&](uint32_t, V2f u) { return within(u); });
            std::vector<Found> sent;
            for (ListedTarget target : all->lists[index]) {
                target.chance = 1;
                // From where it is seen, and from farther and farther around.
                sent.push_back(pilot.samples({i, j}, kSent, &target, [&](uint32_t n, V2f u) {
                    const float away = (static_cast<float>(n) + 0.5f) / kSent;
                    return target.place + (within(u) - target.place) * away;
                }));
            }
            kept = best_part(all->lists[index], ordinary, sent);
            any = any || !kept.empty();
        }
    return any ? out : nullptr;
}

}  // namespace petzval
