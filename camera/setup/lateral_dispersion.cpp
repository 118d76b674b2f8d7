// SPDX-License-Identifier: Apache-2.0
#include "camera/setup/lateral_dispersion.h"

#include <cmath>

namespace petzval::camera {
namespace {

constexpr uint32_t kRays = 1024;

}  // namespace

double lateral_dispersion_px(const Camera& split, const Camera& shared, const Observer& observer,
                             const FocusPlane& plane, V2i size_px) {
    double sum = 0, lanes = 0;
    for (uint32_t i = 0; i < kRays; ++i) {
        const Sampler sampler(SamplerKind::Owen, 0, {0, 0, i});
        const Bands bands = observer.draw(sampler.get1(Dim::Wavelength));
        const V2f film = sampler.get2(Dim::Film);
        // Around the middle of the film, at the same height: both see the stop through the same
        // bounds, and draw nearly the same point of it.
        const V2f size(size_px), out = (film - V2f(0.5f)) * size;
        const V2f beside = film + V2f(-out.y, out.x).normalized() / size;
        const CameraSample middle = shared.sample({film, sampler}, bands);
        const CameraSample next = shared.sample({beside, sampler}, bands);
        if (middle.empty() || next.empty()) continue;
        const auto at = plane.at(middle[0].ray), pixel_on = plane.at(next[0].ray);
        if (!at || !pixel_on || *at == *pixel_on) continue;
        const double pixel2 = double((*pixel_on - *at).length2());
        for (const CameraPath& path : split.sample({film, sampler}, bands)) {
            const auto here = plane.at(path.ray);
            if (!here) continue;
            const double share = lane_count(path.lanes);
            sum += share * double((*here - *at).length2()) / pixel2;
            lanes += share;
        }
    }
    return lanes > 0 ? std::sqrt(sum / lanes) : 0;
}

}  // namespace petzval::camera
