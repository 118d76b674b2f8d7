// SPDX-License-Identifier: Apache-2.0
#include "integrator/prepass/pilot_batch.h"

#include "integrator/render/render.h"

namespace petzval::integrator {

PathStats render_pilot(const PathTracer<>& tracer, const camera::Camera& camera,
                       const RenderJob& like, const PilotBatch& batch, TbbExecutor& executor,
                       const std::function<void(const PilotFilm&)>& found) {
    std::vector<PathStats> stats(static_cast<size_t>(executor.threads()));
    executor.run(static_cast<int>(batch.pixels.size()), [&](int task, int worker) {
        const auto pixel = static_cast<size_t>(task);
        const auto [x, y] = batch.pixels[pixel];
        RenderJob job = like;
        for (size_t k = 0; k < batch.seeds.size(); ++k) {
            const double start_s = steady_s();
            job.seed = batch.seeds[k];
            Film film(batch.frame_px, {x, y, x + 1, y + 1}, batch.layers);
            render_samples(tracer, camera, job, {{x, y}, batch.first, batch.end}, film,
                           stats[static_cast<size_t>(worker)]);
            found({pixel, k, film.colour(x, y), batch.layers.empty() ? V3f(0) : film.aov(x, y, 0),
                   film.sample_count(x, y), steady_s() - start_s});
        }
    });
    PathStats sum;
    for (const PathStats& s : stats) sum += s;
    return sum;
}

}  // namespace petzval::integrator
