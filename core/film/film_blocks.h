// SPDX-License-Identifier: Apache-2.0
// Blocks of a film: means of the first samples of each pixel, which tell its noise by how they
// part.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/math/math.h"

namespace petzval {

/// What a film keeps beside its sums; the owner numbers the pixels. A block is closed where a pixel
/// has a power of two of samples and gets more.
class FilmBlocks {
  public:
    explicit FilmBlocks(size_t pixels) : pixels_(pixels) {}
    [[nodiscard]] static constexpr size_t bytes_per_pixel() { return sizeof(Pixel); }

    /// Takes notice of a sample that the film took: its R, G, B.
    void add(size_t pixel, const V3f& colour) {
        float& most = pixels_[pixel].largest;
        most = std::max({most, std::abs(colour.x), std::abs(colour.y), std::abs(colour.z)});
    }
    /// Closes a block: the mean of the samples so far.
    void close(size_t pixel, const V3f& mean) {
        auto& means = pixels_[pixel].means;
        means = {mean, means[0], means[1]};
    }

    /// Means of the first P, P / 2 and P / 4 samples, P being the largest power of two that there
    /// are; of all; and the largest R, G or B of a sample.
    struct Parts {
        std::array<V3f, 3> means;
        V3f all;
        float largest;
    };
    /// count: samples of the pixel, of which this is the mean.
    [[nodiscard]] Parts parts(size_t pixel, uint32_t count, const V3f& mean) const {
        const Pixel& p = pixels_[pixel];
        if (!std::has_single_bit(count)) return {p.means, mean, p.largest};
        return {{mean, p.means[0], p.means[1]}, mean, p.largest};
    }

    void pack(size_t pixel, uint8_t* to) const { std::memcpy(to, &pixels_[pixel], sizeof(Pixel)); }
    /// Adds what pack() wrote; one of both must have no samples.
    void add_packed(size_t pixel, const uint8_t* from) {
        Pixel other, &p = pixels_[pixel];
        std::memcpy(static_cast<void*>(&other), from, sizeof other);
        for (size_t i = 0; i < p.means.size(); ++i) p.means[i] += other.means[i];
        p.largest = std::max(p.largest, other.largest);
    }

  private:
    struct Pixel {
        std::array<V3f, 3> means{V3f(0.f), V3f(0.f), V3f(0.f)};  ///< of blocks, the last one first
        float largest = 0;
    };
    std::vector<Pixel> pixels_;
};

}  // namespace petzval
