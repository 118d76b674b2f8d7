// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/stop_bounds.h"

#include <algorithm>
#include <cmath>

namespace petzval::camera {
namespace {

constexpr int kRings = 24, kRows = StopBounds::kRows, kHalvings = 5;
// Added to each half width, over the reach: rims curve between the lines that are tested, and shift
// with the wavelength.
constexpr float kMargin = 0.01f;
// Bounds that take less than this off the area do not pay for themselves.
constexpr double kUsefulShare = 0.9;

using Edges = std::array<float, kRows + 1>;

float chord(float reach, float y) {
    return std::sqrt(std::max(0.f, reach * reach - y * y));
}

// Half widths of what passes along the edges of the rows, rounded up; eight edges at a time.
Edges open_along_edges(const StopBoundsByHeight::Passes& passes, float height, float reach) {
    Edges out{};
    for (int first = 0; first <= kRows; first += 8) {
        f8 y, closed;
        for (int k = 0; k < 8; ++k) {
            y[k] = reach * (2.f * static_cast<float>(std::min(first + k, kRows)) / kRows - 1.f);
            closed[k] = chord(reach, y[k]);
        }
        const m8 any_open = passes(height, f8{}, y);
        f8 open = passes(height, closed, y) ? closed : f8{};
        for (int i = 0; i < kHalvings; ++i) {
            const f8 middle = 0.5f * (open + closed);
            const m8 on = passes(height, middle, y);
            open = on ? middle : open, closed = on ? closed : middle;
        }
        for (int k = 0; k < 8 && first + k <= kRows; ++k)
            if (any_open[k])
                out[static_cast<size_t>(first + k)] = std::max(closed[k], kMargin * reach);
    }
    return out;
}

}  // namespace

StopBounds::StopBounds(float reach_mm, const std::array<float, kRows>& half_width_mm)
    : reach_(reach_mm), half_width_(half_width_mm) {
    const float row = 2.f * reach_ / kRows;
    for (size_t j = 0; j < kRows; ++j)
        area_below_[j + 1] = area_below_[j] + 2.f * half_width_[j] * row;
    area_ = area_below_[kRows];
}

V2f StopBounds::sample(V2f u) const {
    const float area = u.y * area_;
    const auto above = std::upper_bound(area_below_.begin() + 1, area_below_.end() - 1, area);
    const auto row = static_cast<size_t>(above - area_below_.begin()) - 1;
    const float within = (area - area_below_[row]) / (area_below_[row + 1] - area_below_[row]);
    const float y = (static_cast<float>(row) + std::clamp(within, 0.f, kOneMinus)) * (2.f / kRows);
    return {(2.f * u.x - 1.f) * half_width_[row], reach_ * (y - 1.f)};
}

bool StopBounds::contain(V2f point_mm) const {
    const float row = (point_mm.y / reach_ + 1.f) * (0.5f * kRows);
    if (!(row >= 0.f && row < kRows)) return false;
    return std::fabs(point_mm.x) <= half_width_[static_cast<size_t>(row)];
}

StopBoundsByHeight::StopBoundsByHeight(const Passes& passes, float film_reach_mm,
                                       float stop_reach_mm, double area_mm2) {
    std::vector<Edges> open;
    for (int k = 0; k <= kRings; ++k)
        open.push_back(open_along_edges(passes, film_reach_mm * static_cast<float>(k) / kRings,
                                        stop_reach_mm));
    const float row = 2.f * stop_reach_mm / kRows;
    for (size_t k = 0; k < kRings; ++k) {
        std::array<float, kRows> half_width{};
        for (size_t j = 0; j < kRows; ++j) {
            // A row whose edges are closed may hold the tip of what its neighbours show.
            const auto widest = [&](size_t first, size_t last) {
                float w = 0.f;
                for (size_t i = first; i <= last; ++i)
                    w = std::max({w, open[k][i], open[k + 1][i]});
                return w;
            };
            float w = widest(j, j + 1);
            if (w == 0.f) w = widest(j > 0 ? j - 1 : 0, std::min<size_t>(j + 2, kRows));
            if (w == 0.f) continue;
            const float low = stop_reach_mm - row * static_cast<float>(j);
            const float nearest = std::max({0.f, low - row, -low});
            half_width[j] = std::min(w + kMargin * stop_reach_mm, chord(stop_reach_mm, nearest));
        }
        std::optional<StopBounds>& ring = rings_.emplace_back();
        ring.emplace(stop_reach_mm, half_width);
        const double area = double(ring->area_mm2());
        if (!(area > 0. && area < kUsefulShare * area_mm2)) ring.reset();
    }
    rings_per_mm_ = kRings / film_reach_mm;
}

const StopBounds* StopBoundsByHeight::at(float height_mm) const {
    if (rings_.empty()) return nullptr;
    // Written so that a height that is not a number takes the first ring.
    const float last = static_cast<float>(rings_.size() - 1), ring = height_mm * rings_per_mm_;
    const auto& bounds = rings_[static_cast<size_t>(ring > 0.f ? std::min(ring, last) : 0.f)];
    return bounds ? &*bounds : nullptr;
}

}  // namespace petzval::camera
