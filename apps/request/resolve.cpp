// SPDX-License-Identifier: Apache-2.0
// Values that follow from several members of a request.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/request/render_order.h"
#include "apps/request/value_error.h"
#include "core/film/spectral_film.h"
#include "io/base/machine.h"
#include "io/file/csv.h"

namespace petzval::apps {
namespace {

double time_s(const Moment& at, double fps) {
    constexpr double kMost_s = 1e6;
    const double s = at.is_frame ? at.value / fps : at.value;
    if (!(std::fabs(s) <= kMost_s))
        throw ValueError(
            "⟨at⟩", fmt::format("frame:{} is not a time of at most {:g} s", at.value, kMost_s));
    return s;
}

float shutter_s(const ShutterTime& time, double fps) {
    const auto s = static_cast<float>(time.is_angle ? time.value / 360 / fps : time.value);
    if (!(s >= 1e-9f && s <= 1e9f))
        throw ValueError(
            "⟨shutter⟩",
            fmt::format("{}deg of a frame is not a time of 1e-9 to 1e9 seconds", time.value));
    return s;
}

camera::ShutterCurve curve_in(const std::string& file) {
    if (file.find('.') == file.npos && file.find('/') == file.npos)
        throw ValueError(
            "⟨shutter-curve⟩",
            fmt::format("\"{}\" is neither box, trapezoid nor the name of a CSV file", file));
    const io::CsvTable table = io::read_csv(file);
    if (table.names.size() != 2)
        throw io::InputError(file, table.place(0), "must hold two columns, time and open");
    if (table.rows.size() < 2)
        throw io::InputError(file, table.place(0), "must hold two rows at least");
    const double first = table.rows.front()[0], whole = table.rows.back()[0] - first;
    camera::ShutterCurve curve;
    for (size_t i = 0; i < table.rows.size(); ++i) {
        const auto& row = table.rows[i];
        if (i > 0 && !(row[0] >= table.rows[i - 1][0]))
            throw io::InputError(file, table.place(i),
                                 "is at an earlier time than the row before it");
        if (!(row[1] >= 0 && row[1] <= 1e6))
            throw io::InputError(file, table.place(i), "is open by less than 0, or over 1e6");
        curve.points.push_back(
            {static_cast<float>((row[0] - first) / whole), static_cast<float>(row[1])});
    }
    if (!(whole > 0) || !(curve.efficiency() > 0))
        throw io::InputError(file, table.place(0), "never lets any light in");
    return curve;
}

camera::ShutterCurve curve_of(const std::string& text) {
    if (text.empty() || text == "box") return camera::ShutterCurve::box();
    return text == "trapezoid" ? camera::ShutterCurve::trapezoid() : curve_in(text);
}

}  // namespace

SceneRequest resolved_scene(const RenderRequest& request) {
    SceneRequest scene = request.scene;
    const MomentRequest& moment = request.moment;
    if (moment.shutter) {
        scene.camera.shutter_s = shutter_s(*moment.shutter, moment.fps);
        if (moment.at) scene.camera.shutter_curve = curve_of(moment.shutter_curve);
    }
    if (moment.at)
        scene.choices.animation = io::AnimationChoice{
            time_s(*moment.at, moment.fps), moment.animations, moment.loop, scene.camera.open_s()};
    return scene;
}

int threads_of(const RunRequest& run) {
    return run.threads > 0 ? run.threads : std::min(io::usable_threads(), kMostThreads);
}

integrator::RenderJob job_of(const RenderRequest& request) {
    const SampleRequest& samples = request.samples;
    integrator::RenderJob job;
    job.time_limit_s = samples.time_limit_s;
    const uint32_t usual = samples.noise ? kUsualNoiseSamples : kUsualSamples;
    job.end_sample = samples.count.value_or(job.time_limit_s ? kMostSamples : usual);
    if (samples.range) {
        job.first_sample = samples.range->first;
        job.end_sample = samples.range->end;
    }
    job.seed = samples.seed;
    job.sampler = samples.sampler;
    job.clamp_nits = samples.clamp_nits;
    const float usual_radius_px = samples.filter == FilterKind::Box ? 0.5f : 1.5f;
    job.filter = Filter(samples.filter, samples.filter_radius_px.value_or(usual_radius_px));
    if (request.denoise) job.denoised_error = samples.noise;
    job.replicates = request.scene.spectral.bins ? kReplicates : request.denoise ? kHalves : 1;
    return job;
}

}  // namespace petzval::apps
