// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/pilot_pixels.h"

#include <algorithm>
#include <map>
#include <set>

#include "core/sampling/distribution.h"
#include "integrator/prepass/pilot_pixels.h"

namespace petzval::apps {
namespace {

constexpr double kRegionShare = 0.25, kEmphasisShare = 0.25;
/// A region larger than this share of the frame gets no pilot pixels of its own: the even ones meet
/// it.
constexpr double kLargeRegion = 0.125;

/// Random number in [0, 2^32) for the i-th draw of a purpose.
uint32_t drawn(uint32_t seed, uint32_t purpose, uint32_t i) {
    return hash32(hash32(hash32(seed, 0x6c6f6f6b), purpose), i);
}

int64_t within(int64_t count, uint32_t random) {
    return (int64_t{random} * count) >> 32;
}

/// Bounds of a cell along one side.
std::array<int, 2> bounds(int cell, int cells, int side_px) {
    return {static_cast<int>((int64_t{cell} * side_px + cells - 1) / cells),
            static_cast<int>((int64_t{cell + 1} * side_px + cells - 1) / cells)};
}

/// First pixels of the cells of two grids along one side.
std::set<int> starts(int cells, int other_cells, int side_px) {
    std::set<int> out;
    for (const int count : {cells, other_cells})
        for (int i = 0; i < count; ++i)
            if (const auto [from, to] = bounds(i, count, side_px); from < to) out.insert(from);
    return out;
}

/// Area and share of the emphasis of each cell.
struct Emphasis {
    std::vector<double> chance;  ///< of a cell
    std::vector<Rect> cells;
    std::vector<double> density;  ///< of a pixel, for one draw
};

Emphasis emphasis_of(V2i size, const FilmMap& map) {
    Emphasis out;
    double sum = 0;
    for (int j = 0; j < map.cells.y; ++j)
        for (int i = 0; i < map.cells.x; ++i) {
            const auto [x0, x1] = bounds(i, map.cells.x, size.x);
            const auto [y0, y1] = bounds(j, map.cells.y, size.y);
            out.cells.push_back({x0, y0, x1, y1});
            const double area = double(x1 - x0) * double(y1 - y0);
            out.chance.push_back(map.values[out.chance.size()] * area);
            sum += out.chance.back();
        }
    for (double& chance : out.chance) chance /= sum;
    for (const double value : map.values) out.density.push_back(value / sum);
    return out;
}

PilotPixels all_pixels(V2i size) {
    PilotPixels out;
    const double weight = 1 / (double(size.x) * double(size.y));
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) out.pixels.push_back({{x, y}, weight, true});
    out.all_certain = true;
    return out;
}

}  // namespace

double PilotPixels::unseen(V2i size_px, const FilmMap& most) const {
    if (all_certain) return 0;
    const double frame_px = double(size_px.x) * double(size_px.y);
    double worst = 0;
    // Both maps are constant between the bounds of the cells of both.
    for (const int y : starts(density.cells.y, most.cells.y, size_px.y))
        for (const int x : starts(density.cells.x, most.cells.x, size_px.x))
            worst = std::max(worst, most.at(size_px, x, y) / density.at(size_px, x, y));
    constexpr double kNoneMet = 3;  // -log(0.05)
    return kNoneMet * worst / frame_px;
}

PilotPixels even_pilot_pixels(V2i size_px, int wanted, uint32_t seed) {
    PilotPixels out;
    const auto pixels = integrator::pilot_pixels(size_px, wanted, seed);
    const auto count = static_cast<double>(pixels.size());
    const double frame = double(size_px.x) * double(size_px.y);
    for (const auto& pixel : pixels)
        out.pixels.push_back(
            {pixel,
             static_cast<double>(integrator::pilot_cell_area_px(size_px, wanted, pixel)) / frame});
    out.density.values = {count / frame};
    return out;
}

PilotPixels choose_pilot_pixels(V2i size_px, int wanted, std::vector<camera::FilmRegion> regions,
                                const FilmMap& emphasis, uint32_t seed) {
    const double pixels = double(size_px.x) * double(size_px.y);
    if (pixels <= wanted) return all_pixels(size_px);
    std::erase_if(regions, [&](const camera::FilmRegion& r) {
        const auto area = static_cast<double>(r.area_px());
        return !(area > 0) || area > kLargeRegion * pixels;
    });
    // Where there are more regions than pilot pixels for them, the small ones need them most.
    const auto of_regions = static_cast<size_t>(std::max(1., kRegionShare * wanted));
    std::stable_sort(regions.begin(), regions.end(),
                     [](const camera::FilmRegion& a, const camera::FilmRegion& b) {
                         return a.area_px() < b.area_px();
                     });
    if (regions.size() > of_regions) regions.resize(of_regions);
    PilotPixels out;
    const auto each = regions.empty() ? 0 : static_cast<int64_t>(of_regions / regions.size());
    const Emphasis emphasized = emphasis_of(size_px, emphasis);
    const auto of_emphasis = static_cast<uint32_t>(kEmphasisShare * wanted);
    const int evenly = wanted - int(of_emphasis) - int(each) * int(regions.size());
    const auto even = integrator::pilot_pixels(size_px, evenly, seed);

    std::set<std::array<int, 2>> certain;
    std::map<std::array<int, 2>, int> times;
    std::vector<const camera::FilmRegion*> sampled;
    for (const camera::FilmRegion& region : regions) {
        const int64_t area = region.area_px();
        if (area > each) {
            sampled.push_back(&region);
            continue;
        }
        for (int64_t i = 0; i < area; ++i) certain.insert(region.pixel(i));
    }
    for (const auto& pixel : even) ++times[pixel];
    for (uint32_t r = 0; r < sampled.size(); ++r)
        for (uint32_t i = 0; i < each; ++i)
            ++times[sampled[r]->pixel(within(sampled[r]->area_px(), drawn(seed, r + 2, i)))];
    const std::vector<float> chances(emphasized.chance.begin(), emphasized.chance.end());
    const Piecewise1D cells(chances);
    for (uint32_t i = 0; i < of_emphasis; ++i) {
        // Stratified over the cells, so that each gets its part.
        const float u = (float(i) + float(drawn(seed, 0, i) >> 8) * 0x1p-24f) / float(of_emphasis);
        const Rect& cell = emphasized.cells[cells.sample(std::min(u, kOneMinus)).cell];
        const uint32_t random = drawn(seed, 1, i);
        ++times[{cell.x0 + static_cast<int>(within(cell.width(), random)),
                 cell.y0 + static_cast<int>(within(cell.height(), hash32(random)))}];
    }

    const double of_even = static_cast<double>(even.size()) / pixels;
    out.density.cells = emphasis.cells;
    out.density.values.clear();
    for (const double density : emphasized.density)
        out.density.values.push_back(of_even + of_emphasis * density);
    for (const auto& pixel : certain) out.pixels.push_back({pixel, 1 / pixels, true});
    for (const auto& [pixel, count] : times) {
        if (certain.contains(pixel)) continue;
        double density =
            emphasized.density[emphasis.cell_at(size_px, pixel[0], pixel[1])] * of_emphasis +
            1 / static_cast<double>(integrator::pilot_cell_area_px(size_px, evenly, pixel));
        for (const camera::FilmRegion* region : sampled)
            if (region->contains(pixel[0], pixel[1]))
                density += static_cast<double>(each) / static_cast<double>(region->area_px());
        out.pixels.push_back({pixel, count / (density * pixels)});
    }
    out.regions = std::move(regions);
    return out;
}

}  // namespace petzval::apps
