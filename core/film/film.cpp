// SPDX-License-Identifier: Apache-2.0
// Samples that are added to the film.
#include "core/film/film.h"

#include <cmath>

namespace petzval {
namespace {

constexpr auto kInRange = [](float a) { return std::abs(a) < FilmSum::kLimit; };
constexpr auto kIsFinite = [](float a) { return std::isfinite(a); };

}  // namespace

void Film::add(int x, int y, uint32_t index, const FilmSample& sample) {
    const size_t at = offset(x, y);
    if (each_number(sample, kInRange))
        accept(pixels_[at], at, index, sample);
    else
        reject(at, index, each_number(sample, kIsFinite));
}

void Film::add(int x, int y, uint32_t index, const FilmSample& sample,
               const SpectralFilm::Sample& spectral, const Bands& bands) {
    const size_t at = offset(x, y);
    if (!each_number(sample, kInRange) || !spectral_->holds(spectral, bands))
        return reject(at, index, each_number(sample, kIsFinite) && spectral.finite());
    accept(pixels_[at], at, index, sample);
    spectral_->add(at, sample.colour, spectral, bands);
}

// Whether all numbers of a sample that the film would add pass a test.
template <class Test>
bool Film::each_number(const FilmSample& sample, const Test& passes) const {
    const Rgb& c = sample.colour;
    bool all = passes(c[0]) && passes(c[1]) && passes(c[2]) && passes(sample.alpha);
    for (const Aov aov : aovs_) {
        if (!sample.hit && aov != Aov::Ghosts) continue;
        const V3f& value = sample.aov[static_cast<size_t>(aov)];
        all = all && passes(value.x) && passes(value.y) && passes(value.z);
    }
    return all;
}

void Film::reject(size_t at, uint32_t index, bool finite) {
    Pixel& pixel = pixels_[at];
    if (pixel.left_out++ == 0 || index < pixel.first_left_out) pixel.first_left_out = index;
    too_large_[at] += finite;
}

void Film::accept(Pixel& pixel, size_t at, uint32_t index, const FilmSample& sample) {
    for (int i = 0; i < 3; ++i) pixel.sum[static_cast<size_t>(i)].add(sample.colour[i]);
    pixel.sum[3].add(sample.alpha);
    const V3f colour(sample.colour[0], sample.colour[1], sample.colour[2]);
    if (blocks_) blocks_->add(at, colour);
    if (halves_) halves_->add(at, index, colour, sample.guide);
    ++pixel.count;
    pixel.hits += sample.hit;
    for (size_t layer = 0; layer < aovs_.size(); ++layer) {
        if (!sample.hit && aovs_[layer] != Aov::Ghosts) continue;
        const V3f& value = sample.aov[static_cast<size_t>(aovs_[layer])];
        auto& to = aov_sums_[at * aovs_.size() + layer];
        for (int i = 0; i < 3; ++i) to[static_cast<size_t>(i)].add(value[i]);
    }
}

}  // namespace petzval
