// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/dispersion_spread.h"

#include <cmath>
#include <optional>

namespace petzval {
namespace {

constexpr uint32_t kRays = 1024;

class PartedFurther final : public Camera {
  public:
    PartedFurther(std::unique_ptr<Camera> parted, std::unique_ptr<Camera> shared, float factor)
        : parted_(std::move(parted)), shared_(std::move(shared)), factor_(factor) {}

    [[nodiscard]] CameraSample sample(const FilmPoint& point, const Bands& bands) const override {
        CameraSample out = parted_->sample(point, bands);
        const CameraSample middle = shared_->sample(point, bands);
        if (middle.empty()) return out;
        const Ray& d = middle[0].ray;
        for (size_t k = 0; k < out.size(); ++k) {
            Ray& ray = out[k].ray;
            ray.origin = d.origin + factor_ * (ray.origin - d.origin);
            ray.direction = unit(d.direction + factor_ * (ray.direction - d.direction));
        }
        return out;
    }

  private:
    std::unique_ptr<Camera> parted_, shared_;
    float factor_;
};

}  // namespace

std::unique_ptr<Camera> parted_further(std::unique_ptr<Camera> parted,
                                       std::unique_ptr<Camera> shared, float factor) {
    return std::make_unique<PartedFurther>(std::move(parted), std::move(shared), factor);
}

double spread_px(const Session& split, const Session& shared, V2i size_px) {
    const CameraReport& report = split.camera_report;
    const V3f axis = (report.target - report.eye).normalized();
    // Rays that lead backwards, as a fisheye's may, never meet the plane.
    const auto on_plane = [&](const Ray& ray) -> std::optional<V3f> {
        const float forward = ray.direction.dot(axis);
        if (!(forward > 0)) return std::nullopt;
        const float t = (report.focus_m - (ray.origin - report.eye).dot(axis)) / forward;
        return ray.origin + t * ray.direction;
    };
    double sum = 0, lanes = 0;
    for (uint32_t i = 0; i < kRays; ++i) {
        const Sampler sampler(SamplerKind::Owen, 0, {0, 0, i});
        const Bands bands = split.observer.draw(sampler.get1(Dim::Wavelength));
        const V2f film = sampler.get2(Dim::Film);
        const V2f beside(film.x + 1.f / static_cast<float>(size_px.x), film.y);
        const CameraSample middle = shared.camera->sample({film, sampler}, bands);
        const CameraSample next = shared.camera->sample({beside, sampler}, bands);
        if (middle.empty() || next.empty()) continue;
        const auto at = on_plane(middle[0].ray), pixel_on = on_plane(next[0].ray);
        if (!at || !pixel_on || *at == *pixel_on) continue;
        const double pixel2 = double((*pixel_on - *at).length2());
        const CameraSample parted = split.camera->sample({film, sampler}, bands);
        for (size_t k = 0; k < parted.size(); ++k) {
            const CameraPath& path = parted[k];
            const auto here = on_plane(path.ray);
            if (!here) continue;
            const double share = lane_count(path.lanes);
            sum += share * double((*here - *at).length2()) / pixel2;
            lanes += share;
        }
    }
    return lanes > 0 ? std::sqrt(sum / lanes) : 0;
}

}  // namespace petzval
