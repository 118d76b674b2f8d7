// SPDX-License-Identifier: Apache-2.0
#include "integrator/prepass/target_pilot.h"

#include <algorithm>
#include <cmath>

#include "core/film/film.h"
#include "core/sampling/prepass_seed.h"
#include "core/spectrum/colour.h"
#include "integrator/path/path.h"

namespace petzval {
namespace {

/// Samples of a cell, rays to all of its targets, and to one of them.
constexpr uint32_t kOrdinary = 8, kSent = 24, kMostSent = 12;
/// Ratio of the frame's efforts that is worth it: they are known no better.
constexpr double kWorthIt = 0.85;
/// Share of the frame's mean that counts as dark.
constexpr double kDark = 0.1;
constexpr int kRounds = 16;
/// Share of the rays that the targets of a cell get evenly, the rest in proportion to their light.
constexpr double kEvenly = 0.5;

/// Costs in steps of a path, each a ray or a vertex: that of a sample's lens, of a ray to a target
/// through a thin lens and through a traced one, and for each start of the latter. From counts of
/// instructions.
constexpr double kLensCost = 4, kThinCost = 1, kTracedCost = 8, kStartCost = 4;

double steps(const PathStats& s) {
    return double(s.camera_rays + s.bounce_rays + s.shadow_rays + s.vertices);
}

/// Means over the samples of cells, or over the rays to one of their targets. Luminance.
struct Found {
    double counted = 0, counted2 = 0;  ///< what the shares leave, and its square
    double whole2 = 0;                 ///< square of ordinary rays in the same direction
    double cost = 0;

    void add(double whole, double share) {
        counted += share * whole;
        counted2 += share * whole * share * whole;
        whole2 += share * whole * whole;
    }
    void add(const Found& o) {
        counted += o.counted, counted2 += o.counted2, whole2 += o.whole2, cost += o.cost;
    }
    void scale(double by) { counted *= by, counted2 *= by, whole2 *= by, cost *= by; }
    /// What a target's light adds to the variance of ordinary rays, however seldom they meet it: by
    /// the shares of the rays that are sent to it.
    [[nodiscard]] double spread() const { return std::max(0., whole2 - counted * counted); }
};

struct CellFound {
    Found ordinary;
    std::vector<Found> sent;
};

class CellPilot {
  public:
    CellPilot(const TargetCamera& camera, const PathTracer<>& tracer)
        : camera_(camera), tracer_(tracer) {}

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
                const Sampler sampler(SamplerKind::Owen, number_of(PrepassSeed::Targets),
                                      {cell.x, cell.y, first + i});
                bands[i] = Bands::rgb();
                points[i] = {place_of(first + i, sampler.get2(Dim::Film)), sampler};
            }
            for (uint32_t i = 0; i < n; ++i)
                lists[i] = to ? TargetList(to, 1) : camera_.targets()->at(points[i].film);
            const auto sample = to ? &TargetCamera::sample_targets : &TargetCamera::sample_beside;
            (camera_.*sample)({points.data(), n}, {bands.data(), n}, {lists.data(), n},
                              {paths.data(), n});
            for (uint32_t i = 0; i < n; ++i) {
                if (paths[i].empty()) continue;
                f4 light{};
                for (const CameraPath& path : paths[i]) {
                    FilmSample none;
                    light +=
                        path.weight * tracer_.radiance({path.ray, path.lanes, path.hero_decided,
                                                        to ? path.mis_weight : 1.f},
                                                       bands[i], points[i].sampler, none, stats);
                }
                out.add(std::fabs(double(luminance(to_rgb(light, bands[i])))),
                        double(paths[i][0].mis_weight));
            }
        }
        out.cost = steps(stats);
        out.scale(1. / count);
        return out;
    }

  private:
    const TargetCamera& camera_;
    const PathTracer<>& tracer_;
};

/// Number of a target in another list; its size where it is not there.
size_t place_in(TargetList list, const ListedTarget& target) {
    const auto same = [&](const ListedTarget& other) { return other.number == target.number; };
    return static_cast<size_t>(std::find_if(list.begin(), list.end(), same) - list.begin());
}

/// What is found in a cell and in those beside it: a few rays of one miss what a part of it sees.
CellFound with_neighbours(const TargetGrid& grid, const std::vector<CellFound>& cells, int i,
                          int j) {
    const auto index = [&](int x, int y) { return static_cast<size_t>(y * grid.cells.x + x); };
    const TargetList list = grid.lists[index(i, j)];
    CellFound out{{}, std::vector<Found>(list.size())};
    std::vector<int> counts(list.size());
    int count = 0;
    for (int y = std::max(j - 1, 0); y <= std::min(j + 1, grid.cells.y - 1); ++y)
        for (int x = std::max(i - 1, 0); x <= std::min(i + 1, grid.cells.x - 1); ++x) {
            const CellFound& cell = cells[index(x, y)];
            out.ordinary.add(cell.ordinary);
            ++count;
            for (size_t k = 0; k < list.size(); ++k) {
                const size_t there = place_in(grid.lists[index(x, y)], list[k]);
                if (there == cell.sent.size()) continue;
                out.sent[k].add(cell.sent[there]);
                ++counts[k];
            }
        }
    out.ordinary.scale(1. / count);
    for (size_t k = 0; k < list.size(); ++k) out.sent[k].scale(1. / counts[k]);
    return out;
}

/// Noise of a sample of a cell, as a relative standard deviation, and its cost.
struct Effort {
    double noise = 0, cost = 0;

    [[nodiscard]] double product() const { return noise * noise * cost; }
};

/// The efforts of a cell with no target, with the worst one, the two worst ones, and so on.
struct CellChoice {
    std::vector<size_t> order;
    std::vector<double> roots;    ///< of the mean square of what each target brings
    std::vector<Effort> efforts;  ///< with the first 0, 1, 2 ... of the order
    size_t taken = 0;
};

/// dark: luminance from which on variance is relative to the cell's own.
CellChoice choice_of(TargetList list, const CellFound& found, double dark) {
    CellChoice out;
    for (size_t k = 0; k < list.size(); ++k)
        if (found.sent[k].counted2 > 0) out.order.push_back(k);
    std::stable_sort(out.order.begin(), out.order.end(), [&](size_t a, size_t b) {
        return found.sent[a].spread() > found.sent[b].spread();
    });
    const Found& ordinary = found.ordinary;
    double mean = ordinary.counted, rest = ordinary.spread();
    for (const Found& sent : found.sent) {
        out.roots.push_back(std::sqrt(sent.counted2));
        mean += sent.counted, rest += sent.spread();
    }
    const double scale = 1 / (mean * mean + dark * dark);
    const double usual = ordinary.cost + kLensCost;
    out.efforts.push_back({std::sqrt(rest * scale), usual});
    double roots = 0, light = 0, cost = 0;
    for (const size_t k : out.order) {
        const Found& sent = found.sent[k];
        rest -= sent.spread();
        roots += out.roots[k];
        light += sent.counted;
        const int starts = list[k].start_count;
        cost += out.roots[k] *
                (sent.cost + (starts > 0 ? kTracedCost + kStartCost * starts : kThinCost));
        const double variance = std::max(0., rest) + std::max(0., roots * roots - light * light);
        out.efforts.push_back({std::sqrt(variance * scale), usual + cost / roots});
    }
    return out;
}

Effort sum_of(const std::vector<CellChoice>& cells) {
    Effort sum;
    for (const CellChoice& cell : cells) {
        sum.noise += cell.efforts[cell.taken].noise;
        sum.cost += cell.efforts[cell.taken].cost;
    }
    return sum;
}

/// Takes of each cell the targets that lower the square of the frame's mean noise times its cost.
/// Whether they do depends on what the other cells take: until nothing changes. (Variance in place
/// of noise would leave out all discs but the worst.)
void take_best(std::vector<CellChoice>& cells) {
    for (CellChoice& cell : cells) cell.taken = cell.efforts.size() - 1;
    for (int round = 0; round < kRounds; ++round) {
        const Effort all = sum_of(cells);
        bool changed = false;
        for (CellChoice& cell : cells) {
            const auto change = [&](const Effort& e) {
                return 2 * e.noise / all.noise + e.cost / all.cost;
            };
            const auto least = std::min_element(
                cell.efforts.begin(), cell.efforts.end(),
                [&](const Effort& a, const Effort& b) { return change(a) < change(b); });
            const auto best = static_cast<size_t>(least - cell.efforts.begin());
            changed = changed || best != cell.taken;
            cell.taken = best;
        }
        if (!changed) return;
    }
}

}  // namespace

std::shared_ptr<const TargetGrid> targets_that_pay(const TargetCamera& camera, const Scene& scene,
                                                   const Bvh& bvh, const LightChoice& lights,
                                                   V2i frame_px) {
    const TargetGrid* const all = camera.targets().get();
    if (!all) return nullptr;
    const PathTracer<> tracer(scene, bvh, lights, {});
    const CellPilot pilot(camera, tracer);
    std::vector<CellFound> found;
    double mean = 0;
    for (int j = 0; j < all->cells.y; ++j)
        for (int i = 0; i < all->cells.x; ++i) {
            const TargetList list = all->lists[found.size()];
            const FilmCell cell = all->cell(i, j, frame_px);
            const auto within = [&](V2f u) { return cell.first + u * (cell.last - cell.first); };
            CellFound& here = found.emplace_back();
            here.ordinary = pilot.samples({i, j}, kOrdinary, nullptr,
                                          [&](uint32_t, V2f u) { return within(u); });
            mean += here.ordinary.counted;
            const uint32_t sent =
                std::min(kMostSent, kSent / std::max(1u, static_cast<uint32_t>(list.size())));
            for (ListedTarget target : list) {
                target.chance = 1;
                // From where it is seen, and from farther and farther around.
                here.sent.push_back(pilot.samples({i, j}, sent, &target, [&](uint32_t n, V2f u) {
                    const float away = (static_cast<float>(n) + 0.5f) / static_cast<float>(sent);
                    return target.place + (within(u) - target.place) * away;
                }));
                mean += here.sent.back().counted;
            }
        }
    const double dark = kDark * mean / static_cast<double>(found.size());
    std::vector<CellChoice> cells;
    for (int j = 0; j < all->cells.y; ++j)
        for (int i = 0; i < all->cells.x; ++i)
            cells.push_back(
                choice_of(all->lists[cells.size()], with_neighbours(*all, found, i, j), dark));
    const Effort without = sum_of(cells);
    take_best(cells);
    const Effort with = sum_of(cells);
    if (!(with.product() < kWorthIt * without.product())) return nullptr;
    auto out = std::make_shared<TargetGrid>();
    out->cells = all->cells;
    out->targets = all->targets;
    for (const CellChoice& cell : cells) {
        const TargetList list = all->lists[out->lists.size()];
        std::vector<ListedTarget>& kept = out->lists.emplace_back();
        double sum = 0;
        for (size_t n = 0; n < cell.taken; ++n) sum += cell.roots[cell.order[n]];
        for (size_t n = 0; n < cell.taken; ++n) {
            kept.push_back(list[cell.order[n]]);
            // Few rays know the light badly: no target that pays is sent next to nothing.
            const double even = 1. / static_cast<double>(cell.taken);
            kept.back().chance =
                static_cast<float>(std::lerp(cell.roots[cell.order[n]] / sum, even, kEvenly));
        }
    }
    return out;
}

}  // namespace petzval
