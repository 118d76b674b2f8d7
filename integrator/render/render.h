// SPDX-License-Identifier: Apache-2.0
// Rendering of a job to a film: progressive passes over tiles.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <vector>

#include "camera/camera.h"
#include "core/film/film.h"
#include "core/spectrum/colour.h"
#include "integrator/path/path.h"
#include "integrator/render/render_job.h"
#include "integrator/render/tiles.h"
#include "integrator/render/velocity.h"

namespace petzval {

/// Seed of one of the replicates: a hash of the pair.
[[nodiscard]] inline uint32_t replicate_seed(uint32_t seed, uint32_t replicate) {
    return hash32(seed, replicate + 1);
}

/// Factor that makes no number of a colour larger than a limit in magnitude, 1 where none is. Of an
/// infinite colour NaN comes, which the film counts.
[[nodiscard]] inline float clamping_share(const Rgb& colour, float limit) {
    const float largest = std::max({std::abs(colour[0]), std::abs(colour[1]), std::abs(colour[2])});
    return largest > limit ? limit / largest : 1.f;
}

/// Samples whose camera rays are found together: what the film gets of each is a pure function of
/// the job and its id. Holds as many as a camera takes at once; `render` must be called for those
/// that are left.
template <class Tracer>
class SampleBatch {
  public:
    /// All must outlive it. film: nullptr where only the paths' counts and records are wanted.
    SampleBatch(const Tracer& tracer, const Camera& camera, const RenderJob& job, V2i frame_px,
                Film* film, PathStats& stats)
        : tracer_(tracer),
          camera_(camera),
          job_(job),
          frame_px_(frame_px),
          film_(film),
          stats_(stats) {}

    void add(SampleId id) {
        ids_[size_++] = id;
        if (size_ == kMostFilmPoints) render();
    }
    /// Renders the samples that are there. The name by which profilers know the sampling: it is
    /// called for eight samples at once, so that not to inline it costs nothing.
    [[gnu::noinline]] void render() {
        if (size_ == 0) return;
        stats_.timing = job_.timing && is_timed(ids_[0]);
        stats_.samples += size_;
        if (stats_.timing) stats_.timed_samples += size_;
        const SectionTimer whole(stats_, TimedSection::Sample);
        find_camera_rays();
        for (size_t i = 0; i < size_; ++i) trace(i);
        size_ = 0;
    }

  private:
    /// One batch in sixteen, spread over pixels and samples.
    [[nodiscard]] static bool is_timed(SampleId first) {
        const uint32_t pixel =
            static_cast<uint32_t>(first.x) + 0x9e3779b9u * static_cast<uint32_t>(first.y);
        return hash32(hash32(pixel), first.index) % 16 == 0;
    }
    void find_camera_rays();
    void find_target_rays();
    void find_times();
    void trace(size_t i);
    [[nodiscard]] f4 to_targets(size_t i);

    const Tracer& tracer_;
    const Camera& camera_;
    const RenderJob& job_;
    V2i frame_px_;
    Film* film_;
    PathStats& stats_;
    size_t size_ = 0;
    std::array<SampleId, kMostFilmPoints> ids_;
    std::array<FilmPoint, kMostFilmPoints> points_;
    std::array<Bands, kMostFilmPoints> bands_;
    std::array<CameraSample, kMostFilmPoints> seen_, to_targets_;
};

template <class Tracer>
void SampleBatch<Tracer>::find_camera_rays() {
    const SectionTimer timer(stats_, TimedSection::Camera);
    const V2f size(frame_px_);
    for (size_t i = 0; i < size_; ++i) {
        const SampleId id = ids_[i];
        const uint32_t replicate = id.index % job_.replicates;
        const Sampler sampler(
            job_.sampler, job_.replicates == 1 ? job_.seed : replicate_seed(job_.seed, replicate),
            {id.x, id.y, id.index / job_.replicates});
        bands_[i] = job_.observer.spectral() ? job_.observer.draw(sampler.get1(Dim::Wavelength))
                                             : Bands::rgb();
        const V2f offset = job_.filter.sample(sampler.get2(Dim::Film));
        const V2f at = V2f(id.x + 0.5f, id.y + 0.5f) + offset;
        points_[i] = {at / size, sampler, {&job_.filter, offset, size}};
    }
    camera_.sample_all({points_.data(), size_}, {bands_.data(), size_}, {seen_.data(), size_});
    if (camera_.targets()) find_target_rays();
    if (camera_.shutter()) find_times();
}

template <class Tracer>
void SampleBatch<Tracer>::find_target_rays() {
    std::array<TargetList, kMostFilmPoints> lists;
    bool any = false;
    for (size_t i = 0; i < size_; ++i) {
        lists[i] = camera_.targets()->at(points_[i].film);
        to_targets_[i] = {};
        any = any || !lists[i].empty();
    }
    if (any)
        camera_.sample_targets({points_.data(), size_}, {bands_.data(), size_},
                               {lists.data(), size_}, {to_targets_.data(), size_});
}

// Draws a time for each sample, and moves its rays to where the camera stands then.
template <class Tracer>
void SampleBatch<Tracer>::find_times() {
    const Shutter& shutter = *camera_.shutter();
    for (size_t i = 0; i < size_; ++i) {
        const float time = shutter.time(points_[i].sampler.get1(Dim::Time));
        const auto move = [&](CameraSample& sample) {
            for (CameraPath& path : sample) {
                path.ray.time = time;
                shutter.move(path.ray);
            }
        };
        move(seen_[i]);
        if (camera_.targets()) move(to_targets_[i]);
    }
}

template <class Tracer>
void SampleBatch<Tracer>::trace(size_t i) {
    const SampleId id = ids_[i];
    const Bands& bands = bands_[i];
    const CameraSample& seen = seen_[i];
    const uint64_t vertices_before = stats_.vertices;
    stats_.lens_lanes += seen.lanes;
    FilmSample sample;
    f4 sum{};
    float behind = 0.f;  // weight of the rays that left the scene, over all lanes
    bool layers = film_ && !film_->aovs().empty();  // layers are still to be filled in
    for (const CameraPath& path : seen) {
        FilmSample other;
        FilmSample& of_path = path.fills_layers ? sample : other;
        of_path.alpha = 0.f;
        sum += path.weight * path.share *
               tracer_.radiance(path.ray, bands, points_[i].sampler, layers && path.fills_layers,
                                of_path, stats_, path.lanes, path.led);
        if (!path.fills_layers) continue;
        layers = false;
        behind += hsum(zero_off(path.lanes, path.weight)) * (1.f - sample.alpha);
    }
    if (camera_.targets()) sum += to_targets(i);
    if (!film_) return;
    // Light that a lens keeps from the film is black, not transparent.
    sample.alpha = 1.f - behind / (seen.exposure * static_cast<float>(lane_count(bands.on)));
    sample.colour = to_rgb(sum, bands);
    if (job_.clamp_nits)
        if (const float share = clamping_share(sample.colour, *job_.clamp_nits); share < 1) {
            sample.colour = sample.colour * share;
            sum *= splat(share);
        }
    if (job_.velocity && sample.hit)
        sample.aov[static_cast<size_t>(Aov::Velocity)] =
            job_.velocity->at(sample.first, points_[i].film * V2f(frame_px_));
    sample.aov[static_cast<size_t>(Aov::Cost)] =
        V3f(static_cast<float>(stats_.vertices - vertices_before), 0, 0);
    if (film_->spectral())
        film_->add(id.x, id.y, id.index, sample,
                   {id.index % job_.replicates, sum, job_.observer.to_xyz(sum, bands)}, bands);
    else
        film_->add(id.x, id.y, id.index, sample);
}

template <class Tracer>
f4 SampleBatch<Tracer>::to_targets(size_t i) {
    f4 sum{};
    for (const CameraPath& path : to_targets_[i]) {
        FilmSample other;
        ++stats_.target_rays;
        // What surfaces reflect is found by ordinary rays as well: it is worth the share's effort.
        sum += path.weight * path.share *
               tracer_.radiance(path.ray, bands_[i], points_[i].sampler, false, other, stats_,
                                path.lanes, path.led, path.share);
    }
    return sum;
}

/// Renders the samples [first, end) of one pixel: each a pure function of job, pixel and index.
template <class Tracer>
void render_samples(const Tracer& tracer, const Camera& camera, const RenderJob& job, V2i pixel,
                    uint32_t first, uint32_t end, Film& film, PathStats& stats) {
    SampleBatch<Tracer> batch(tracer, camera, job, film.full_size(), &film, stats);
    for (uint32_t i = first; i < end; ++i) batch.add({pixel.x, pixel.y, i});
    batch.render();
}

/// Number of samples of the next pass: it grows so that a first picture comes early, and passes
/// stay short. Never fewer than `least`, but for the last.
[[nodiscard]] inline uint32_t pass_size(uint32_t done, uint32_t wanted, uint32_t least = 1) {
    const uint32_t grown = std::max(done == 0 ? 1 : std::min(done, 16u), least);
    return std::min(grown, wanted - done);
}

/// Number of samples of the next pass within the job's time limit: 0 where it is over. before: what
/// was there when rendering began, elapsed_s ago.
[[nodiscard]] inline uint32_t pass_within(const RenderJob& job, uint32_t done, uint32_t before,
                                          uint32_t wanted, double elapsed_s) {
    const uint32_t pass = pass_size(done, wanted, job.replicates);
    if (!job.time_limit_s || done == 0) return pass;
    const double left_s = *job.time_limit_s - elapsed_s;
    if (done == before) return left_s > 0 ? pass : 0;
    const double fits = left_s / (elapsed_s / (done - before));
    if (!(fits >= 1)) return 0;
    return fits < pass ? static_cast<uint32_t>(fits) : pass;  // fits may be beyond uint32_t
}

/// Renders every pixel of the film's crop. Pixels do not depend on the executor, its threads, the
/// tile size, the crop or the passes. A film that has samples of this job goes on from there: each
/// pixel has the first taken_count() of them.
template <class Executor, class Tracer>
RenderResult render(const Tracer& tracer, const Camera& camera, const RenderJob& job, Film& film,
                    Executor& executor, RenderMonitor& monitor) {
    const double start_s = job.wall_s();
    const std::vector<Rect> tiles = tiles_of(film.crop(), job.tile_size_px);
    struct alignas(128) Worker {  // a cache-line pair each, so that counting does not contend
        PathStats stats;
    };
    std::vector<Worker> workers(static_cast<size_t>(executor.threads()));
    const auto total = [&] {
        PathStats sum;
        for (const Worker& worker : workers) sum += worker.stats;
        return sum;
    };

    const auto [before, most] = film.taken_range();
    const uint32_t wanted = job.end_sample - job.first_sample;
    uint32_t done = before;
    std::optional<uint32_t> pass;  // that is under way: once begun, every pixel gets it
    if (most > before) pass = most - before;
    while (done < wanted && !monitor.stop) {
        if (!pass) {
            pass = pass_within(job, done, before, wanted, job.wall_s() - start_s);
            if (*pass == 0) break;
        }
        executor.run(static_cast<int>(tiles.size()), [&](int task, int worker) {
            if (monitor.stop || monitor.pause) return;
            PathStats& stats = workers[static_cast<size_t>(worker)].stats;
            const Rect& tile = tiles[static_cast<size_t>(task)];
            const uint64_t samples_before = stats.samples;
            SampleBatch<Tracer> batch(tracer, camera, job, film.full_size(), &film, stats);
            for (int y = tile.y0; y < tile.y1; ++y)
                for (int x = tile.x0; x < tile.x1; ++x)
                    for (uint32_t i = film.taken_count(x, y); i < done + *pass; ++i)
                        batch.add({x, y, job.first_sample + i});
            batch.render();
            stats.tiles += stats.samples > samples_before;
            monitor.pixel_samples_done += stats.samples - samples_before;
        });
        // The tiles that a pause left out are rendered when the pass is run once more.
        if (monitor.pause.exchange(false)) {
            if (job.at_pause && !monitor.stop) job.at_pause(total());
        } else if (!monitor.stop) {
            done += *pass;
            pass.reset();
        }
    }
    RenderResult result;
    result.stats = total();
    result.end_sample = job.first_sample + film.taken_range().least;
    result.stopped = monitor.stop && result.end_sample < job.end_sample;
    for (const Worker& worker : workers) result.workers += worker.stats.tiles > 0;
    return result;
}

class TbbExecutor;
extern template class SampleBatch<PathTracer<>>;
extern template RenderResult render(const PathTracer<>&, const Camera&, const RenderJob&, Film&,
                                    TbbExecutor&, RenderMonitor&);

}  // namespace petzval
