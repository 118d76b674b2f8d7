// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/plan_comparison.h"

#include <algorithm>
#include <cmath>

#include "apps/plan/dispersion_spread.h"
#include "apps/setup/equivalent_camera.h"

namespace petzval {
namespace {

// Wavelengths are parted so far that they stand out of the noise, but stay within a pixel: there
// the error grows in proportion.
constexpr double kParted_px = 0.35, kMostFactor = 64;
constexpr uint32_t kLeastSamples = 4, kThoroughSamples = 32;
constexpr double kSmallShare = 0.25;  // of the tolerance: smaller errors are told no finer

}  // namespace

PlanOpen::PlanOpen(const SceneRequest& request, const Session& session) {
    if (!session.observer.spectral()) return;
    const bool disperses = !session.dispersive_lens.empty();
    // Spectra are more than a picture: nothing is taken from them.
    parted = disperses && !session.camera_report.asked.dispersion;
    dispersion = parted && !request.spectral.bins;
    spectral = !asks_for_wavelengths(request.spectral) && (dispersion || !disperses);
}

PlanComparison::PlanComparison(const PlanRequest& request, const Session& first,
                               const PlanOpen& open, int pixels, TbbExecutor& executor)
    : request_(request),
      first_(first),
      open_(open),
      full_scene_(resolved_request(first)),
      executor_(executor),
      pilot_(request.scene.size, pixels, executor) {
    if (first.observer.spectral()) full_scene_.spectral.mode = SpectralMode::Wavelengths;
    if (open.dispersion) {
        part_wavelengths();
        return;
    }
    full_ = model(full_scene_);
    minus_full_ = {{full_.get(), -1}};
    scale_ = full_.get();
}

// What parts wavelengths is told from what does not by a lens that parts them further.
void PlanComparison::part_wavelengths() {
    shared_scene_ = full_scene_;
    full_scene_.camera.dispersion = DispersionMode::Split;
    shared_scene_.camera.dispersion = DispersionMode::Shared;
    shared_ = model(shared_scene_);
    spread_px_ = spread_px(open(full_scene_), shared_->session(), request_.scene.size);
    if (spread_px_ > 0)
        factor_ = static_cast<float>(std::clamp(kParted_px / spread_px_, 1., kMostFactor));
    full_ = further(full_scene_);
    const double share = 1 / double(factor_);
    minus_full_ = {{shared_.get(), share - 1}, {full_.get(), -share}};
    scale_ = shared_.get();
}

Session PlanComparison::open(const SceneRequest& scene) const {
    return executor_.inside([&] {
        return open_session(
            scene, [](const std::string&) {}, &first_);
    });
}

std::unique_ptr<PilotModel> PlanComparison::model(const SceneRequest& scene) const {
    return pilot_.model(open(scene), request_.job, request_.path);
}

std::unique_ptr<PilotModel> PlanComparison::further(const SceneRequest& scene) const {
    Session session = open(scene);
    session.camera = parted_further(std::move(session.camera), open(shared_scene_).camera, factor_);
    return pilot_.model(std::move(session), request_.job, request_.path);
}

void PlanComparison::add(const std::string& name, const SceneRequest& scene) {
    auto own = model(scene);
    std::vector<PilotTerm> difference = minus_full_;
    difference.push_back({own.get(), 1});
    entries_.push_back({{name, scene}, own.get(), std::move(difference), std::move(own)});
}

void PlanComparison::add_simpler_cameras() {
    const CameraReport& report = first_.camera_report;
    if (report.orthographic || !(report.lens_radius_m > 0)) return;
    const SceneRequest scene = resolved_request(first_);
    if (scene.camera.exposure != ExposureMode::Photographic)
        add("pinhole", equivalent_pinhole(scene, first_));
    if (!report.lens.empty()) add("thin", equivalent_thin_lens(scene, first_));
}

void PlanComparison::add_rgb() {
    SceneRequest scene = full_scene_;
    scene.spectral.mode = SpectralMode::Rgb;
    if (open_.dispersion) scene.camera.dispersion = DispersionMode::Shared;
    add("rgb", scene);
}

void PlanComparison::add_shared() {
    const double share = 1 / double(factor_);
    entries_.push_back({{"shared", shared_scene_},
                        shared_.get(),
                        {{shared_.get(), share}, {full_.get(), -share}},
                        nullptr});
}

void PlanComparison::add_parted(const std::string& name, DispersionMode dispersion) {
    SceneRequest scene = full_scene_;
    scene.camera.dispersion = dispersion;
    auto own = further(scene);
    const double share = 1 / double(factor_);
    entries_.push_back(
        {{name, scene}, own.get(), {{own.get(), share}, {full_.get(), -share}}, std::move(own)});
}

void PlanComparison::add_unbiased(const std::string& name, DispersionMode dispersion) {
    SceneRequest scene = full_scene_;
    scene.camera.dispersion = dispersion;
    auto own = model(scene);
    entries_.push_back({{name, scene}, own.get(), {}, std::move(own)});
}

void PlanComparison::look(double most_samples, bool thorough) {
    double models = shared_ ? 2 : 1;
    for (const Entry& e : entries_) models += e.own != nullptr;
    const double once = static_cast<double>(pilot_.pixels()) * kPilotReplicates * models;
    for (uint32_t n = 1;; n *= 2) {
        pilot_.look(*full_, n);
        if (shared_) pilot_.look(*shared_, n);
        for (const Entry& e : entries_)
            if (e.own) pilot_.look(*e.own, n);
        evaluate();
        if (once * 2 * n > most_samples) return;
        if (n >= (thorough ? kThoroughSamples : kLeastSamples) && settled_all(thorough)) return;
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

bool PlanComparison::settled_all(bool thorough) const {
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
    PlanCandidate full{open_.dispersion ? "split" : "full", full_scene_};
    full.inside = true;
    measured(std::move(full), *full_);
    return out;
}

double PlanComparison::cpu_s_per_sample(size_t candidate) const {
    return candidate < entries_.size() ? entries_[candidate].model->cpu_s_per_sample()
                                       : full_->cpu_s_per_sample();
}

}  // namespace petzval
