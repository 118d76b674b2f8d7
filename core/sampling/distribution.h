// SPDX-License-Identifier: Apache-2.0
// Piecewise-constant densities that can be sampled; both keep the stratification of their input.
#pragma once

#include <immintrin.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "core/math/math.h"

namespace petzval {

/// Units that make up a probability of 1. Probabilities are whole multiples of 2^-24, the grain of
/// the sampler's numbers: what is drawn and what is said to be drawn then agree to the last bit.
inline constexpr uint32_t kDistributionUnits = 1u << 24;

/// Density over [0, 1) in equal cells. Inversion by a guide table (Chen and Asau 1974), so that a
/// draw costs the same for a thousand cells and for a million: two comparisons on average.
class Piecewise1D {
  public:
    Piecewise1D() = default;
    /// Weights must be finite and not negative, with at least one above 0. A weight of 0 is never
    /// drawn; each other one has at least a probability of 2^-24, unless they are more than 2^23.
    explicit Piecewise1D(std::span<const float> weights);

    struct Draw {
        uint32_t cell;
        float offset;       ///< position within the cell, [0, 1): may be used again
        float probability;  ///< of the cell
    };
    /// Draws a cell; u in [0, 1]. The cell does not decrease as u grows.
    [[nodiscard]] inline Draw sample(float u) const;
    [[nodiscard]] float probability(uint32_t cell) const {
        return static_cast<float>(cdf_[cell + 1] - cdf_[cell]) / kDistributionUnits;
    }
    [[nodiscard]] uint32_t size() const { return static_cast<uint32_t>(guide_.size()); }
    [[nodiscard]] double sum() const { return sum_; }  ///< of the weights

  private:
    friend class Piecewise2D;
    [[nodiscard]] static uint32_t units_of(float position) {
        return std::min(static_cast<uint32_t>(position), kDistributionUnits - 1);
    }
    [[nodiscard]] uint32_t find_cell(float position) const;
    [[nodiscard]] static Draw draw_in(const uint32_t* cdf, uint32_t cell, float position);

    std::vector<uint32_t> cdf_;    ///< size + 1 values from 0 to kDistributionUnits
    std::vector<uint32_t> guide_;  ///< first cell that a u of k/size can fall in
    uint32_t widest_ = 0;  ///< cell that is tried first: one light often has most of the power
    double sum_ = 0;
};

/// Running sums of rows of numbers, searched without a branch: each row keeps every eighth sum, a
/// cache line or two, and then the sums in eights.
class RunningSums {
  public:
    RunningSums() = default;
    RunningSums(uint32_t width, uint32_t rows)
        : sums_in_row_((width + kEight) / kEight * kEight),
          tops_in_row_((width / kEight + kEight - 1) / kEight * kEight),
          sums_(size_t{sums_in_row_} * rows, kDistributionUnits),
          tops_(size_t{tops_in_row_} * rows, kDistributionUnits) {}
    /// The width + 1 sums of a row, which do not decrease, from 0 to kDistributionUnits. index_row
    /// must follow when they are filled in.
    [[nodiscard]] uint32_t* row(size_t i) { return &sums_[i * sums_in_row_]; }
    [[nodiscard]] const uint32_t* row(size_t i) const { return &sums_[i * sums_in_row_]; }
    void index_row(size_t i);
    /// Index of the last sum of a row that is not above unit < kDistributionUnits.
    [[nodiscard]] uint32_t find(size_t i, uint32_t unit) const {
        const uint32_t* tops = tops_.data() + i * tops_in_row_;
        uint32_t eights = 0;
        for (uint32_t k = 0; k < tops_in_row_; k += kEight) eights += not_above(tops + k, unit);
        return eights * kEight + not_above(row(i) + eights * kEight, unit) - 1;
    }

  private:
    static constexpr uint32_t kEight = 8;
    typedef int32_t i32x8 __attribute__((vector_size(32)));
    [[nodiscard]] static uint32_t not_above(const uint32_t* eight, uint32_t unit) {
        i32x8 sums;
        std::memcpy(&sums, eight, sizeof sums);
        const i32x8 above = sums > static_cast<int32_t>(unit);
        return kEight - static_cast<uint32_t>(std::popcount(
                            static_cast<uint32_t>(_mm256_movemask_ps((__m256)above))));
    }

    uint32_t sums_in_row_ = 0, tops_in_row_ = 0;
    std::vector<uint32_t> sums_;
    std::vector<uint32_t> tops_;  ///< 8th, 16th ... sum of each row
};

/// Density over [0, 1)^2 in width x height cells, row by row.
class Piecewise2D {
  public:
    Piecewise2D() = default;
    /// Weights as for Piecewise1D, width * height of them, row by row; width at most 65536.
    Piecewise2D(std::span<const float> weights, uint32_t width, uint32_t height);

    struct Draw {
        uint32_t column, row;
        V2f offset;         ///< position within the cell, [0, 1)^2
        float probability;  ///< of the cell; its density by area is this * width * height
    };
    /// Draws a cell; u in [0, 1]^2: u.y draws the row, u.x the cell in it.
    [[nodiscard]] Draw sample(V2f u) const;
    [[nodiscard]] float probability(uint32_t column, uint32_t row) const;

    /// Draw of a cell in whole units, for a caller that divides cells further.
    struct UnitDraw {
        uint32_t column, row;
        float row_offset;      ///< position within the row, [0, 1)
        uint32_t units, unit;  ///< the cell's share of its row, and which of them was drawn
        float rest;            ///< excess of u.x over that unit, [0, 1]
    };
    [[nodiscard]] inline UnitDraw sample_units(V2f u) const;
    /// Share of a cell in its row, in units of 1 / kDistributionUnits.
    [[nodiscard]] uint32_t units(uint32_t column, uint32_t row) const {
        const uint32_t* sums = rows_.row(row) + column;
        return sums[1] - sums[0];
    }
    /// Fetches ahead what units(column, row) reads.
    void prefetch(uint32_t column, uint32_t row) const {
        __builtin_prefetch(rows_.row(row) + column);
    }
    [[nodiscard]] float row_probability(uint32_t row) const {
        const uint32_t* sums = marginal_.row(0) + row;
        return static_cast<float>(sums[1] - sums[0]) / kDistributionUnits;
    }

    [[nodiscard]] uint32_t width() const { return width_; }
    [[nodiscard]] uint32_t height() const { return height_; }
    [[nodiscard]] double sum() const { return sum_; }  ///< of the weights

  private:
    uint32_t width_ = 0, height_ = 0;
    RunningSums rows_;      ///< sums of the rows that have weight; the others are all 0
    RunningSums marginal_;  ///< one row: sums over the rows
    double sum_ = 0;
};

// Inline: a Draw that crosses a call is packed into registers, and taking it apart again costs as
// much as the search (36 against 63 ns for a direction of the sky).

inline uint32_t Piecewise1D::find_cell(float position) const {
    const uint32_t units = units_of(position);
    uint32_t cell = guide_[static_cast<uint64_t>(units) * size() / kDistributionUnits];
    while (cdf_[cell + 1] <= units) ++cell;
    return cell;
}

inline Piecewise1D::Draw Piecewise1D::draw_in(const uint32_t* cdf, uint32_t cell, float position) {
    const float width = static_cast<float>(cdf[cell + 1] - cdf[cell]);
    const float offset = (position - static_cast<float>(cdf[cell])) / width;
    return {cell, std::min(offset, kOneMinus), width / kDistributionUnits};
}

inline Piecewise1D::Draw Piecewise1D::sample(float u) const {
    const float position = u * kDistributionUnits;
    const uint32_t units = units_of(position);
    const bool common = units >= cdf_[widest_] && units < cdf_[widest_ + 1];
    const uint32_t cell = common ? widest_ : find_cell(position);
    return draw_in(cdf_.data(), cell, position);
}

inline Piecewise2D::UnitDraw Piecewise2D::sample_units(V2f u) const {
    const float y = u.y * kDistributionUnits, x = u.x * kDistributionUnits;
    const uint32_t row = marginal_.find(0, Piecewise1D::units_of(y));
    const uint32_t unit = Piecewise1D::units_of(x), column = rows_.find(row, unit);
    const uint32_t* sums = rows_.row(row) + column;
    return {column,
            row,
            Piecewise1D::draw_in(marginal_.row(0), row, y).offset,
            sums[1] - sums[0],
            unit - sums[0],
            x - static_cast<float>(unit)};
}

}  // namespace petzval
