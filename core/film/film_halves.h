// SPDX-License-Identifier: Apache-2.0
// Halves of a film: sums of the even and of the odd samples of each pixel apart, which a denoiser
// needs to know its own error.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/film/exact_sum.h"
#include "core/math/math.h"

namespace petzval {

/// What guides a denoiser: the first surface that a sample sees which is not perfectly smooth, so
/// that glass and mirrors are looked through.
struct Guide {
    bool hit;  ///< or the rest is unset
    V3f albedo, normal;
    float distance_m;  ///< from the camera
};

/// Numbers of a guide, each within -1 and 1: albedo, normal, distance, and 1 where something was
/// hit.
inline constexpr size_t kGuideNumbers = 8;

/// How far a denoiser looks from a pixel: a part of a frame that is to be denoised keeps so much
/// around it.
inline constexpr int kDenoiserReach_px = 34;

/// Halves of a pixel's samples: each has a sequence of its own, so that they are independent.
inline constexpr uint32_t kHalves = 2;

/// Half of a sample: 0 or 1.
[[nodiscard]] constexpr uint32_t half_of(uint32_t index) {
    return index % kHalves;
}

/// What a film keeps beside its sums; the owner numbers the pixels.
class FilmHalves {
  public:
    explicit FilmHalves(size_t pixels) : pixels_(pixels) {}
    [[nodiscard]] static constexpr size_t bytes_per_pixel() { return sizeof(Pixel); }

    /// Adds a sample that the film took: its R, G, B.
    void add(size_t pixel, uint32_t index, const V3f& colour, const Guide& guide) {
        const size_t half = half_of(index);
        Sums& to = pixels_[pixel].halves[half];
        ++pixels_[pixel].count[half];
        for (int i = 0; i < 3; ++i) {
            to.colour[static_cast<size_t>(i)].add(colour[i]);
            to.squares[static_cast<size_t>(i)].add(std::min(colour[i] * colour[i], kLargestSquare));
        }
        if (!guide.hit) return;
        const V3f &albedo = guide.albedo, &normal = guide.normal;
        const std::array<float, kGuideNumbers> numbers{
            albedo.x, albedo.y, albedo.z, normal.x, normal.y, normal.z, log_of(guide.distance_m),
            1.f};
        for (size_t i = 0; i < kGuideNumbers; ++i) to.guide[i] += fixed(numbers[i]);
    }

    /// Means of a half of a pixel; zero without samples.
    struct Half {
        V3f colour;    ///< nits
        V3f variance;  ///< of colour, as if samples were independent; its square for a single one
        std::array<float, kGuideNumbers> guide;
        uint32_t count;  ///< samples
    };
    [[nodiscard]] Half half(size_t pixel, uint32_t half) const;

    void pack(size_t pixel, uint8_t* to) const { std::memcpy(to, &pixels_[pixel], sizeof(Pixel)); }
    /// Adds what pack() wrote.
    void add_packed(size_t pixel, const uint8_t* from);
    /// Whether a pixel with so many samples can have what pack() wrote.
    [[nodiscard]] static bool is_possible(const uint8_t* from, uint32_t count);

  private:
    static constexpr float kLargestSquare = 1e18f;  ///< below SquareSum's limit
    static constexpr double kOne = 4294967296.;  ///< 2^32 units: 2^30 samples stay within 62 bits

    struct Sums {
        std::array<FilmSum, 3> colour{};
        std::array<SquareSum, 3> squares{};
        std::array<int64_t, kGuideNumbers> guide{};
    };
    struct Pixel {
        std::array<Sums, kHalves> halves{};
        std::array<uint32_t, kHalves> count{};
    };
    /// Logarithm to base 2 by the bits of a float, straight from one power of two to the next; as a
    /// share of 128.
    [[nodiscard]] static float log_of(float value) {
        constexpr float kOneInBits = 8388608.f;
        return (static_cast<float>(std::bit_cast<int32_t>(value)) / kOneInBits - 127.f) / 128.f;
    }
    [[nodiscard]] static int64_t fixed(float value) {
        return value >= -1.f && value <= 1.f ? static_cast<int64_t>(double(value) * kOne)
                                             : static_cast<int64_t>(value > 1.f ? kOne : 0.);
    }

    std::vector<Pixel> pixels_;
};

}  // namespace petzval
