// SPDX-License-Identifier: Apache-2.0
#include "integrator/prepass/light_pilot.h"

#include "core/sampling/prepass_seed.h"
#include "integrator/path/path_impl.h"
#include "integrator/prepass/pilot_pixels.h"
#include "integrator/render/sample_batch.h"

namespace petzval::integrator {
namespace {

constexpr uint32_t kPaths = 8192;

/// Watch that keeps what each light sample brings.
struct LightRecorder : Unwatched {
    std::vector<LightRecord>* to;

    void sampled(const LightChoice& lights, std::optional<uint32_t> light,
                 const LightReceiver& receiver, f4 brought) const {
        to->push_back(lights.record(light, receiver, hsum(brought)));
    }
};

}  // namespace

LightChoice fitted_by_pilot(const LightChoice& choice, const Scene& scene, const Bvh& bvh,
                            const camera::Camera& camera, const Observer& observer, V2i frame_px) {
    if (!choice.divides()) return choice;
    const LightChoice even = choice.for_pilot();
    std::vector<LightRecord> records;
    const PathTracer<Bvh, LightRecorder> tracer(scene, bvh, even, {}, {{}, &records});
    RenderJob job;
    job.seed = number_of(PrepassSeed::LightShares);
    job.observer = observer;
    PathStats stats;
    const auto pixels = pilot_pixels(frame_px, kPaths, number_of(PrepassSeed::LightShares));
    SampleBatch batch(tracer, camera, job, frame_px, nullptr, stats);
    for (uint32_t i = 0; i < kPaths; ++i) {
        const auto [x, y] = pixels[i % pixels.size()];
        batch.add({x, y, i});
    }
    batch.render();
    return choice.fitted(records);
}

}  // namespace petzval::integrator
