// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/pilot.h"

#include <algorithm>
#include <utility>

#include "core/sampling/prepass_seed.h"
#include "core/sampling/sampler.h"
#include "integrator/render/render.h"
#include "io/base/clock.h"

namespace petzval {
namespace {

PathOptions with_background(PathOptions options, const View& view) {
    options.visible_background = view.visible_background;
    return options;
}

}  // namespace

RenderSetup view_of(const RenderSetup& first, const SceneRequest& scene, TbbExecutor& executor) {
    return executor.inside([&] { return set_up_view(first, scene, [](const std::string&) {}); });
}

PilotModel::PilotModel(RenderSetup setup, const RenderJob& job, const PathOptions& options,
                       const std::vector<PilotPixel>& chosen)
    : setup_(std::move(setup)),
      tracer_(*setup_.prepared.scene, *setup_.prepared.bvh, *setup_.prepared.lights,
              with_background(options, setup_.view)),
      sums_(chosen.size()),
      pixel_s_(chosen.size()) {
    for (const PilotPixel& pixel : chosen) weights_.push_back(pixel.weight);
    job_.sampler = job.sampler;
    job_.filter = job.filter;
    job_.replicates = job.replicates;
    job_.observer = setup_.view.observer;
}

PilotValues PilotModel::means(size_t pixel) const {
    PilotValues out = sums_[pixel];
    for (V3d& v : out) v /= double(samples_);
    return out;
}

double PilotModel::rays_per_sample() const {
    const uint64_t rays = stats_.camera_rays + stats_.bounce_rays + stats_.shadow_rays;
    return static_cast<double>(rays) / static_cast<double>(stats_.samples) + lens_rays() +
           rays_to_find_targets();
}

// Measured with the Takumar on a Cornell box: 0.23, 0.56 and 0.74 us where a ray of the scene takes
// 0.24 us with all that hangs on it.
double PilotModel::lens_rays() const {
    if (stats_.lens_lanes.drawn == 0) return 0;
    if (!setup_.view.observer.spectral()) return 1;
    switch (setup_.from.camera.dispersion()) {
        case DispersionMode::Shared:
            return 1;
        case DispersionMode::Hero:
            return 2;
        default:
            return 3;
    }
}

// The search for a ray to a target. Counted in instructions, with the Takumar: three searches for a
// ray, of 21 to 28 steps each.
double PilotModel::rays_to_find_targets() const {
    constexpr double kSearch = 60;
    return kSearch * static_cast<double>(stats_.target_rays) / static_cast<double>(stats_.samples);
}

// The pilot pixels are not even over the frame, and what is sampled more may cost more: the times
// of the pilot pixels weigh the CPU time, which other programs do not disturb.
double PilotModel::cpu_s_per_sample() const {
    double even = 0, weighed = 0, weights = 0;
    for (size_t p = 0; p < pixel_s_.size(); ++p) {
        even += pixel_s_[p] / static_cast<double>(pixel_s_.size());
        weighed += pixel_s_[p] * weights_[p];
        weights += weights_[p];
    }
    const double mean = cpu_s_ / static_cast<double>(stats_.samples);
    return even > 0 ? mean * weighed / weights / even : mean;
}

Pilot::Pilot(V2i size_px, PilotPixels chosen, TbbExecutor& executor, uint32_t seed)
    : size_px_(size_px), seed_(seed), chosen_(std::move(chosen)), executor_(executor) {}

Pilot::Pilot(V2i size_px, int wanted, TbbExecutor& executor, uint32_t seed)
    : Pilot(size_px, even_pilot_pixels(size_px, wanted, seed), executor, seed) {}

std::unique_ptr<PilotModel> Pilot::model(RenderSetup setup, const RenderJob& job,
                                         const PathOptions& options) const {
    return std::unique_ptr<PilotModel>(
        new PilotModel(std::move(setup), job, options, chosen_.pixels));
}

void Pilot::sample(PilotModel& model, uint32_t samples) const {
    std::vector<PathStats> stats(static_cast<size_t>(executor_.threads()));
    const double start_s = process_cpu_s();
    executor_.run(static_cast<int>(pixels()), [&](int task, int worker) {
        const auto pixel = static_cast<size_t>(task);
        const auto [x, y] = chosen_.pixels[pixel].pixel;
        const double pixel_start_s = steady_s();
        RenderJob job = model.job_;
        for (uint32_t k = 0; k < kPilotReplicates; ++k) {
            Film film(size_px_, {x, y, x + 1, y + 1}, {});
            job.seed = number_of(PrepassSeed::Plan) + kPilotReplicates * seed_ + k;
            render_samples(model.tracer_, *model.setup_.view.camera, job,
                           {{x, y}, model.samples_, samples}, film,
                           stats[static_cast<size_t>(worker)]);
            const V4f c = film.colour(x, y);
            model.sums_[pixel][k] += V3d(c.x, c.y, c.z) * double(film.sample_count(x, y));
        }
        model.pixel_s_[pixel] += steady_s() - pixel_start_s;
    });
    model.cpu_s_ += process_cpu_s() - start_s;
    model.samples_ = std::max(model.samples_, samples);
    for (const PathStats& s : stats) model.stats_ += s;
    std::vector<PilotValues> turn;
    for (size_t p = 0; p < pixels(); ++p) turn.push_back(model.means(p));
    model.turns_.push_back(std::move(turn));
}

}  // namespace petzval
