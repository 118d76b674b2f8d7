// SPDX-License-Identifier: Apache-2.0
// What the denoiser knows of a tile and its surroundings, from one half of the samples.
#pragma once

#include <array>
#include <cstring>
#include <memory>
#include <vector>

#include "core/film/film.h"
#include "core/math/lanes.h"
#include "integrator/denoise/denoise.h"

namespace petzval::integrator {

[[nodiscard]] inline f8 load8(const float* from) {
    f8 out;
    std::memcpy(&out, from, sizeof out);
    return out;
}
inline void store8(float* to, f8 value) {
    std::memcpy(to, &value, sizeof value);
}
[[nodiscard]] inline f8 min(f8 a, f8 b) {
    return a < b ? a : b;
}

/// Bins of a half of a pixel of a film with halves and bins, as many as it has.
inline void half_bins(const Film& film, int x, int y, uint32_t half, float* out) {
    film.spectral()->half_bin_means(film.offset(x, y), half, film.half(x, y, half).count, out);
}

/// Planes of numbers about a tile. Pixels beyond the frame are 0, and so is `inside` there.
struct HalfTile {
    static constexpr int kReach = 12, kSide = kDenoiserTile_px + 2 * kReach;
    /// One more row of eight: what is read eight at once may begin at the last number.
    using Plane = std::array<float, kSide * kSide + 8>;

    std::array<Plane, 3> colour;    ///< without lonely bright pixels
    std::array<Plane, 3> variance;  ///< of colour
    std::array<Plane, kGuideNumbers> guide;
    std::vector<Plane> bins;  ///< of a film with bins: dimmed as colour is
    Plane inside;             ///< 1, and 0 beyond the frame

    /// Index of a pixel by its place in the tile.
    [[nodiscard]] static constexpr int index(int x, int y) {
        return (y + kReach) * kSide + x + kReach;
    }
    /// From a half of a film's samples; tile: its first pixel.
    HalfTile(const Film&, V2i tile, uint32_t half);

  private:
    void read(const Film&, V2i tile, uint32_t half);
    void dim_lonely_pixels();
    void share_variance();
};

}  // namespace petzval::integrator
