// SPDX-License-Identifier: Apache-2.0
#include "camera/models/natural_vignetting.h"

#include "core/sampling/sampler.h"

namespace petzval::camera {

double NaturalVignetting::axial_mean(const Iris& iris, double film_mm) {
    constexpr uint32_t kPoints = 4096;
    const NaturalVignetting unscaled(film_mm, 1);
    double sum = 0;
    for (uint32_t i = 0; i < kPoints; ++i) {
        const V2f u = Sampler(SamplerKind::Owen, 0, {0, 0, i}).get2(Dim::Lens);
        sum += double(unscaled.factor(V2f(0.f), iris.sample(u)));
    }
    return sum / kPoints;
}

}  // namespace petzval::camera
