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
constexpr uint32_t kOrdinary = 16, kSent = 6;
/// Ratio of efforts that is worth it: they are known no better.
constexpr double kWorthIt = 0.4;

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
    void scale(double by) { counted *= by, counted2 *= by, whole2 *= by, cost *= by; }
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
            const auto n = std::min(count - first, static_cast<uint32_t>(kMostFilmPoints));
            for (uint32_t i = 0; i < n; ++i) {
                const Sampler sampler(SamplerKind::Owen, kSeed, {cell.x, cell.y, first + i});
                bands[i] = observer_.spectral() ? observer_.draw(sampler.get1(Dim::Wavelength))
                                                : Bands::rgb();
                points[i] = {place_of(first + i, sampler.get2(Dim::Film)), sampler};
            }
            if (to) {
                lists.fill({to, 1});
                camera_.sample_targets({points.data(), n}, {bands.data(), n}, {lists.data(), n},
                                       {paths.data(), n});
            } else {
                camera_.sample_all({points.data(), n}, {bands.data(), n}, {paths.data(), n});
            }
            for (uint32_t i = 0; i < n; ++i) {
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

/// Targets of a cell that were tried: the root of what each brings, squared, and whether it pays.
struct Tried {
    std::vector<double> roots;
    std::vector<bool> pays;
};

/// The part of a list with the least effort: variance times cost. What a target's light would add
/// to the variance of ordinary rays is known from the rays that are sent to it, however seldom
/// ordinary ones meet it: by the same shares as the light itself.
Tried best_part(TargetList list, const Found& ordinary, const std::vector<Found>& sent) {
    std::vector<size_t> order(list.size());
    std::iota(order.begin(), order.end(), 0);
    const auto spread = [&](size_t k) {
        return sent[k].whole2 - sent[k].counted * sent[k].counted;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return spread(a) > spread(b); });
    Tried out{{}, std::vector<bool>(list.size())};
    for (const Found& one : sent) out.roots.push_back(std::sqrt(one.counted2));
    double rest = ordinary.counted2 - ordinary.counted * ordinary.counted;
    for (const size_t k : order) rest += spread(k);
    double least = kWorthIt * rest * (ordinary.cost + kLensCost), roots = 0, light = 0, cost = 0;
    size_t best = 0;
    for (size_t n = 0; n < order.size(); ++n) {
        const size_t k = order[n];
        if (!(out.roots[k] > 0)) break;
        rest -= spread(k);
        roots += out.roots[k];
        light += sent[k].counted;
        const int starts = list[k].start_count;
        cost += out.roots[k] *
                (sent[k].cost + (starts > 0 ? kTracedCost + kStartCost * starts : kThinCost));
        const double variance = rest + std::max(0., roots * roots - light * light);
        const double effort = variance * (ordinary.cost + kLensCost + cost / roots);
        if (effort < least) least = effort, best = n + 1;
    }
    for (size_t n = 0; n < best; ++n) out.pays[order[n]] = true;
    return out;
}

/// Root of a target where it pays in a cell; 0 elsewhere.
double root_in(TargetList list, const Tried& tried, const ListedTarget& target) {
    for (size_t k = 0; k < list.size(); ++k)
        if (tried.pays[k] && list[k].target.centre == target.target.centre) return tried.roots[k];
    return 0;
}

/// Lists of what pays in a cell or in one beside it: few rays may have missed what a part of a cell
/// sees.
TargetGrid with_neighbours(const TargetGrid& all, const std::vector<Tried>& tried) {
    TargetGrid out{all.cells, {}};
    const auto index = [&](int i, int j) { return static_cast<size_t>(j) * all.cells.x + i; };
    for (int j = 0; j < all.cells.y; ++j)
        for (int i = 0; i < all.cells.x; ++i) {
            std::vector<ListedTarget>& kept = out.lists.emplace_back();
            double sum = 0;
            for (const ListedTarget& target : all.lists[index(i, j)]) {
                double root = 0;
                for (int y = std::max(j - 1, 0); y <= std::min(j + 1, all.cells.y - 1); ++y)
                    for (int x = std::max(i - 1, 0); x <= std::min(i + 1, all.cells.x - 1); ++x)
                        root = std::max(
                            root, root_in(all.lists[index(x, y)], tried[index(x, y)], target));
                if (!(root > 0)) continue;
                sum += root;
                kept.push_back(target);
                kept.back().chance = static_cast<float>(root);
            }
            for (ListedTarget& target : kept) target.chance /= static_cast<float>(sum);
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
    std::vector<Tried> tried;
    bool any = false;
    for (int j = 0; j < all->cells.y; ++j)
        for (int i = 0; i < all->cells.x; ++i) {
            const TargetList list = all->lists[tried.size()];
            tried.emplace_back();
            if (list.empty()) continue;
            const FilmCell cell = all->cell(i, j, frame_px);
            const auto within = [&](V2f u) { return cell.first + u * (cell.last - cell.first); };
            const Found ordinary = pilot.samples({i, j}, kOrdinary, nullptr,
                                                 [&](uint32_t, V2f u) { return within(u); });
            std::vector<Found> sent;
            for (ListedTarget target : list) {
                target.chance = 1;
                // From where it is seen, and from farther and farther around.
                sent.push_back(pilot.samples({i, j}, kSent, &target, [&](uint32_t n, V2f u) {
                    const float away = (static_cast<float>(n) + 0.5f) / kSent;
                    return target.place + (within(u) - target.place) * away;
                }));
            }
            tried.back() = best_part(list, ordinary, sent);
            any = any || std::find(tried.back().pays.begin(), tried.back().pays.end(), true) !=
                             tried.back().pays.end();
        }
    if (!any) return nullptr;
    return std::make_shared<const TargetGrid>(with_neighbours(*all, tried));
}

}  // namespace petzval
