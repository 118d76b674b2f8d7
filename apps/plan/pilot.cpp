// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/pilot.h"

#include <algorithm>
#include <utility>

#include "apps/setup/tracer.h"
#include "core/sampling/prepass_seed.h"
#include "core/sampling/sampler.h"
#include "integrator/prepass/pilot_batch.h"
#include "io/base/clock.h"

namespace petzval::apps {

RenderSetup view_of(const RenderSetup& first, const SceneRequest& scene,
                    integrator::TbbExecutor& executor) {
    return executor.inside([&] { return set_up_view(first, scene, [](const std::string&) {}); });
}

PilotModel::PilotModel(RenderSetup setup, const integrator::RenderJob& job,
                       const integrator::PathOptions& options,
                       const std::vector<PilotPixel>& chosen)
    : setup_(std::move(setup)),
      tracer_(tracer_of(setup_, options)),
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
        case camera::DispersionMode::Shared:
            return 1;
        case camera::DispersionMode::Hero:
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

Pilot::Pilot(V2i size_px, PilotPixels chosen, integrator::TbbExecutor& executor, uint32_t seed)
    : size_px_(size_px), seed_(seed), chosen_(std::move(chosen)), executor_(executor) {}

Pilot::Pilot(V2i size_px, int wanted, integrator::TbbExecutor& executor, uint32_t seed)
    : Pilot(size_px, even_pilot_pixels(size_px, wanted, seed), executor, seed) {}

std::unique_ptr<PilotModel> Pilot::model(RenderSetup setup, const integrator::RenderJob& job,
                                         const integrator::PathOptions& options) const {
    return std::unique_ptr<PilotModel>(
        new PilotModel(std::move(setup), job, options, chosen_.pixels));
}

void Pilot::sample(PilotModel& model, uint32_t samples) const {
    integrator::PilotBatch batch{size_px_, {}, model.samples_, samples, {}, {}};
    for (const PilotPixel& pixel : chosen_.pixels) batch.pixels.push_back(pixel.pixel);
    for (uint32_t k = 0; k < kPilotReplicates; ++k)
        batch.seeds.push_back(number_of(PrepassSeed::Plan) + kPilotReplicates * seed_ + k);
    const double start_s = io::process_cpu_s();
    model.stats_ += render_pilot(model.tracer_, *model.setup_.view.camera, model.job_, batch,
                                 executor_, [&](const integrator::PilotFilm& film) {
                                     const V4f c = film.colour;
                                     model.sums_[film.pixel][film.replicate] +=
                                         V3d(c.x, c.y, c.z) * double(film.samples);
                                     model.pixel_s_[film.pixel] += film.seconds;
                                 });
    model.cpu_s_ += io::process_cpu_s() - start_s;
    model.samples_ = std::max(model.samples_, samples);
    std::vector<PilotValues> turn;
    for (size_t p = 0; p < pixels(); ++p) turn.push_back(model.means(p));
    model.turns_.push_back(std::move(turn));
}

}  // namespace petzval::apps
