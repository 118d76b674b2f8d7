// SPDX-License-Identifier: Apache-2.0
#include "apps/live/rough.h"

#include <algorithm>
#include <cmath>

#include "apps/request/fields.h"

namespace petzval::apps {

RenderRequest rough_of(RenderRequest request, int divisor) {
    SceneRequest& scene = request.scene;
    const auto part = [&](int length) { return std::max(1, length / divisor); };
    if (auto* pixel =
            scene.camera.focus ? std::get_if<FocusPixel>(&*scene.camera.focus) : nullptr) {
        pixel->x = std::min(pixel->x / divisor, part(scene.size.x) - 1);
        pixel->y = std::min(pixel->y / divisor, part(scene.size.y) - 1);
    }
    scene.size = {part(scene.size.x), part(scene.size.y)};
    scene.targets = TargetUse::Off;
    // A tree has no pilot; whoever asks for another way gets it in the true picture.
    scene.light_choice = LightChoiceKind::Tree;
    if (!scene.camera.dispersion) scene.camera.dispersion = camera::DispersionMode::Shared;
    if (scene.spectral.mode == SpectralMode::Auto) scene.spectral.mode = SpectralMode::Rgb;
    scene.spectral.bins.reset();
    request.crop.reset();
    request.layers.clear();
    request.denoise = false;
    const uint32_t seed = request.samples.seed;
    request.samples = {};
    request.samples.count = 1;
    request.samples.seed = seed;
    return request;
}

bool keeps_samples(const RenderRequest& a, const RenderRequest& b) {
    const auto light = [](RenderRequest request) {
        request.display = {};
        request.samples.count.reset();
        request.samples.time_limit_s.reset();
        RenderOrder order;
        order.render = std::move(request);
        return fields_of(order);
    };
    const auto first = light(a), second = light(b);
    return std::ranges::equal(first, second, [](const FieldTexts& x, const FieldTexts& y) {
        return x.name == y.name && x.texts == y.texts;
    });
}

int rough_divisor(V2i size_px, double samples_per_s, double set_up_s) {
    constexpr double kUnmeasured_per_s = 3e5;  // of two slow cores
    const double pixels = double(size_px.x) * size_px.y;
    const double most = std::max(kRough_s - set_up_s, kLeastSampling_s) *
                        (samples_per_s > 0 ? samples_per_s : kUnmeasured_per_s);
    return static_cast<int>(std::clamp(std::ceil(std::sqrt(pixels / most)), 1., 1e5));
}

}  // namespace petzval::apps
