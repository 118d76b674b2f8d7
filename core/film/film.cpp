// SPDX-License-Identifier: Apache-2.0
#include "core/film/film.h"

#include <cstring>

namespace petzval {
namespace {

constexpr std::array<AovInfo, static_cast<size_t>(Aov::Count)> kAovs{{
    {"albedo", {"albedo.R", "albedo.G", "albedo.B"}, 3},
    {"normal", {"normal.X", "normal.Y", "normal.Z"}, 3},
    {"depth", {"depth.Z", "", ""}, 1},
    {"position", {"position.X", "position.Y", "position.Z"}, 3},
    {"uv", {"uv.U", "uv.V", ""}, 2},
    {"emission", {"emission.R", "emission.G", "emission.B"}, 3},
    {"cost", {"cost.N", "", ""}, 1},
    {"velocity", {"velocity.X", "velocity.Y", ""}, 2},
}};

// Fault of a sample: 0 where every number is finite, else NaN.
float not_finite(const V3f& a) {
    return (a.x - a.x) + (a.y - a.y) + (a.z - a.z);
}

}  // namespace

const AovInfo& aov_info(Aov aov) {
    return kAovs[static_cast<size_t>(aov)];
}

std::optional<Aov> aov_from_name(std::string_view name) {
    for (size_t i = 0; i < kAovs.size(); ++i)
        if (kAovs[i].name == name) return static_cast<Aov>(i);
    return std::nullopt;
}

Film::Film(V2i full_size, Rect crop, std::vector<Aov> aovs, std::optional<Bins> bins)
    : full_size_(full_size),
      crop_(crop),
      aovs_(std::move(aovs)),
      pixels_(static_cast<size_t>(crop.width()) * crop.height()),
      aov_sums_(pixels_.size() * aovs_.size()) {
    if (bins) spectral_.emplace(pixels_.size(), *bins);
}

size_t Film::bytes_per_pixel(size_t layers, const std::optional<Bins>& bins) {
    return sizeof(Pixel) + layers * sizeof(std::array<double, 3>) +
           (bins ? SpectralFilm::bytes_per_pixel(*bins) : 0);
}

void Film::add(int x, int y, uint32_t index, const FilmSample& sample) {
    static_cast<void>(accept(offset(x, y), index, sample, 0.f));
}

void Film::add(int x, int y, uint32_t index, const FilmSample& sample,
               const SpectralSample& spectral, const Bands& bands) {
    const size_t at = offset(x, y);
    // A lane that is not finite shows in the colour, which every lane adds to.
    if (accept(at, index, sample, not_finite(spectral.xyz)))
        spectral_->add(at, spectral.replicate, sample.colour, spectral.xyz, spectral.radiance,
                       bands);
}

bool Film::accept(size_t at, uint32_t index, const FilmSample& sample, float fault) {
    Pixel& pixel = pixels_[at];
    f4 rgba = sample.colour.v;
    rgba[3] = sample.alpha;
    fault += hsum(rgba - rgba);
    if (sample.hit)
        for (const Aov aov : aovs_) fault += not_finite(sample.aov[static_cast<size_t>(aov)]);
    if (fault != 0.f) {
        if (pixel.bad++ == 0 || index < pixel.first_bad_index) pixel.first_bad_index = index;
        return false;
    }
    d4 sum;
    std::memcpy(&sum, pixel.sum.data(), sizeof sum);
    sum += __builtin_convertvector(rgba, d4);
    std::memcpy(pixel.sum.data(), &sum, sizeof sum);
    ++pixel.count;
    if (!sample.hit) return true;
    ++pixel.hits;
    for (size_t layer = 0; layer < aovs_.size(); ++layer) {
        const V3f& value = sample.aov[static_cast<size_t>(aovs_[layer])];
        auto& to = aov_sums_[at * aovs_.size() + layer];
        for (int i = 0; i < 3; ++i) to[i] += value[i];
    }
    return true;
}

V4f Film::colour(int x, int y) const {
    const Pixel& p = pixel(x, y);
    const double scale = p.count > 0 ? 1.0 / p.count : 0.0;
    const auto mean = [&](int i) { return static_cast<float>(p.sum[i] * scale); };
    return {mean(0), mean(1), mean(2), mean(3)};
}

V3f Film::aov(int x, int y, size_t layer) const {
    const uint32_t hits = pixel(x, y).hits;
    const double scale = hits > 0 ? 1.0 / hits : 0.0;
    const auto& sum = aov_sums_[offset(x, y) * aovs_.size() + layer];
    const auto mean = [&](int i) { return static_cast<float>(sum[i] * scale); };
    return {mean(0), mean(1), mean(2)};
}

uint64_t Film::bad_count() const {
    uint64_t total = 0;
    for (const Pixel& p : pixels_) total += p.bad;
    return total;
}

std::optional<Film::BadSample> Film::first_bad() const {
    for (int y = crop_.y0; y < crop_.y1; ++y)
        for (int x = crop_.x0; x < crop_.x1; ++x)
            if (const Pixel& p = pixel(x, y); p.bad > 0) return BadSample{x, y, p.first_bad_index};
    return std::nullopt;
}

}  // namespace petzval
