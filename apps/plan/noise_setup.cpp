// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/noise_setup.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/plan/rare_light.h"
#include "apps/setup/tracer.h"
#include "core/sampling/prepass_seed.h"
#include "core/spectrum/bands.h"
#include "integrator/prepass/pilot_batch.h"
#include "integrator/prepass/pilot_pixels.h"
#include "io/image/symmetric_mse.h"

namespace petzval::apps {
namespace {

constexpr std::array<integrator::PilotTurn, 4> kFloorTurns{
    {{2048, 8}, {16384, 4}, {131072, 1}, {1 << 20, 1}}};

double floor_of(const RenderSetup& setup, const integrator::RenderJob& job,
                const integrator::PathOptions& path, V2i size, integrator::TbbExecutor& executor) {
    constexpr uint32_t kSeed = number_of(PrepassSeed::Noise);
    integrator::RenderJob pilot = job;
    pilot.observer = setup.view.observer;
    pilot.replicates = 1;
    const integrator::PathTracer<> tracer = tracer_of(setup, path);
    io::SymmetricFloor floor;
    for (const integrator::PilotTurn& turn : kFloorTurns) {
        const integrator::PilotBatch batch{
            size, integrator::pilot_pixels(size, turn.pixels, kSeed), 0, turn.samples, {kSeed}, {}};
        std::vector<double> found(batch.pixels.size());
        render_pilot(tracer, *setup.view.camera, pilot, batch, executor,
                     [&](const integrator::PilotFilm& film) {
                         const V4f c = film.colour;
                         found[film.pixel] = double(luminance({c.x, c.y, c.z}));
                     });
        floor = {};
        for (const double l : found) floor.add(l);
        const auto lit = std::ranges::count_if(found, [](double l) { return l > 0; });
        const bool is_all = int64_t{turn.pixels} >= int64_t{size.x} * size.y;
        if (static_cast<size_t>(lit) >= integrator::kEnoughLitPixels || is_all) break;
    }
    return floor.floor();
}

}  // namespace

std::shared_ptr<const integrator::NoiseTarget> noise_target(const RenderSetup& setup,
                                                            const integrator::RenderJob& job,
                                                            const integrator::PathOptions& path,
                                                            V2i size_px, double noise,
                                                            integrator::TbbExecutor& executor) {
    auto out = std::make_shared<integrator::NoiseTarget>();
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

}  // namespace petzval::apps
