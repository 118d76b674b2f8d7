// SPDX-License-Identifier: Apache-2.0
#include "core/film/spectral_film.h"

#include <cmath>
#include <limits>
#include <span>

namespace petzval {

SpectralFilm::SpectralFilm(size_t pixels, const Bins& bins, bool halves)
    : bins_(bins),
      each_(sums_per_pixel(bins, halves)),
      bin_sums_(pixels * each_),
      xyz_sums_(pixels),
      replicate_sums_(pixels) {}

// Estimate of the average over the bin that each lane falls into.
f4 SpectralFilm::bin_values(f4 radiance, const Bands& bands) const {
    const float width_nm = static_cast<float>(bins_.width_nm);
    const f4 density = bands.pdf * (static_cast<float>(lane_count(bands.on)) * width_nm);
    return zero_off(bands.on, radiance / density);
}

bool SpectralFilm::Sample::finite() const {
    bool all = std::isfinite(xyz.x) && std::isfinite(xyz.y) && std::isfinite(xyz.z);
    for (int i = 0; i < 4; ++i) all = all && std::isfinite(radiance[i]);
    return all;
}

bool SpectralFilm::holds(const Sample& sample, const Bands& bands) const {
    const f4 values = bin_values(sample.radiance, bands);
    bool within = true;
    for (int i = 0; i < 4; ++i) within = within && std::abs(values[i]) < SpectralSum::kLimit;
    for (int i = 0; i < 3; ++i) within = within && std::abs(sample.xyz[i]) < FilmSum::kLimit;
    return within;
}

void SpectralFilm::add(size_t pixel, Rgb colour, const Sample& sample, const Bands& bands) {
    static_assert(kReplicates % kHalves == 0, "a replicate belongs to one half");
    const auto one = static_cast<size_t>(bins_.count);
    SpectralSum* bins =
        bin_sums_.data() + pixel * each_ + (each_ > one ? half_of(sample.replicate) * one : 0);
    const f4 values = bin_values(sample.radiance, bands);
    for (int i = 0; i < 4; ++i) {
        const int bin = bands.on[i] ? bins_.index(bands.nm[i]) : -1;
        if (bin >= 0) bins[bin].add(values[i]);
    }
    auto& replicate = replicate_sums_[pixel][sample.replicate];
    for (int i = 0; i < 3; ++i) {
        xyz_sums_[pixel][static_cast<size_t>(i)].add(sample.xyz[i]);
        replicate[static_cast<size_t>(i)].add(colour[i]);
    }
}

void SpectralFilm::bin_means(size_t pixel, uint32_t count, float* out) const {
    const auto one = static_cast<size_t>(bins_.count);
    const SpectralSum* bins = bin_sums_.data() + pixel * each_;
    for (size_t i = 0; i < one; ++i) {
        SpectralSum sum = bins[i];
        if (each_ > one) sum += bins[one + i];
        out[i] = count > 0 ? static_cast<float>(sum.value() / count) : 0.f;
    }
}

void SpectralFilm::half_bin_means(size_t pixel, uint32_t half, uint32_t count, float* out) const {
    const auto one = static_cast<size_t>(bins_.count);
    const SpectralSum* bins = bin_sums_.data() + pixel * each_ + half * one;
    for (size_t i = 0; i < one; ++i)
        out[i] = count > 0 ? static_cast<float>(bins[i].value() / count) : 0.f;
}

V3f SpectralFilm::xyz(size_t pixel, uint32_t count) const {
    if (count == 0) return V3f(0.f);
    const auto& sum = xyz_sums_[pixel];
    return V3f(Imath::V3d(sum[0].value(), sum[1].value(), sum[2].value()) / double(count));
}

// Standard error of the mean of all samples from the replicates' means, each as heavy as it has
// samples. The sum of n_k (m_k - m)^2 over the replicates is K - 1 variances of one sample, so that
// the squared error is unbiased.
template <class Number>
float SpectralFilm::error_of(size_t pixel, SampleRange range, const Number& number) const {
    const uint32_t count = range.count();
    if (count < kReplicates) return std::numeric_limits<float>::infinity();
    const auto samples = [range](uint64_t k) {  // indices of the range that are k modulo K
        const auto below = [k](uint64_t end) { return (end + kReplicates - 1 - k) / kReplicates; };
        return double(below(range.end) - below(range.first));
    };
    const auto& sums = replicate_sums_[pixel];
    double centre = 0, squares = 0;
    for (uint32_t k = 0; k < kReplicates; ++k) centre += number(sums[k]) / count;
    for (uint32_t k = 0; k < kReplicates; ++k) {
        const double off = number(sums[k]) / samples(k) - centre;
        squares += samples(k) * off * off;
    }
    return static_cast<float>(std::sqrt(squares / (count * (kReplicates - 1.))));
}

V3f SpectralFilm::standard_error(size_t pixel, SampleRange range) const {
    const auto of = [&](size_t c) {
        return error_of(pixel, range, [c](const auto& rgb) { return rgb[c].value(); });
    };
    return {of(0), of(1), of(2)};
}

float SpectralFilm::luminance_error(size_t pixel, SampleRange range) const {
    return error_of(pixel, range, [](const auto& rgb) {
        const auto sum = [&](size_t c) { return static_cast<float>(rgb[c].value()); };
        return double(luminance(Rgb(sum(0), sum(1), sum(2))));
    });
}

void SpectralFilm::pack(size_t pixel, uint8_t* to) const {
    to = petzval::pack(std::span(bin_sums_).subspan(pixel * each_, each_), to);
    to = petzval::pack(std::span<const FilmSum>(xyz_sums_[pixel]), to);
    for (const Tristimulus& replicate : replicate_sums_[pixel])
        to = petzval::pack(std::span<const FilmSum>(replicate), to);
}

void SpectralFilm::add_packed(size_t pixel, const uint8_t* from) {
    from = petzval::add_packed(std::span(bin_sums_).subspan(pixel * each_, each_), from);
    from = petzval::add_packed(std::span<FilmSum>(xyz_sums_[pixel]), from);
    for (Tristimulus& replicate : replicate_sums_[pixel])
        from = petzval::add_packed(std::span<FilmSum>(replicate), from);
}

}  // namespace petzval
