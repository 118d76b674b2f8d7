// SPDX-License-Identifier: Apache-2.0
#include "core/film/spectral_film.h"

#include <limits>

namespace petzval {

SpectralFilm::SpectralFilm(size_t pixels, const Bins& bins)
    : bins_(bins),
      bin_sums_(pixels * static_cast<size_t>(bins.count)),
      xyz_sums_(pixels),
      replicate_sums_(pixels) {}

void SpectralFilm::add(size_t pixel, uint32_t replicate, Rgb colour, const V3f& xyz, f4 radiance,
                       const Bands& bands) {
    double* bins = bin_sums_.data() + pixel * static_cast<size_t>(bins_.count);
    const int lanes = lane_count(bands.on);
    for (int i = 0; i < 4; ++i) {
        const int bin = bands.on[i] ? bins_.index(bands.nm[i]) : -1;
        if (bin >= 0) bins[bin] += radiance[i] / (bands.pdf[i] * lanes * bins_.width_nm);
    }
    for (int i = 0; i < 3; ++i) xyz_sums_[pixel][static_cast<size_t>(i)] += xyz[i];
    auto& sums = replicate_sums_[pixel][replicate];
    for (int i = 0; i < 3; ++i) sums[static_cast<size_t>(i)] += colour[i];
}

void SpectralFilm::bin_means(size_t pixel, uint32_t count, float* out) const {
    const double* bins = bin_sums_.data() + pixel * static_cast<size_t>(bins_.count);
    for (int i = 0; i < bins_.count; ++i)
        out[i] = count > 0 ? static_cast<float>(bins[i] / count) : 0.f;
}

V3f SpectralFilm::xyz(size_t pixel, uint32_t count) const {
    if (count == 0) return V3f(0.f);
    const auto& sum = xyz_sums_[pixel];
    return V3f(Imath::V3d(sum[0], sum[1], sum[2]) / double(count));
}

// Standard error of the mean of all samples from the replicates' means, each as heavy as it has
// samples: the first (count mod kReplicates) have one more. The sum of n_k (m_k - m)^2 over
// the replicates is K - 1 variances of one sample, so that the squared error is unbiased.
template <class Number>
float SpectralFilm::error_of(size_t pixel, uint32_t count, const Number& number) const {
    if (count < kReplicates) return std::numeric_limits<float>::infinity();
    const auto samples = [count](uint32_t k) {
        return (count - k + kReplicates - 1) / kReplicates;
    };
    const auto& sums = replicate_sums_[pixel];
    double centre = 0, squares = 0;
    for (uint32_t k = 0; k < kReplicates; ++k) centre += number(sums[k]) / count;
    for (uint32_t k = 0; k < kReplicates; ++k) {
        const double off = number(sums[k]) / samples(k) - centre;
        squares += samples(k) * off * off;
    }
    const double error = std::sqrt(squares / (count * (kReplicates - 1.)));
    // The sums are floats, and overflow where the picture does not.
    return std::isfinite(error) ? static_cast<float>(error)
                                : std::numeric_limits<float>::infinity();
}

V3f SpectralFilm::standard_error(size_t pixel, uint32_t count) const {
    const auto of = [&](size_t c) {
        return error_of(pixel, count, [c](const auto& rgb) { return double(rgb[c]); });
    };
    return {of(0), of(1), of(2)};
}

float SpectralFilm::luminance_error(size_t pixel, uint32_t count) const {
    return error_of(pixel, count,
                    [](const auto& rgb) { return double(luminance(Rgb(rgb[0], rgb[1], rgb[2]))); });
}

}  // namespace petzval
