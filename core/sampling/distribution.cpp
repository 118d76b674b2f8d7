// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/distribution.h"

#include <numeric>

namespace petzval {
namespace {

double sum_of(std::span<const float> weights) {
    return std::accumulate(weights.begin(), weights.end(), 0.0);
}

// The weight that makes at least one unit of n cells' share, whatever the others weigh.
double least_weight(double sum, ptrdiff_t n) {
    constexpr double slack = 1 + 1e-9;  // for the rounding of the running sum
    return n <= kDistributionUnits / 2 ? slack * sum / (kDistributionUnits - n) : 0;
}

void fill_cdf(std::span<const float> weights, double sum, uint32_t* cdf) {
    const auto positive =
        std::count_if(weights.begin(), weights.end(), [](float w) { return w > 0; });
    const double least = least_weight(sum, positive);
    const auto lifted = [least](float w) { return w > 0 ? std::max<double>(w, least) : 0.0; };
    double total = 0, running = 0;
    for (const float w : weights) total += lifted(w);
    const double scale = kDistributionUnits / total;
    cdf[0] = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
        running += lifted(weights[i]);
        // Rounding is monotone: no weight, no width, and a unit of weight has a unit of width.
        cdf[i + 1] = static_cast<uint32_t>(running * scale + 0.5);
    }
}

void fill_guide(const uint32_t* cdf, uint32_t size, uint32_t* guide) {
    uint32_t cell = 0;
    for (uint64_t k = 0; k < size; ++k) {
        const uint64_t first = (k * kDistributionUnits + size - 1) / size;
        while (cell + 1 < size && cdf[cell + 1] <= first) ++cell;
        guide[k] = cell;
    }
}

}  // namespace

Piecewise1D::Piecewise1D(std::span<const float> weights)
    : cdf_(weights.size() + 1), guide_(weights.size()), sum_(sum_of(weights)) {
    fill_cdf(weights, sum_, cdf_.data());
    fill_guide(cdf_.data(), size(), guide_.data());
    for (uint32_t i = 1; i < size(); ++i)
        if (cdf_[i + 1] - cdf_[i] > cdf_[widest_ + 1] - cdf_[widest_]) widest_ = i;
}

void RunningSums::index_row(size_t i) {
    for (uint32_t k = kEight; k < sums_in_row_; k += kEight)
        tops_[i * tops_in_row_ + k / kEight - 1] = row(i)[k];
}

Piecewise2D::Piecewise2D(std::span<const float> weights, uint32_t width, uint32_t height)
    : width_(width), height_(height), rows_(width, height), marginal_(height, 1) {
    std::vector<float> row_sums(height);
    for (size_t row = 0; row < height; ++row) {
        const auto row_weights = weights.subspan(row * width, width);
        const double sum = sum_of(row_weights);
        row_sums[row] = static_cast<float>(sum);
        if (row_sums[row] > 0)
            fill_cdf(row_weights, sum, rows_.row(row));
        else
            std::fill_n(rows_.row(row), width + 1, 0);
        rows_.index_row(row);
    }
    sum_ = sum_of(row_sums);
    fill_cdf(row_sums, sum_, marginal_.row(0));
    marginal_.index_row(0);
}

Piecewise2D::Draw Piecewise2D::sample(V2f u) const {
    const UnitDraw drawn = sample_units(u);
    const float offset =
        (static_cast<float>(drawn.unit) + drawn.rest) / static_cast<float>(drawn.units);
    return {drawn.column,
            drawn.row,
            {std::min(offset, kOneMinus), drawn.row_offset},
            probability(drawn.column, drawn.row)};
}

float Piecewise2D::probability(uint32_t column, uint32_t row) const {
    return row_probability(row) * (static_cast<float>(units(column, row)) / kDistributionUnits);
}

}  // namespace petzval
