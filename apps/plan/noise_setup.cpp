// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/noise_setup.h"

#include <algorithm>
#include <cmath>

#include "apps/plan/rare_light.h"
#include "core/sampling/prepass_seed.h"
#include "core/spectrum/bands.h"
#include "integrator/prepass/pilot_pixels.h"
#include "integrator/render/render.h"
#include "io/image/symmetric_mse.h"

namespace petzval {
namespace {

constexpr int kFloorPixels = 2048;
constexpr uint32_t kFloorSamples = 8;

double floor_of(const RenderSetup& setup, const RenderJob& job, const PathOptions& path, V2i size,
                TbbExecutor& executor) {
    PathOptions options = path;
    options.visible_background = setup.view.visible_background;
    const PathTracer<> tracer(*setup.prepared.scene, *setup.prepared.bvh, *setup.prepared.lights,
                              options);
    RenderJob pilot = job;
    pilot.seed = number_of(PrepassSeed::Noise);
    pilot.observer = setup.view.observer;
    pilot.replicates = 1;
    const auto pixels = pilot_pixels(size, kFloorPixels, pilot.seed);
    std::vector<double> found(pixels.size());
    std::vector<PathStats> stats(static_cast<size_t>(executor.threads()));
    executor.run(static_cast<int>(pixels.size()), [&](int task, int worker) {
        const auto [x, y] = pixels[static_cast<size_t>(task)];
        Film film(size, {x, y, x + 1, y + 1}, {});
        render_samples(tracer, *setup.view.camera, pilot, {{x, y}, 0, kFloorSamples}, film,
                       stats[static_cast<size_t>(worker)]);
        const V4f c = film.colour(x, y);
        found[static_cast<size_t>(task)] = double(luminance({c.x, c.y, c.z}));
    });
    SymmetricFloor floor;
    for (const double l : found) floor.add(l);
    return floor.floor();
}

}  // namespace

std::shared_ptr<const NoiseTarget> noise_target(const RenderSetup& setup, const RenderJob& job,
                                                const PathOptions& path, V2i size_px, double noise,
                                                TbbExecutor& executor) {
    auto out = std::make_shared<NoiseTarget>();
    out->noise = noise;
    out->frame_px = size_px;
    out->floor_nits = floor_of(setup, job, path, size_px, executor);
    const V2i cells = out->cells();
    out->least.assign(static_cast<size_t>(cells.x) * static_cast<size_t>(cells.y), 0);
    const double floor = out->floor_nits;
    for (const LampSamples& one : samples_of_lamps(setup, size_px, floor)) {
        // So many that it does not matter whether it was met.
        const double enough = one.lamp.square() / (floor * floor * noise * noise);
        const auto samples =
            static_cast<uint32_t>(std::clamp(std::min(one.samples, enough), 0., 1e9));
        for (const Rect& rect : one.region.rects) {
            const Rect on = out->cells_of(rect);
            for (int j = on.y0; j < on.y1; ++j)
                for (int i = on.x0; i < on.x1; ++i) {
                    uint32_t& least = out->least[static_cast<size_t>(j * cells.x + i)];
                    least = std::max(least, samples);
                }
        }
    }
    return out;
}

}  // namespace petzval
