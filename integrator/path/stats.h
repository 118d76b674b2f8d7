// SPDX-License-Identifier: Apache-2.0
// Counts and times of one worker; the workers' sums are the render's.
#pragma once

#include <x86intrin.h>

#include <array>
#include <cstdint>

#include "camera/camera.h"

namespace petzval::integrator {

/// Timed sections. Sample is the whole; what the others leave of it is shading.
enum class TimedSection : uint8_t { Sample, Camera, Traversal, Texture, Count };

/// What paths met behind smooth surfaces, where no light is sampled: lamps are found by chance.
struct ChanceFinds {
    uint64_t bounces = 0;  ///< off smooth surfaces, or through them
    uint64_t lamps = 0;    ///< that emissive surfaces or suns of the sky were met right after one

    ChanceFinds& operator+=(const ChanceFinds& o) {
        bounces += o.bounces;
        lamps += o.lamps;
        return *this;
    }
};

struct PathStats {
    uint64_t camera_rays = 0, bounce_rays = 0, shadow_rays = 0;
    uint64_t target_rays = 0;    ///< of the camera rays, those to targets
    uint64_t vertices = 0;       ///< hits that were shaded
    uint64_t specular_ends = 0;  ///< paths that ended at PathOptions::max_specular_depth
    uint64_t tiles = 0;          ///< tiles that this worker rendered
    camera::LensLosses<uint64_t> lens_lanes;
    ChanceFinds mirrored;  ///< of paths that met smooth surfaces only
    ChanceFinds caustic;   ///< of paths that met a rough one before
    bool timing = false;   ///< the samples under way are among those that are timed
    uint64_t timed_samples = 0, samples = 0;
    std::array<uint64_t, static_cast<size_t>(TimedSection::Count)> ticks{};

    PathStats& operator+=(const PathStats& o) {
        camera_rays += o.camera_rays;
        bounce_rays += o.bounce_rays;
        shadow_rays += o.shadow_rays;
        target_rays += o.target_rays;
        vertices += o.vertices;
        specular_ends += o.specular_ends;
        tiles += o.tiles;
        lens_lanes += o.lens_lanes;
        mirrored += o.mirrored;
        caustic += o.caustic;
        timed_samples += o.timed_samples;
        samples += o.samples;
        for (size_t i = 0; i < ticks.size(); ++i) ticks[i] += o.ticks[i];
        return *this;
    }
};

/// Adds the time of its scope to a section, where the samples under way are timed.
class SectionTimer {
  public:
    SectionTimer(PathStats& stats, TimedSection section)
        : stats_(stats), section_(section), start_(stats.timing ? __rdtsc() : 0) {}
    ~SectionTimer() {
        if (stats_.timing) stats_.ticks[static_cast<size_t>(section_)] += __rdtsc() - start_;
    }
    SectionTimer(const SectionTimer&) = delete;
    SectionTimer& operator=(const SectionTimer&) = delete;

  private:
    PathStats& stats_;
    TimedSection section_;
    uint64_t start_;
};

/// Returns f(), timed as a section.
template <class F>
decltype(auto) timed(PathStats& stats, TimedSection section, const F& f) {
    const SectionTimer timer(stats, section);
    return f();
}

}  // namespace petzval::integrator
