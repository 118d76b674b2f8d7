// SPDX-License-Identifier: Apache-2.0
#include "integrator/prepass/target_pilot.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/film/film.h"
#include "core/sampling/prepass_seed.h"
#include "core/spectrum/colour.h"
#include "integrator/path/path.h"
#include "integrator/prepass/pooled_targets.h"

namespace petzval::integrator {
namespace {

/// Samples of a cell.
constexpr uint32_t kOrdinary = 8;
/// Pixels of a cell for each ordinary sample, of which there are at least so many.
constexpr uint32_t kPixelsPerSample = 32, kFewest = 2;
/// Ratio of the frame's efforts that is worth it. Few samples of a cell know them badly, and what
/// is chosen by them looks better than it is: scenes that promised 0.7 lost a quarter.
constexpr double kWorthIt = 0.5;
/// Share of the frame's mean that counts as dark.
constexpr double kDark = 0.1;
constexpr int kRounds = 16;
/// Places of a cell, along each side, at which its targets are told from each other.
constexpr size_t kPlaces = 4;
/// Share of the rays that the targets of a cell get evenly, the rest in proportion to their light.
constexpr double kEvenly = 0.5;

/// Costs in steps of a path, each a ray or a vertex: of a sample's lens, of a ray to a target, and
/// of each evaluation of the map in the search for it. From counts of instructions.
constexpr double kLensCost = 4, kSentCost = 6.5, kEvaluationCost = 0.45;

double steps(const PathStats& s) {
    return double(s.camera_rays + s.bounce_rays + s.shadow_rays + s.vertices);
}

struct CellFound {
    PilotFound ordinary;
    std::vector<PilotFound> sent;  ///< to each target
};

class CellPilot {
  public:
    CellPilot(const camera::TargetCamera& camera, const PathTracer<>& tracer, V2i frame_px)
        : camera_(camera), tracer_(tracer), frame_px_(frame_px) {}

    /// Samples of pixels whose middles are even in a part of the film, which are drawn for a place
    /// of the frame, from a first one on: rays to the target of a cell, or ordinary ones beside
    /// those to its targets.
    [[nodiscard]] PilotFound samples(V2i drawn_for, const camera::FilmCell& part, uint32_t begin,
                                     uint32_t count, const camera::TargetCell& cell,
                                     bool to_target) const {
        PilotFound out;
        PathStats stats;
        for (uint32_t first = 0; first < count; first += camera::kMostFilmPoints) {
            std::array<camera::FilmPoint, camera::kMostFilmPoints> points;
            std::array<Bands, camera::kMostFilmPoints> bands;
            std::array<camera::CameraSample, camera::kMostFilmPoints> paths;
            std::array<const camera::TargetCell*, camera::kMostFilmPoints> cells{};
            const auto n = std::min(count - first, static_cast<uint32_t>(camera::kMostFilmPoints));
            for (uint32_t i = 0; i < n; ++i) {
                const Sampler sampler(SamplerKind::Owen, number_of(PrepassSeed::Targets),
                                      {drawn_for.x, drawn_for.y, begin + first + i});
                bands[i] = Bands::rgb();
                // Pixels lie anywhere: what is asked for is a mean over many.
                const V2f middle = part.first + sampler.get2(Dim::Film) * (part.last - part.first),
                          offset_px = filter_.sample(sampler.get2(Dim::Film, 1));
                points[i] = {
                    middle + offset_px / frame_px_, sampler, {&filter_, offset_px, frame_px_}};
                cells[i] = cell.empty() ? nullptr : &cell;
            }
            const auto sample = to_target ? &camera::TargetCamera::sample_targets
                                          : &camera::TargetCamera::sample_beside;
            (camera_.*sample)({points.data(), n}, {bands.data(), n}, {cells.data(), n},
                              {paths.data(), n});
            for (uint32_t i = 0; i < n; ++i) {
                if (paths[i].empty()) continue;
                f4 light{};
                for (const camera::CameraPath& path : paths[i]) {
                    FilmSample none;
                    light +=
                        path.weight * tracer_.radiance({path.ray, path.lanes, path.hero_decided,
                                                        to_target ? path.mis_weight : 1.f},
                                                       bands[i], points[i].sampler, none, stats);
                }
                const double found = std::fabs(double(luminance(to_rgb(light, bands[i]))));
                out.add(found, double(paths[i][0].mis_weight));
                out.hits += to_target && found > kMet * radiance_of(cell, cell.targets[0]);
            }
        }
        out.cost = steps(stats);
        out.scale(1. / count);
        out.share = 1, out.rays = count;
        return out;
    }

  private:
    const camera::TargetCamera& camera_;
    const PathTracer<>& tracer_;
    V2f frame_px_;
    Filter filter_{FilterKind::BlackmanHarris, camera::kFilterReach_px};
};

/// What ordinary samples find in a cell and in those beside it, and rays to targets in all.
CellFound pooled(const camera::TargetGrid& grid, const std::vector<CellFound>& found,
                 const PooledTargets& targets, V2i cell) {
    const auto index = [&](int x, int y) { return static_cast<size_t>(y * grid.cells.x + x); };
    CellFound out;
    int count = 0;
    for (int y = std::max(cell.y - 1, 0); y <= std::min(cell.y + 1, grid.cells.y - 1); ++y)
        for (int x = std::max(cell.x - 1, 0); x <= std::min(cell.x + 1, grid.cells.x - 1); ++x) {
            out.ordinary.add(found[index(x, y)].ordinary);
            ++count;
        }
    out.ordinary.scale(1. / count);
    out.sent = targets.in_cell(index(cell.x, cell.y), grid.cell(cell.x, cell.y));
    return out;
}

/// Noise of a sample of a cell, as a relative standard deviation, and its cost.
struct Effort {
    double noise = 0, cost = 0;
    uint32_t rays = 0;   ///< to targets
    size_t targets = 0;  ///< the first so many of the order

    [[nodiscard]] double product() const { return noise * noise * cost; }
};

/// The efforts of a cell with no target, with the worst one, the two worst ones, and so on.
struct CellChoice {
    std::vector<size_t> order;
    std::vector<double> roots;    ///< of the mean square of what each target brings
    std::vector<double> seen;     ///< share of each one's light that may be expected
    std::vector<Effort> efforts;  ///< with none, and for each number of targets and of rays
    size_t taken = 0;
};

/// The place of a cell that is nearest to a film point.
size_t place_of(V2f film, const camera::FilmCell& part) {
    const V2f within = (film - part.first) / (part.last - part.first) * float(kPlaces);
    const auto along = [](float at) {
        return static_cast<size_t>(std::clamp(at, 0.f, float(kPlaces) - 0.5f));
    };
    return along(within.y) * kPlaces + along(within.x);
}

/// dark: luminance from which on variance is relative to the cell's own.
CellChoice choice_of(const camera::TargetCell& cell, const camera::FilmCell& part,
                     const CellFound& found, double dark) {
    CellChoice out;
    for (size_t k = 0; k < cell.targets.size(); ++k)
        if (found.sent[k].counted2 > 0) out.order.push_back(k);
    std::stable_sort(out.order.begin(), out.order.end(), [&](size_t a, size_t b) {
        return found.sent[a].spread() > found.sent[b].spread();
    });
    const PilotFound& ordinary = found.ordinary;
    double mean = ordinary.counted, rest = ordinary.spread();
    for (const PilotFound& sent : found.sent) {
        out.roots.push_back(std::sqrt(sent.counted2));
        out.seen.push_back(sent.seen);
        mean += sent.counted, rest += sent.spread();
    }
    const double scale = 1 / (mean * mean + dark * dark);
    const double usual = ordinary.cost + kLensCost;
    out.efforts.reserve(1 + std::bit_width(camera::TargetCell::kMostRays) * out.order.size());
    out.efforts.push_back({std::sqrt(rest * scale), usual});
    // At places of the cell: what its targets bring that may be seen from there.
    struct Place {
        double roots = 0, light = 0, cost = 0;
    };
    std::array<Place, kPlaces * kPlaces> places;
    size_t targets_taken = 0;
    for (const size_t k : out.order) {
        ++targets_taken;
        const PilotFound& sent = found.sent[k];
        rest -= sent.spread();
        const double search =
            kSentCost + kEvaluationCost * static_cast<double>(cell.targets[k].search);
        std::array<bool, kPlaces * kPlaces> sees{};
        double seen = 0;
        for (size_t n = 0; n < places.size(); ++n) {
            const V2f within((float(n % kPlaces) + 0.5f) / kPlaces,
                             (float(n / kPlaces) + 0.5f) / kPlaces);
            const V2f film = part.first + within * (part.last - part.first);
            sees[n] = cell.targets[k].seen_from.contains(camera::FilmOctagon::along(film));
            seen += sees[n] ? 1. / double(places.size()) : 0;
        }
        // What lies between places is seen from the nearest one.
        if (seen == 0) {
            const camera::FilmCell from = cell.targets[k].seen_from.within(part);
            sees[place_of((from.first + from.last) / 2.f, part)] = true;
            seen = 1. / double(places.size());
        }
        out.roots[k] /= std::sqrt(seen);
        double spread = 0, cost = 0;
        for (size_t n = 0; n < places.size(); ++n) {
            Place& place = places[n];
            if (sees[n]) {
                place.roots += out.roots[k], place.light += sent.counted / seen;
                place.cost += out.roots[k] * (sent.cost / seen + search);
            }
            if (place.roots > 0) cost += place.cost / place.roots / double(places.size());
            spread += std::max(0., place.roots * place.roots - place.light * place.light) /
                      double(places.size());
        }
        // More rays lower what they bring to the variance, and cost more.
        for (uint32_t rays = 1; rays <= camera::TargetCell::kMostRays; rays *= 2)
            out.efforts.push_back({std::sqrt((std::max(0., rest) + spread / rays) * scale),
                                   usual + rays * cost, rays, targets_taken});
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

std::shared_ptr<const camera::TargetGrid> targets_that_pay(const camera::TargetCamera& camera,
                                                           const Scene& scene, const Bvh& bvh,
                                                           const LightChoice& lights, V2i frame_px,
                                                           const camera::RunTasks& run) {
    const camera::TargetGrid* const all = camera.targets().get();
    if (!all) return nullptr;
    const PathTracer<> tracer(scene, bvh, lights, {});
    const CellPilot pilot(camera, tracer, frame_px);
    const auto cell_px =
        static_cast<uint32_t>(frame_px.x / all->cells.x * (frame_px.y / all->cells.y));
    const uint32_t count = std::clamp(cell_px / kPixelsPerSample, kFewest, kOrdinary);
    PooledTargets at_targets(*all, frame_px);
    std::vector<CellFound> found(all->lists.size());
    camera::run_cells(run, all->cells, [&](size_t n, V2i cell) {
        const camera::FilmCell part = all->cell(cell.x, cell.y);
        found[n].ordinary = pilot.samples(cell, part, 0, count, all->lists[n], false);
        uint32_t begin = count;
        for (const camera::ListedTarget& target : all->lists[n].targets) {
            PilotFound& sent = found[n].sent.emplace_back();
            const double share = seen_share(target, part);
            const uint32_t rays = share > 0 ? at_targets.rays_from(n, target, share) : 0;
            if (rays == 0) continue;
            camera::TargetCell alone{all->lists[n].map, {target}};
            alone.targets[0].chance = 1;
            alone.light_nits = static_cast<float>(light_of(all->lists[n], target));
            sent = pilot.samples(cell, target.seen_from.within(part), begin, rays, alone, true);
            begin += rays;
            sent.scale(share);
        }
    });
    double mean = 0;
    for (size_t n = 0; n < found.size(); ++n) {
        mean += found[n].ordinary.counted;
        for (const PilotFound& sent : found[n].sent) mean += sent.counted;
        at_targets.add(n, found[n].sent);
    }
    at_targets.finish();
    const double dark = kDark * mean / static_cast<double>(found.size());
    std::vector<CellChoice> cells(found.size());
    camera::run_cells(run, all->cells, [&](size_t n, V2i cell) {
        cells[n] = choice_of(all->lists[n], all->cell(cell.x, cell.y),
                             pooled(*all, found, at_targets, cell), dark);
    });
    const Effort without = sum_of(cells);
    take_best(cells);
    const Effort with = sum_of(cells);
    if (!(with.product() < kWorthIt * without.product())) return nullptr;
    auto out = std::make_shared<camera::TargetGrid>();
    out->cells = all->cells;
    out->targets = all->targets;
    for (const CellChoice& cell : cells) {
        const camera::TargetCell& from = all->lists[out->lists.size()];
        camera::TargetCell& kept = out->lists.emplace_back();
        const auto [noise, cost, rays, targets] = cell.efforts[cell.taken];
        if (targets > 0) kept.map = from.map;
        kept.light_nits = from.light_nits;
        kept.rays = rays;
        double sum = 0, seen = 0;
        for (size_t n = 0; n < targets; ++n)
            sum += cell.roots[cell.order[n]], seen += cell.seen[cell.order[n]];
        for (size_t n = 0; n < targets; ++n) {
            kept.targets.push_back(from.targets[cell.order[n]]);
            // Few rays know the light badly: no target that pays is sent next to nothing.
            const double even = cell.seen[cell.order[n]] / seen;
            kept.targets.back().chance =
                static_cast<float>(std::lerp(cell.roots[cell.order[n]] / sum, even, kEvenly));
        }
    }
    return out;
}

}  // namespace petzval::integrator
