// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/coating.h"

#include <numbers>

namespace petzval::camera {
namespace {

/// Reflected shares of the amplitude at a bare boundary.
struct Amplitude {
    f4 s, p;
};
Amplitude bare(f4 n0, f4 cosine0, f4 n1, f4 cosine1) {
    const f4 s0 = n0 * cosine0, s1 = n1 * cosine1, p0 = n0 * cosine1, p1 = n1 * cosine0;
    return {(s0 - s1) / (s0 + s1), (p1 - p0) / (p1 + p0)};
}

f4 cosine2_within(f4 index, const Crossing& c) {
    const f4 ratio = c.index_from / index;
    return 1 - ratio * ratio * (1 - c.cosine * c.cosine);
}

f4 share(f4 a) {
    return min(max(a, f4{}), splat(1.f));
}

// Reflectance 1 where the far medium has no ray, or light only grazes.
Reflectance all_where(m4 total, Reflectance r) {
    return {total ? splat(1.f) : share(r.s), total ? splat(1.f) : share(r.p)};
}

}  // namespace

Reflectance fresnel_reflectance(const Crossing& c) {
    const f4 cosine2 = cosine2_within(c.index_into, c);
    const Amplitude r = bare(c.index_from, c.cosine, c.index_into, sqrt(max(cosine2, f4{})));
    return all_where((cosine2 <= 0.f) | (c.cosine <= 0.f), {r.s * r.s, r.p * r.p});
}

Reflectance coated_reflectance(const Crossing& c, f4 nm) {
    const f4 film = splat(kMgF2Index);
    const f4 cosine2 = cosine2_within(c.index_into, c), film2 = cosine2_within(film, c);
    const f4 in_film = sqrt(max(film2, f4{}));
    const Amplitude first = bare(c.index_from, c.cosine, film, in_film);
    const Amplitude second = bare(film, in_film, c.index_into, sqrt(max(cosine2, f4{})));
    // Phase of the way there and back: twice a quarter wave at normal incidence.
    const f4 phase = std::numbers::pi_v<float> * kQuarterWave_nm / nm * in_film;
    f4 twice_cosine;
    for (int i = 0; i < 4; ++i) twice_cosine[i] = 2 * std::cos(phase[i]);
    const auto airy = [&](f4 a, f4 b) {
        const f4 squares = a * a + b * b, product = a * b, both = product * twice_cosine;
        return (squares + both) / (1 + product * product + both);
    };
    return all_where((cosine2 <= 0.f) | (film2 <= 0.f) | (c.cosine <= 0.f),
                     {airy(first.s, second.s), airy(first.p, second.p)});
}

f4 transmittance(Coating coating, const Crossing& c, bool touches_air, f4 nm) {
    if (coating == Coating::Ideal) return splat(1.f);
    const bool coated = coating == Coating::MgF2 && touches_air;
    return 1 - (coated ? coated_reflectance(c, nm) : fresnel_reflectance(c)).mean();
}

}  // namespace petzval::camera
