// SPDX-License-Identifier: Apache-2.0
// Rendering of a job to a film: progressive passes over tiles.
#pragma once

#include <chrono>
#include <vector>

#include "camera/camera.h"
#include "core/film/film.h"
#include "core/spectrum/colour.h"
#include "integrator/path.h"
#include "integrator/render_job.h"
#include "integrator/tiles.h"

namespace petzval {

/// Seed of one of the replicates: a hash of the pair.
[[nodiscard]] inline uint32_t replicate_seed(uint32_t seed, uint32_t replicate) {
    return hash32(seed, replicate + 1);
}

/// Renders one sample of one pixel: a pure function of its arguments.
template <class Tracer>
void render_sample(const Tracer& tracer, const Camera& camera, const RenderJob& job, SampleId id,
                   Film& film, PathStats& stats) {
    stats.timing = job.timing && (id.index + static_cast<uint32_t>(id.x + 3 * id.y)) % 16 == 0;
    ++stats.samples;
    stats.timed_samples += stats.timing;
    const SectionTimer whole(stats, TimedSection::Sample);
    const uint32_t replicate = id.index % job.replicates;
    const Sampler sampler(job.sampler,
                          job.replicates == 1 ? job.seed : replicate_seed(job.seed, replicate),
                          {id.x, id.y, id.index / job.replicates});
    const Bands bands =
        job.observer.spectral() ? job.observer.draw(sampler.get1(Dim::Wavelength)) : Bands::rgb();
    const bool aovs = !film.aovs().empty();
    const uint64_t vertices_before = stats.vertices;

    const CameraSample seen = [&] {
        const SectionTimer timer(stats, TimedSection::Camera);
        const V2f offset = job.filter.sample(sampler.get2(Dim::Film));
        const V2f size(film.full_size());
        const V2f at = V2f(id.x + 0.5f, id.y + 0.5f) + offset;
        return camera.sample({at / size, sampler, {&job.filter, offset, size}}, bands);
    }();
    stats.lens_lanes += seen.lanes;
    FilmSample sample;
    f4 sum{};
    float behind = 0.f;  // weight of the rays that left the scene, over all lanes
    bool layers = aovs;  // layers are still to be filled in
    for (const CameraPath& path : seen) {
        FilmSample other;
        FilmSample& of_path = path.fills_layers ? sample : other;
        of_path.alpha = 0.f;
        sum += path.weight * tracer.radiance(path.ray, bands, sampler, layers && path.fills_layers,
                                             of_path, stats, path.lanes, path.led);
        if (!path.fills_layers) continue;
        layers = false;
        behind += hsum(zero_off(path.lanes, path.weight)) * (1.f - sample.alpha);
    }
    // Light that a lens keeps from the film is black, not transparent.
    sample.alpha = 1.f - behind / (seen.exposure * static_cast<float>(lane_count(bands.on)));
    sample.colour = to_rgb(sum, bands);
    sample.aov[static_cast<size_t>(Aov::Cost)] =
        V3f(static_cast<float>(stats.vertices - vertices_before), 0, 0);
    if (film.spectral())
        film.add(id.x, id.y, id.index, sample, {replicate, sum, job.observer.to_xyz(sum, bands)},
                 bands);
    else
        film.add(id.x, id.y, id.index, sample);
}

/// Number of samples of the next pass: it grows so that a first picture comes early, and passes
/// stay short. Never fewer than `least`, but for the last.
[[nodiscard]] inline uint32_t pass_size(uint32_t done, uint32_t wanted, uint32_t least = 1) {
    const uint32_t grown = std::max(done == 0 ? 1 : std::min(done, 16u), least);
    return std::min(grown, wanted - done);
}

/// Renders every pixel of the film's crop. Pixels do not depend on the executor, its threads, the
/// tile size, the crop or the passes.
template <class Executor, class Tracer>
RenderResult render(const Tracer& tracer, const Camera& camera, const RenderJob& job, Film& film,
                    Executor& executor, RenderMonitor& monitor) {
    const double start_s = job.wall_s();
    const std::vector<Rect> tiles = tiles_of(film.crop(), job.tile_size_px);
    struct alignas(128) Worker {  // a cache-line pair each, so that counting does not contend
        PathStats stats;
    };
    std::vector<Worker> workers(static_cast<size_t>(executor.threads()));

    RenderResult result;
    const uint32_t wanted = job.end_sample - job.first_sample;
    uint32_t done = 0;
    bool stopped = false;
    while (done < wanted) {
        if (monitor.stop) {
            stopped = true;
            break;
        }
        uint32_t pass = pass_size(done, wanted, job.replicates);
        if (job.time_limit_s && done > 0) {
            const double elapsed_s = job.wall_s() - start_s;
            const double fits = (*job.time_limit_s - elapsed_s) / (elapsed_s / done);
            if (fits < 1) break;
            if (fits < pass) pass = static_cast<uint32_t>(fits);  // fits may be beyond uint32_t
        }
        executor.run(static_cast<int>(tiles.size()), [&](int task, int worker) {
            if (monitor.stop) return;
            PathStats& stats = workers[static_cast<size_t>(worker)].stats;
            const Rect& tile = tiles[static_cast<size_t>(task)];
            const uint32_t first = job.first_sample + done;
            for (int y = tile.y0; y < tile.y1; ++y)
                for (int x = tile.x0; x < tile.x1; ++x)
                    for (uint32_t i = first; i < first + pass; ++i)
                        render_sample(tracer, camera, job, {x, y, i}, film, stats);
            ++stats.tiles;
            monitor.pixel_samples_done +=
                static_cast<uint64_t>(tile.width()) * tile.height() * pass;
        });
        if (monitor.stop) {
            stopped = true;
            break;
        }
        done += pass;
    }
    result.end_sample = job.first_sample + done;
    result.stopped = stopped;
    for (const Worker& worker : workers) {
        result.stats += worker.stats;
        result.workers += worker.stats.tiles > 0;
    }
    return result;
}

}  // namespace petzval
