// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/plan_comparison.h"

#include <algorithm>
#include <cmath>

#include "apps/setup/equivalent_camera.h"
#include "camera/setup/lateral_dispersion.h"

namespace petzval {
namespace {

// Amplified dispersion: its effect stands out of the noise, but stays within a pixel, where the
// error grows in proportion.
constexpr double kAmplified_px = 0.35, kMostFactor = 64;
constexpr uint32_t kLeastSamples = 4, kThoroughSamples = 32;
// Share of the tolerance below which errors are not measured more finely.
constexpr double kSmallShare = 0.25;

}  // namespace

double PlanCandidate::variance_with(double samples) const {
    size_t turn = 0;
    while (turn + 1 < variances.size() && samples >= std::exp2(turn + 1)) ++turn;
    return variances[turn].high() * std::exp2(turn) / samples;
}

double PlanCandidate::samples_for(double tolerance) const {
    const double left = tolerance * tolerance - square_bias.high();
    for (size_t turn = 0;; ++turn) {
        const double samples = std::exp2(turn) * std::max(1., variances[turn].high() / left);
        if (turn + 1 == variances.size() || samples <= std::exp2(turn + 1)) return samples;
    }
}

PlanOpen::PlanOpen(const SceneRequest& request, const RenderSetup& setup) {
    if (!setup.from.spectral.wavelengths) return;
    const bool disperses = !setup.from.camera.dispersive_lens.empty();
    // Spectra are more than a picture: nothing may be left out of them.
    dispersion_mode = disperses && !setup.from.camera.asked.dispersion;
    dispersion = dispersion_mode && !request.spectral.bins;
    spectral = !asks_for_wavelengths(request.spectral) && (dispersion || !disperses);
}

PlanComparison::PlanComparison(const PlanRequest& request, const RenderSetup& first,
                               const PlanOpen& open, int pixels, TbbExecutor& executor)
    : request_(request),
      first_(first),
      open_(open),
      full_scene_(resolved_request(first)),
      executor_(executor),
      pilot_(request.scene.size, pixels, executor) {
    if (first.from.spectral.wavelengths) full_scene_.spectral.mode = SpectralMode::Wavelengths;
    if (open.dispersion) {
        amplify_dispersion();
        return;
    }
    full_ = model(full_scene_);
    minus_full_ = {{full_.get(), -1}};
    scale_ = full_.get();
}

// Amplifies dispersion, so that its effect stands out of the noise; the error is divided by the
// factor afterwards.
void PlanComparison::amplify_dispersion() {
    shared_scene_ = full_scene_;
    full_scene_.camera.dispersion = DispersionMode::Split;
    shared_scene_.camera.dispersion = DispersionMode::Shared;
    shared_ = model(shared_scene_);
    const RenderSetup split = open(full_scene_);
    dispersion_px_ = lateral_dispersion_px(*split.view.camera, *shared_->setup().view.camera,
                                           split.view.observer, split.from.camera.focus_plane(),
                                           request_.scene.size);
    if (dispersion_px_ > 0)
        factor_ = static_cast<float>(std::clamp(kAmplified_px / dispersion_px_, 1., kMostFactor));
    full_ = amplified(full_scene_);
    const double share = 1 / double(factor_);
    minus_full_ = {{shared_.get(), share - 1}, {full_.get(), -share}};
    scale_ = shared_.get();
}

RenderSetup PlanComparison::open(const SceneRequest& scene) const {
    return view_of(first_, scene, executor_);
}

std::unique_ptr<PilotModel> PlanComparison::model(const SceneRequest& scene) const {
    return pilot_.model(open(scene), request_.job, request_.path);
}

std::unique_ptr<PilotModel> PlanComparison::amplified(const SceneRequest& scene) const {
    RenderSetup setup = open(scene);
    setup.view.camera = amplified_dispersion(std::move(setup.view.camera),
                                             open(shared_scene_).view.camera, factor_);
    return pilot_.model(std::move(setup), request_.job, request_.path);
}

void PlanComparison::add(PlanModel kind, const SceneRequest& scene) {
    auto own = model(scene);
    std::vector<PilotTerm> difference = minus_full_;
    difference.push_back({own.get(), 1});
    entries_.push_back({{kind, scene}, own.get(), std::move(difference), std::move(own)});
}

void PlanComparison::add_simpler_cameras() {
    const CameraReport& report = first_.from.camera;
    if (report.orthographic || !(report.lens_radius_m > 0)) return;
    const SceneRequest scene = resolved_request(first_);
    if (scene.camera.exposure != ExposureMode::Photographic)
        add(PlanModel::Pinhole, equivalent_pinhole(scene, first_));
    if (!report.lens.empty()) add(PlanModel::Thin, equivalent_thin_lens(scene, first_));
}

void PlanComparison::add_rgb() {
    SceneRequest scene = full_scene_;
    scene.spectral.mode = SpectralMode::Rgb;
    if (open_.dispersion) scene.camera.dispersion = DispersionMode::Shared;
    add(PlanModel::Rgb, scene);
}

void PlanComparison::add_shared() {
    const double share = 1 / double(factor_);
    entries_.push_back({{PlanModel::Shared, shared_scene_},
                        shared_.get(),
                        {{shared_.get(), share}, {full_.get(), -share}},
                        nullptr});
}

void PlanComparison::add_unbiased(PlanModel kind, DispersionMode dispersion) {
    SceneRequest scene = full_scene_;
    scene.camera.dispersion = dispersion;
    auto own = model(scene);
    entries_.push_back({{kind, scene}, own.get(), {}, std::move(own)});
}

void PlanComparison::measure(double most_samples, bool thorough) {
    double models = shared_ ? 2 : 1;
    for (const Entry& e : entries_) models += e.own != nullptr;
    const double once = static_cast<double>(pilot_.pixels()) * kPilotReplicates * models;
    for (uint32_t n = 1;; n *= 2) {
        pilot_.sample(*full_, n);
        if (shared_) pilot_.sample(*shared_, n);
        for (const Entry& e : entries_)
            if (e.own) pilot_.sample(*e.own, n);
        evaluate();
        if (once * 2 * n > most_samples) return;
        if (n >= (thorough ? kThoroughSamples : kLeastSamples) && all_known(thorough)) return;
    }
}

void PlanComparison::evaluate() {
    const double most = kBiasShare * request_.tolerance * request_.tolerance;
    for (Entry& e : entries_) {
        e.found.square_bias = pilot_.square(e.difference, *scale_);
        e.found.inside = e.found.square_bias.high() <= most;
        e.found.outside = e.found.square_bias.low() > most;
    }
}

bool PlanComparison::all_known(bool thorough) const {
    const double small = std::pow(kSmallShare * request_.tolerance, 2);
    return std::all_of(entries_.begin(), entries_.end(), [&](const Entry& e) {
        const Estimate& bias = e.found.square_bias;
        if (!thorough) return e.found.inside || e.found.outside;
        return bias.high() <= small || bias.high() <= 4 * bias.low();
    });
}

std::vector<PlanCandidate> PlanComparison::candidates() const {
    std::vector<PlanCandidate> out;
    const auto measured = [&](PlanCandidate found, const PilotModel& model) {
        found.variances = pilot_.variances(model, *scale_);
        found.rays = model.rays_per_sample();
        out.push_back(std::move(found));
    };
    for (const Entry& e : entries_) measured(e.found, *e.model);
    PlanCandidate full{open_.dispersion ? PlanModel::Split : PlanModel::Full, full_scene_};
    full.inside = true;
    measured(std::move(full), *full_);
    return out;
}

double PlanComparison::cpu_s_per_sample(size_t candidate) const {
    return candidate < entries_.size() ? entries_[candidate].model->cpu_s_per_sample()
                                       : full_->cpu_s_per_sample();
}

}  // namespace petzval
