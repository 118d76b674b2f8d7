// SPDX-License-Identifier: Apache-2.0
// The way of a sample: from a point of the film through the camera and along its paths to the film.
#pragma once

#include <array>

#include "camera/camera.h"
#include "core/film/film.h"
#include "core/spectrum/colour.h"
#include "integrator/path/path.h"
#include "integrator/render/render_job.h"
#include "integrator/render/velocity.h"

namespace petzval::integrator {

/// Seed of one of the replicates: a hash of the pair.
[[nodiscard]] inline uint32_t replicate_seed(uint32_t seed, uint32_t replicate) {
    return hash32(seed, replicate + 1);
}

/// Light of which no number of R, G and B is larger than a limit in magnitude, in the same colour.
/// Of infinite light NaN comes, which the film counts.
[[nodiscard]] inline f4 clamped(f4 light, const Bands& bands, std::optional<float> limit_nits) {
    if (!limit_nits) return light;
    const Rgb c = to_rgb(light, bands);
    const float largest = std::max({std::abs(c[0]), std::abs(c[1]), std::abs(c[2])});
    return largest > *limit_nits ? light * splat(*limit_nits / largest) : light;
}

/// Samples whose camera rays are found together: what the film gets of each is a pure function of
/// the job and its id. Holds as many as a camera takes at once; `render` must be called for those
/// that are left.
template <class Tracer>
class SampleBatch {
  public:
    /// All must outlive it. film: nullptr where only the paths' counts and records are wanted.
    SampleBatch(const Tracer& tracer, const camera::Camera& camera, const RenderJob& job,
                V2i frame_px, Film* film, PathStats& stats)
        : tracer_(tracer),
          camera_(camera),
          job_(job),
          frame_px_(frame_px),
          film_(film),
          stats_(stats),
          has_layers_(film && !film->aovs().empty()),
          has_guide_(film && film->keeps().halves) {}

    void add(SampleId id) {
        ids_[size_++] = id;
        if (size_ == camera::kMostFilmPoints) render();
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
    friend struct SampleRecord;
    /// One batch in sixteen, spread over pixels and samples.
    [[nodiscard]] static bool is_timed(SampleId first) {
        const uint32_t pixel =
            static_cast<uint32_t>(first.x) + 0x9e3779b9u * static_cast<uint32_t>(first.y);
        return hash32(hash32(pixel), first.index) % 16 == 0;
    }
    void find_camera_rays();
    void trace(size_t i);
    void add_to_film(size_t i, FilmSample&, const std::array<f4, 2>& light);
    /// Light that one of the camera's rays brings to a sample.
    [[nodiscard]] f4 light_along(const camera::CameraPath& path, size_t i, const PathStart& start,
                                 FilmSample& out) {
        const Sampler& sampler = points_[i].sampler;
        return path.weight * path.mis_weight *
               tracer_.radiance(start, bands_[i],
                                path.target_rays == 1
                                    ? sampler
                                    : sampler.branch(path.target_rays, path.target_ray),
                                out, stats_);
    }

    const Tracer& tracer_;
    const camera::Camera& camera_;
    const RenderJob& job_;
    V2i frame_px_;
    Film* film_;
    PathStats& stats_;
    bool has_layers_, has_guide_;
    size_t size_ = 0;
    std::array<SampleId, camera::kMostFilmPoints> ids_;
    std::array<camera::FilmPoint, camera::kMostFilmPoints> points_;
    std::array<Bands, camera::kMostFilmPoints> bands_;
    std::array<camera::CameraSample, camera::kMostFilmPoints> samples_;
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
    const std::span<const camera::FilmPoint> points(points_.data(), size_);
    const std::span<const Bands> bands(bands_.data(), size_);
    camera_.sample_all(points, bands, {samples_.data(), size_});
}

// Traces the rays of a sample.
template <class Tracer>
void SampleBatch<Tracer>::trace(size_t i) {
    const camera::CameraSample& rays = samples_[i];
    const uint64_t vertices_before = stats_.vertices;
    stats_.lens_lanes += rays.lanes;
    FilmSample sample;
    std::array<f4, 2> light{};  // in order, and of ghosts
    float behind = 0.f;         // weight of the rays that left the scene, over all lanes
    bool layers = has_layers_, guide = has_guide_;  // are still to be filled in
    for (const camera::CameraPath& path : rays) {
        FilmSample other;
        FilmSample& of_path = path.to_target ? other : sample;
        of_path.alpha = 0.f;
        // What surfaces reflect of a target is found by other rays as well: it is worth the effort
        // by the weight.
        const float effort = path.to_target ? path.mis_weight : 1.f;
        light[path.of_ghost] += light_along(path, i,
                                            {path.ray, path.lanes, path.hero_decided, effort,
                                             layers && !path.to_target, guide && !path.to_target},
                                            of_path);
        if (path.to_target) {
            stats_.target_rays += !path.of_ghost;
            continue;
        }
        layers = guide = false;
        behind += hsum(zero_off(path.lanes, path.weight)) * (1.f - sample.alpha);
    }
    if (!film_) return;
    // Light that a lens keeps from the film is black, not transparent.
    sample.alpha = 1.f - behind / (rays.exposure * static_cast<float>(lane_count(bands_[i].on)));
    sample.aov[static_cast<size_t>(Aov::Cost)] =
        V3f(static_cast<float>(stats_.vertices - vertices_before), 0, 0);
    add_to_film(i, sample, light);
}

// Ghosts are clamped by themselves, so that the rest is that of a picture without.
template <class Tracer>
void SampleBatch<Tracer>::add_to_film(size_t i, FilmSample& sample,
                                      const std::array<f4, 2>& light) {
    const SampleId id = ids_[i];
    const Bands& bands = bands_[i];
    const f4 ghosts = clamped(light[1], bands, job_.clamp_nits),
             all = clamped(light[0], bands, job_.clamp_nits) + ghosts;
    const Rgb of_ghosts = to_rgb(ghosts, bands);
    sample.colour = to_rgb(all, bands);
    sample.aov[static_cast<size_t>(Aov::Ghosts)] = {of_ghosts[0], of_ghosts[1], of_ghosts[2]};
    if (job_.velocity && sample.hit)
        sample.aov[static_cast<size_t>(Aov::Velocity)] =
            job_.velocity->at(sample.first, points_[i].film * V2f(frame_px_));
    if (film_->spectral())
        film_->add(id.x, id.y, id.index, sample,
                   {id.index % job_.replicates, all, job_.observer.to_xyz(all, bands)}, bands);
    else
        film_->add(id.x, id.y, id.index, sample);
}

extern template class SampleBatch<PathTracer<>>;

}  // namespace petzval::integrator
