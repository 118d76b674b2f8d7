// SPDX-License-Identifier: Apache-2.0
#include "core/film/film_halves.h"

namespace petzval {

FilmHalves::Half FilmHalves::half(size_t pixel, uint32_t half) const {
    const Sums& sums = pixels_[pixel].halves[half];
    const double count = pixels_[pixel].count[half];
    Half out{V3f(0.f), V3f(0.f), {}, pixels_[pixel].count[half]};
    if (count == 0) return out;
    for (size_t i = 0; i < 3; ++i) {
        const double mean = sums.colour[i].value() / count, square = mean * mean;
        out.colour[static_cast<int>(i)] = static_cast<float>(mean);
        out.variance[static_cast<int>(i)] = static_cast<float>(
            count > 1 ? std::max(0., sums.squares[i].value() / count - square) / (count - 1)
                      : square);
    }
    for (size_t i = 0; i < kGuideNumbers; ++i)
        out.guide[i] = static_cast<float>(double(sums.guide[i]) / (kOne * count));
    return out;
}

void FilmHalves::add_packed(size_t pixel, const uint8_t* from) {
    Pixel other, &p = pixels_[pixel];
    std::memcpy(static_cast<void*>(&other), from, sizeof other);
    for (size_t half = 0; half < kHalves; ++half) {
        Sums& to = p.halves[half];
        const Sums& more = other.halves[half];
        for (size_t i = 0; i < 3; ++i) {
            to.colour[i] += more.colour[i];
            to.squares[i] += more.squares[i];
        }
        for (size_t i = 0; i < kGuideNumbers; ++i) to.guide[i] += more.guide[i];
        p.count[half] += other.count[half];
    }
}

bool FilmHalves::is_possible(const uint8_t* from, uint32_t count) {
    Pixel p;
    std::memcpy(static_cast<void*>(&p), from, sizeof p);
    uint64_t samples = 0;
    bool possible = true;
    for (size_t half = 0; half < kHalves; ++half) {
        const Sums& sums = p.halves[half];
        const double most = p.count[half];
        samples += p.count[half];
        for (size_t i = 0; i < 3; ++i)
            possible = possible &&
                       std::abs(sums.colour[i].value()) <= most * double(FilmSum::kLimit) &&
                       sums.squares[i].value() >= 0 &&
                       sums.squares[i].value() <= most * double(SquareSum::kLimit);
        for (const int64_t sum : sums.guide)
            possible = possible && std::abs(double(sum)) <= most * kOne;
    }
    return possible && samples == count;
}

}  // namespace petzval
