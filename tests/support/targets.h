// SPDX-License-Identifier: Apache-2.0
// What tests of rays to targets share: lists of targets, film points in their pixels, lamps.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "camera/target_camera.h"
#include "tests/support/statistics.h"

namespace petzval::test {

/// Numbers of a draw, by its purpose.
[[nodiscard]] inline V2f random2(uint32_t i, uint32_t purpose) {
    return {to_unit_float(hash32(hash32(i, purpose), 0)),
            to_unit_float(hash32(hash32(i, purpose), 1))};
}

/// Runs tasks on two threads, the last ones first.
inline void backwards_on_two_threads(size_t count, const std::function<void(size_t)>& task) {
    std::array<std::jthread, 2> threads;
    for (size_t parity = 0; parity < threads.size(); ++parity)
        threads[parity] = std::jthread([&, parity] {
            for (size_t i = count; i-- > 0;)
                if (i % 2 == parity) task(i);
        });
}

/// Part of the film of 16 x 16 pixels about a point.
[[nodiscard]] inline camera::FilmCell cell_about(V2f film, V2i frame_px) {
    const V2f half = V2f(8) / V2f(frame_px);
    return {film - half, film + half};
}

/// Targets made ready for a part of the film, the later the more often taken.
[[nodiscard]] inline camera::TargetCell listed_in(const camera::TargetCamera& camera,
                                                  const camera::FilmCell& part, V2i frame_px,
                                                  const std::vector<camera::Target>& targets) {
    camera::TargetCell out{camera.map(part), {}};
    float sum = 0;
    for (size_t i = 0; out.map && i < targets.size(); ++i) {
        auto listed = camera.listed(targets[i], *out.map, frame_px);
        if (!listed) continue;
        listed->chance = float(i + 1);
        sum += listed->chance;
        out.targets.push_back(*listed);
    }
    for (camera::ListedTarget& listed : out.targets) listed.chance /= sum;
    return out;
}

/// The same targets for all of the film.
[[nodiscard]] inline std::shared_ptr<camera::TargetGrid> grid_of(camera::TargetCell cell) {
    auto out = std::make_shared<camera::TargetGrid>();
    out->cells = {1, 1};
    out->lists.push_back(std::move(cell));
    return out;
}

/// A pixel whose film points a filter draws.
struct Pixel {
    const Filter* filter;
    V2f frame_px;
    V2f middle;  ///< as FilmPoint has it

    [[nodiscard]] camera::FilmPoint draw(const Sampler& sampler) const {
        const V2f offset = filter->sample(sampler.get2(Dim::Film));
        return {middle + offset / frame_px, sampler, {filter, offset, frame_px}};
    }
};

/// Does a ray pass a ball that is not at infinity, and lies ahead?
[[nodiscard]] inline bool passes(const Ray& ray, const V3f& centre, float radius_m) {
    const V3d to = V3d(centre) - V3d(ray.origin), d(ray.direction);
    const double along = to.dot(d);
    return along > 0 && (to - along * d).length2() < sqr(double(radius_m));
}

/// A ray of a film point: that of draw number i, or of the first after it that passes.
[[nodiscard]] inline Ray ray_of(const camera::Camera& camera, V2f film, uint32_t i) {
    for (;; ++i) {
        const camera::FilmPoint at{film, Sampler(SamplerKind::Owen, 5, {0, 0, i})};
        const camera::CameraSample sample = camera.sample(at, Bands::rgb());
        if (!sample.empty()) return sample[0].ray;
    }
}

/// Estimates of a pixel's light: of ordinary rays and those to the targets of a cell, which share
/// it; an empty cell has ordinary rays alone. Film points and bands follow from `seed`.
struct PixelLight {
    Moments light;
    int sent = 0;  ///< rays to targets
};
/// light: of a ray. bands_of: of a sampler. samples: a multiple of a batch.
template <class Light, class BandsOf>
PixelLight light_of(const camera::TargetCamera& camera, const camera::TargetCell& cell,
                    const Pixel& pixel, uint32_t seed, uint32_t samples, const BandsOf& bands_of,
                    const Light& light) {
    PixelLight out;
    std::array<camera::FilmPoint, camera::kMostFilmPoints> points;
    std::array<Bands, camera::kMostFilmPoints> bands;
    std::array<const camera::TargetCell*, camera::kMostFilmPoints> cells{};
    if (!cell.empty()) cells.fill(&cell);
    std::array<camera::CameraSample, camera::kMostFilmPoints> ordinary, to_targets;
    for (uint32_t first = 0; first < samples; first += camera::kMostFilmPoints) {
        for (uint32_t k = 0; k < camera::kMostFilmPoints; ++k) {
            const Sampler sampler(SamplerKind::Independent, seed, {7, 9, first + k});
            bands[k] = bands_of(sampler);
            points[k] = pixel.draw(sampler);
        }
        camera.sample_beside(points, bands, cells, ordinary);
        if (!cell.empty()) camera.sample_targets(points, bands, cells, to_targets);
        for (uint32_t k = 0; k < camera::kMostFilmPoints; ++k) {
            double sum = 0;
            const auto add = [&](const camera::CameraPath& path) {
                sum +=
                    double(hsum(path.weight)) * double(light(path.ray)) * double(path.mis_weight);
            };
            for (const camera::CameraPath& path : ordinary[k]) add(path);
            for (const camera::CameraPath& path : to_targets[k]) add(path), ++out.sent;
            out.light.add(sum);
        }
    }
    return out;
}

}  // namespace petzval::test
