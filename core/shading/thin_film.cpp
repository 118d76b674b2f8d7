// SPDX-License-Identifier: Apache-2.0
#include "core/shading/thin_film.h"

#include "core/math/math.h"
#include "core/math/trig.h"
#include "core/shading/lobes.h"
#include "core/shading/thin_film_table.h"
#include "core/shading/visible_facets.h"

namespace petzval {
namespace {

/// Terms of the sum that RGB takes: what is left after them is below 0.1 % at indices up to 3.
constexpr int kMostTerms = 12;
constexpr float kLeastTerm = 1e-3f;

/// Responses of R, G and B to a cosine and a sine of the optical path, relative to those to 1.
struct Responses {
    f4 cosine, sine;
};

Responses responses(float path_nm) {
    const float at = path_nm / kThinFilmStep_nm;
    if (!(at < kThinFilmSteps - 1)) return {f4{}, f4{}};  // too many fringes to be seen apart
    const int i = static_cast<int>(at);
    const float part = at - static_cast<float>(i);
    Responses out{};
    for (int c = 0; c < 3; ++c) {
        // The table has what is left of the oscillation once that of one wavelength is taken out.
        const float re = lerp(kThinFilm[i][c][0], kThinFilm[i + 1][c][0], part);
        const float im = lerp(kThinFilm[i][c][1], kThinFilm[i + 1][c][1], part);
        const SinCos carrier = sincos_turns(path_nm / kThinFilmCarrier_nm[c]);
        out.cosine[c] = re * carrier.cosine - im * carrier.sine;
        out.sine[c] = re * carrier.sine + im * carrier.cosine;
    }
    return out;
}

}  // namespace

ThinFilm::ThinFilm(float index, float thickness_nm, const Bands& bands)
    : spectral_(bands.spectral), index_(index), thickness_nm_(thickness_nm), nm_(bands.nm) {}

f4 ThinFilm::reflectance(float cosine, f4 n, f4 k) const {
    const float sin2 = (1.f - sqr(cosine)) / sqr(index_);
    if (!(sin2 < 1.f)) return splat(1.f);
    const float inside = std::sqrt(1.f - sin2);
    // Fresnel's amplitudes at the front of the film.
    const float front_s = (cosine - index_ * inside) / (cosine + index_ * inside);
    const float front_p = (index_ * cosine - inside) / (index_ * cosine + inside);
    // And at the base, whose cosine times its index over the film's is a + ib.
    const f4 eta = n / index_, kappa = k / index_;
    const f4 square_re = eta * eta - kappa * kappa, square_im = 2.f * eta * kappa;
    const f4 p = square_re - sin2;
    const f4 length = sqrt(p * p + square_im * square_im);
    const f4 a = sqrt(max(0.5f * (length + p), f4{})), b = sqrt(max(0.5f * (length - p), f4{}));
    const auto ratio = [](f4 re, f4 im, f4 other_re, f4 other_im) {
        // (z - w) / (z + w)
        const f4 sum_re = re + other_re, sum_im = im + other_im;
        const f4 norm = sum_re * sum_re + sum_im * sum_im;
        const f4 scale = 1.f / (norm > 0.f ? norm : splat(1.f));
        const f4 less_re = re - other_re, less_im = im - other_im;
        return Amplitude{(less_re * sum_re + less_im * sum_im) * scale,
                         (less_im * sum_re - less_re * sum_im) * scale};
    };
    const Amplitude base_s = ratio(splat(inside), f4{}, a, b);
    const Amplitude base_p = ratio(square_re * inside, square_im * inside, a, b);
    const float path_nm = 2.f * index_ * thickness_nm_ * inside;
    if (!spectral_) {
        const f4 seen =
            0.5f * (in_rgb(front_s, base_s, path_nm) + in_rgb(front_p, base_p, path_nm));
        return min(max(seen, f4{}), splat(1.f));
    }
    f4 sine{}, turn{};
    for (int i = 0; i < 4; ++i) {
        if (!(nm_[i] > 0.f)) continue;
        const SinCos phase = sincos_turns(path_nm / nm_[i]);
        sine[i] = phase.sine;
        turn[i] = phase.cosine;
    }
    return 0.5f * (at_wavelengths(front_s, base_s, sine, turn) +
                   at_wavelengths(front_p, base_p, sine, turn));
}

f4 ThinFilm::at_wavelengths(float front, const Amplitude& base, f4 sine, f4 cosine) const {
    const f4 re = base.re * cosine - base.im * sine, im = base.re * sine + base.im * cosine;
    const f4 above_re = front + re, below_re = 1.f + front * re, below_im = front * im;
    return (above_re * above_re + im * im) / (below_re * below_re + below_im * below_im);
}

f4 ThinFilm::in_rgb(float front, const Amplitude& base, float path_nm) const {
    const float passed = 1.f - sqr(front);
    const f4 norm = base.norm();
    const f4 steady = sqr(passed) * norm / (1.f - sqr(front) * norm);
    f4 sum{};
    Amplitude step{-front * base.re, -front * base.im}, power = step;
    for (int m = 1; m <= kMostTerms; ++m) {
        const f4 size = max(max(power.re, -power.re), max(power.im, -power.im));
        if (hmax(size) < kLeastTerm) break;
        const Responses seen = responses(static_cast<float>(m) * path_nm);
        sum += power.re * seen.cosine - power.im * seen.sine;
        power = {power.re * step.re - power.im * step.im, power.re * step.im + power.im * step.re};
    }
    return sqr(front) + steady + 2.f * (steady - passed) * sum;
}

f4 index_for_reflectance(f4 f0) {
    const f4 root = sqrt(min(max(f0, f4{}), splat(0.9999f)));
    return (1.f + root) / (1.f - root);
}

f4 FilmOver::reflected(float cosine) const {
    return hmax(weight) > 0.f ? weight * reflectance(cosine) : f4{};
}

f4 FilmOver::mean(const SeenFacets& seen) const {
    if (seen.smooth) return reflectance(seen.wo.z);
    const FewFacets facets = few_visible_facets(seen.wo, seen.alpha, 1.f);
    f4 sum{};
    float all = 0;
    for (size_t i = 0; i < FewFacets::kCount; ++i) {
        sum += reflectance(facets.cosine[i]) * facets.reflected[i];
        all += facets.reflected[i];
    }
    // What a film of reflectance 1 sends back is known better than a few facets tell.
    return sum * (all > 0.f ? seen.albedo.total() / all : 0.f);
}

}  // namespace petzval
