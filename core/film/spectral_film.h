// SPDX-License-Identifier: Apache-2.0
// Spectral film: what a film keeps beside RGB for a reference, wavelength bins, XYZ and standard
// errors.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

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
    /// Memory that it takes for each pixel.
    [[nodiscard]] static size_t bytes_per_pixel(const Bins& bins) {
        return sizeof(double) * static_cast<size_t>(bins.count) + sizeof(std::array<double, 3>) +
               sizeof(ReplicateSums);
    }
    SpectralFilm(size_t pixels, const Bins&);

    /// Adds a sample's estimates: colour, XYZ, and lanes of radiance; replicate < kReplicates.
    void add(size_t pixel, uint32_t replicate, Rgb colour, const V3f& xyz, f4 radiance,
             const Bands&);

    [[nodiscard]] const Bins& bins() const { return bins_; }
    /// Band averages, W/(m2 sr nm), bins().count of them: means over `count` samples.
    void bin_means(size_t pixel, uint32_t count, float* out) const;
    [[nodiscard]] V3f xyz(size_t pixel, uint32_t count) const;  ///< nits
    /// Standard error of the mean of R, G and B over `count` samples, dealt to the replicates in
    /// turn; infinite where fewer than kReplicates samples are there.
    [[nodiscard]] V3f standard_error(size_t pixel, uint32_t count) const;
    /// Standard error of the mean luminance, likewise.
    [[nodiscard]] float luminance_error(size_t pixel, uint32_t count) const;

  private:
    using ReplicateSums = std::array<std::array<float, 3>, kReplicates>;
    template <class Number>
    [[nodiscard]] float error_of(size_t pixel, uint32_t count, const Number&) const;

    Bins bins_;
    std::vector<double> bin_sums_;  ///< pixel-major
    std::vector<std::array<double, 3>> xyz_sums_;
    std::vector<ReplicateSums> replicate_sums_;
};

}  // namespace petzval
