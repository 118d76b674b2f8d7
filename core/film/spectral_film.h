// SPDX-License-Identifier: Apache-2.0
// Spectral film: what a film keeps beside RGB for a reference, wavelength bins, XYZ and standard
// errors.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/film/exact_sum.h"
#include "core/film/film_halves.h"
#include "core/film/sample_range.h"
#include "core/math/math.h"
#include "core/spectrum/bands.h"
#include "core/spectrum/bins.h"

namespace petzval {

/// Number of independent replicates of the sample sequence. The spread of their means tells the
/// error of the whole, which one scrambled sequence cannot tell of itself (Owen 1997).
inline constexpr uint32_t kReplicates = 8;

/// Sums over the samples of each pixel; the owner numbers the pixels.
class SpectralFilm {
  public:
    /// Memory that it takes for each pixel; halves: those of the bins are kept apart.
    [[nodiscard]] static size_t bytes_per_pixel(const Bins& bins, bool halves) {
        return sizeof(SpectralSum) * sums_per_pixel(bins, halves) + sizeof(Tristimulus) +
               sizeof(ReplicateSums);
    }
    SpectralFilm(size_t pixels, const Bins&, bool halves = false);

    /// A sample's estimates.
    struct Sample {
        uint32_t replicate;  ///< < kReplicates
        f4 radiance;
        V3f xyz;

        [[nodiscard]] bool finite() const;
    };
    /// Whether a sample's numbers are within the range of the sums.
    [[nodiscard]] bool holds(const Sample&, const Bands&) const;
    /// Adds a sample that holds().
    void add(size_t pixel, Rgb colour, const Sample&, const Bands&);

    [[nodiscard]] const Bins& bins() const { return bins_; }
    /// Band averages, W/(m2 sr nm), bins().count of them: means over `count` samples.
    void bin_means(size_t pixel, uint32_t count, float* out) const;
    /// The same of a half of the samples, of which there are `count`, on a film with halves.
    void half_bin_means(size_t pixel, uint32_t half, uint32_t count, float* out) const;
    [[nodiscard]] V3f xyz(size_t pixel, uint32_t count) const;  ///< nits
    /// Standard error of the mean of R, G and B over all samples of a range, of which each was
    /// dealt to the replicate that its index says; infinite where the range has fewer than
    /// kReplicates samples.
    [[nodiscard]] V3f standard_error(size_t pixel, SampleRange) const;
    /// Standard error of the mean luminance, likewise.
    [[nodiscard]] float luminance_error(size_t pixel, SampleRange) const;

    /// Writes a pixel's sums as bytes_per_pixel() bytes.
    void pack(size_t pixel, uint8_t* to) const;
    /// Adds a pixel's sums that pack() wrote.
    void add_packed(size_t pixel, const uint8_t* from);

  private:
    using Tristimulus = std::array<FilmSum, 3>;
    using ReplicateSums = std::array<Tristimulus, kReplicates>;
    [[nodiscard]] static size_t sums_per_pixel(const Bins& bins, bool halves) {
        return static_cast<size_t>(bins.count) * (halves ? kHalves : 1);
    }
    [[nodiscard]] f4 bin_values(f4 radiance, const Bands&) const;
    template <class Number>
    [[nodiscard]] float error_of(size_t pixel, SampleRange, const Number&) const;

    Bins bins_;
    size_t each_;                        ///< sums of a pixel: bins, of each half
    std::vector<SpectralSum> bin_sums_;  ///< pixel-major
    std::vector<Tristimulus> xyz_sums_;
    std::vector<ReplicateSums> replicate_sums_;
};

}  // namespace petzval
