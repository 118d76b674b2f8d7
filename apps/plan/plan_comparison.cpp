// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/plan_comparison.h"

#include <algorithm>
#include <cmath>

#include "apps/plan/displacement.h"
#include "apps/setup/equivalent_camera.h"
#include "apps/setup/wavelength_reasons.h"
#include "camera/setup/lateral_dispersion.h"
#include "io/image/symmetric_mse.h"

namespace petzval::apps {
namespace {

constexpr uint32_t kLeastSamples = 4, kThoroughSamples = 32;
// Share of the tolerance below which errors are not measured more finely.
constexpr double kSmallShare = 0.25;
/// Share of the samples of a plan that may go to noise alone.
constexpr double kNoiseShare = 0.25;
/// Rays of a cell that two cameras are compared by.
constexpr uint32_t kDispersionRays = 64, kCameraRays = 256;
/// Share of the noise that may come from light that was hardly met.
constexpr double kKnownShare = 0.1;
/// Most that RGB may be off in a pixel by itself, where nothing in the scene depends on wavelength
/// but surfaces reflect each other's colours: a quarter, squared. The worst pixel measured in the
/// scenes at hand is off by 12 %.
constexpr double kRgbItself = 1 / 16.;
/// Emphasis of the edges of the frame over its middle.
constexpr double kEdges = 4;

FilmMap even_map(V2i size) {
    const V2i cells(std::min(16, size.x), std::min(9, size.y));
    return {cells, std::vector<double>(static_cast<size_t>(cells.x) * cells.y, 1.)};
}

/// The map, with more on the outermost cells, above 0 everywhere.
FilmMap with_edges(FilmMap map) {
    double sum = 0;
    for (const double value : map.values) sum += value;
    const double mean = sum > 0 ? sum / static_cast<double>(map.values.size()) : 1;
    for (int j = 0; j < map.cells.y; ++j)
        for (int i = 0; i < map.cells.x; ++i) {
            const bool edge = i == 0 || j == 0 || i + 1 == map.cells.x || j + 1 == map.cells.y;
            map.values[static_cast<size_t>(j) * map.cells.x + i] += (edge ? kEdges : 1) * mean / 8;
        }
    return map;
}

bool has_lamps(const std::vector<SmallFeature>& features) {
    return std::any_of(features.begin(), features.end(),
                       [](const SmallFeature& t) { return t.is_lamp(); });
}

}  // namespace

double PlanCandidate::variance_of_one() const {
    double most = 0;
    for (size_t d = 0; d < noise.variances.size(); ++d)
        most = std::max(most, noise.variances[d].mean * std::exp2(d));
    return most;
}

double PlanCandidate::block_variance(size_t digit) const {
    const size_t last = noise.variances.size() - 1, known = std::min(digit, last);
    double variance = noise.variances[known].high();
    // A few samples may have met nothing of what holds the noise. More of them are spread no worse:
    // their variance falls at least in proportion.
    for (size_t d = known + 1; d <= last; ++d)
        variance = std::max(variance, noise.variances[d].mean * std::exp2(d - known));
    return variance * std::exp2(known) / std::exp2(digit);
}

// A number of samples that is no power of 2 is a sum of blocks that are: each is as well spread as
// the first of its size, and they hardly know of each other.
double PlanCandidate::variance_with(uint64_t samples) const {
    const auto n = static_cast<double>(samples);
    double sum = rare.noise / n;
    for (size_t digit = 0; samples >> digit > 0; ++digit) {
        if ((samples >> digit & 1) == 0) continue;
        const double block = std::exp2(digit);
        sum += block_variance(digit) * block * block / (n * n);
    }
    return std::min(sum, io::kMostSymmetricMse);
}

bool PlanCandidate::noise_at_least() const {
    const double first = variance_of_one();
    return (first > 0 && noise.parts < kEnoughPaths) || rare.by_chance() ||
           rare.noise > kKnownShare * first;
}

double PlanCandidate::samples_for(double tolerance) const {
    const double left = tolerance * tolerance - square_bias.high();
    if (!(left > 0)) return INFINITY;
    const double most = noise.variances.back().high() * std::exp2(noise.variances.size() - 1);
    if (!((most + rare.noise) / left < kMostPlannedSamples)) return INFINITY;
    uint64_t samples = 1;
    while (variance_with(samples) > left) samples *= 2;
    // Between two powers of 2 it may go up and down: by steps of about a hundredth.
    uint64_t fewer = samples / 2 + 1;
    while (fewer < samples && variance_with(fewer) > left)
        fewer += std::max<uint64_t>(1, fewer / 128);
    return static_cast<double>(std::min(fewer, samples));
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
                               const PlanOpen& open, int pixels, integrator::TbbExecutor& executor)
    : request_(request),
      first_(first),
      open_(open),
      full_scene_(resolved_request(first)),
      executor_(executor) {
    if (first.from.spectral.wavelengths) full_scene_.spectral.mode = SpectralMode::Wavelengths;
    std::optional<RenderSetup> shared;
    if (open.dispersion) {
        shared_scene_ = full_scene_;
        full_scene_.camera.dispersion = camera::DispersionMode::Split;
        shared_scene_.camera.dispersion = camera::DispersionMode::Shared;
        shared = this->open(shared_scene_);
    }
    RenderSetup full = this->open(full_scene_);
    if (shared) compare_dispersion(full, *shared);
    choose_pilot_pixels(pixels);
    if (shared) shared_ = model(*std::move(shared));
    full_ = model(std::move(full));
}

void PlanComparison::compare_dispersion(const RenderSetup& split, const RenderSetup& shared) {
    const V2i size = request_.scene.size;
    const camera::FocusPlane focus = first_.from.camera.focus_plane();
    dispersion_px_ = camera::lateral_dispersion_px(*split.view.still, *shared.view.still,
                                                   split.view.observer, focus, size);
    dispersed_ = most_error(
        displacement_of({*split.view.still, split.view.observer},
                        {*shared.view.still, shared.view.observer}, *first_.prepared.scene,
                        *first_.prepared.bvh, focus, size, kDispersionRays, true),
        0);
}

// Things that shine or depend on wavelength get pilot pixels where their light lands, and so does
// what a lens with dispersion may change most, its corners and the edges of the frame.
void PlanComparison::choose_pilot_pixels(int wanted) {
    const Scene& scene = *first_.prepared.scene;
    const V2i size = request_.scene.size;
    features_ = features_of(first_);
    glass_disperses_ = std::any_of(scene.materials.begin(), scene.materials.end(),
                                   [](const Material& m) { return m.glass && m.refracts(); });
    regions_ = camera::film_regions(*first_.view.still, size, features_);
    lamps_ = seen_lamps(first_, size, features_, regions_);
    pilot_.emplace(
        size,
        apps::choose_pilot_pixels(size, wanted, regions_,
                                  with_edges(open_.dispersion ? dispersed_ : even_map(size)), 0),
        executor_);
}

RenderSetup PlanComparison::open(const SceneRequest& scene) const {
    return view_of(first_, scene, executor_);
}

std::unique_ptr<PilotModel> PlanComparison::model(RenderSetup setup) const {
    return pilot_->model(std::move(setup), request_.job, request_.path);
}

void PlanComparison::add(PlanModel kind, const SceneRequest& scene, const FilmMap& most) {
    auto own = model(open(scene));
    entries_.push_back({{kind, scene},
                        own.get(),
                        {{own.get(), 1}, {full_.get(), -1}},
                        pilot_->chosen().unseen(request_.scene.size, most),
                        std::move(own)});
}

void PlanComparison::add_camera(PlanModel kind, const SceneRequest& scene) {
    const RenderSetup simpler = open(scene), fuller = open(shared_ ? shared_scene_ : full_scene_);
    const Displacement displacement = displacement_of(
        {*simpler.view.still, simpler.view.observer}, {*fuller.view.still, fuller.view.observer},
        *first_.prepared.scene, *first_.prepared.bvh, first_.from.camera.focus_plane(),
        request_.scene.size, kCameraRays, false);
    FilmMap most = most_error(displacement, 0);
    // What no ray met may lie at another depth, where the cameras differ by more.
    const double not_met = 3 * io::kMostSymmetricMse / static_cast<double>(displacement.rays + 1);
    add(kind, scene, most);
    if (!pilot_->chosen().all_certain) entries_.back().unseen += not_met;
}

void PlanComparison::add_simpler_cameras() {
    const CameraReport& report = first_.from.camera;
    if (report.orthographic || !(report.lens_radius_m > 0)) return;
    const SceneRequest scene = resolved_request(first_);
    if (scene.camera.exposure != ExposureMode::Photographic)
        add_camera(PlanModel::Pinhole, equivalent_pinhole(scene, first_));
    if (!report.lens.empty()) add_camera(PlanModel::Thin, equivalent_thin_lens(scene, first_));
}

void PlanComparison::add_rgb() {
    SceneRequest scene = full_scene_;
    scene.spectral.mode = SpectralMode::Rgb;
    if (open_.dispersion) scene.camera.dispersion = camera::DispersionMode::Shared;
    FilmMap most = open_.dispersion ? dispersed_ : even_map(request_.scene.size);
    const bool by_scene = !scene_reasons(*first_.prepared.scene).empty();
    for (double& value : most.values)
        value =
            by_scene ? io::kMostSymmetricMse : std::min(value + kRgbItself, io::kMostSymmetricMse);
    add(PlanModel::Rgb, scene, most);
}

void PlanComparison::add_shared() {
    entries_.push_back({{PlanModel::Shared, shared_scene_},
                        shared_.get(),
                        {{shared_.get(), 1}, {full_.get(), -1}},
                        pilot_->chosen().unseen(request_.scene.size, dispersed_),
                        nullptr});
}

void PlanComparison::add_unbiased(PlanModel kind, camera::DispersionMode dispersion) {
    SceneRequest scene = full_scene_;
    scene.camera.dispersion = dispersion;
    auto own = model(open(scene));
    entries_.push_back({{kind, scene}, own.get(), {}, 0, std::move(own)});
    entries_.back().found.inside = true;
}

bool PlanComparison::may_find_one() const {
    const double most = kBiasShare * request_.tolerance * request_.tolerance;
    return std::any_of(entries_.begin(), entries_.end(),
                       [&](const Entry& e) { return e.unseen <= most; });
}

void PlanComparison::measure(double most_samples, bool thorough) {
    double spent = 0;
    const auto sample = [&](PilotModel& model, uint32_t n) {
        spent +=
            static_cast<double>(pilot_->pixels() * kPilotReplicates) * double(n - model.samples());
        pilot_->sample(model, n);
    };
    for (uint32_t n = 1;; n *= 2) {
        const double before = spent;
        sample(*full_, n);
        if (shared_) sample(*shared_, n);
        for (Entry& e : entries_) {
            // What is far beyond the tolerance stays as it was found: others need the samples.
            e.settled = e.settled || (n > kLeastSamples && e.found.outside);
            if (e.own && !e.settled) sample(*e.own, n);
        }
        evaluate();
        const double next = 2 * (spent - before);
        if (spent + next > most_samples) return;
        if (n < (thorough ? kThoroughSamples : kLeastSamples) || !all_known(thorough)) continue;
        // Noise falls faster than in proportion: more turns tell how fast.
        if (!thorough || spent + next > kNoiseShare * most_samples) return;
    }
}

PilotScale PlanComparison::scale_of(const PilotModel& model, double floor) const {
    return {&model, &scale(), floor, least_};
}

double PlanComparison::missed(PlanModel kind, const RareLight& rare) const {
    if (kind == PlanModel::Rgb && glass_disperses_ && rare.by_chance())
        return io::kMostSymmetricMse;
    return rare.lost;
}

void PlanComparison::evaluate() {
    const double most = kBiasShare * request_.tolerance * request_.tolerance;
    least_ = least_means(*pilot_, scale(), lamps_);
    const double floor = pilot_floor(*pilot_, scale(), least_);
    const RareLight rare = rare_light(*pilot_, scale(), lamps_, has_lamps(features_), floor);
    for (Entry& e : entries_) {
        if (e.difference.empty() || e.settled) continue;
        e.found.square_bias = square_error(*pilot_, e.difference, scale_of(*e.model, floor));
        e.found.square_bias.unseen = e.unseen + missed(e.found.model, rare);
        e.found.inside = e.found.square_bias.high() <= most;
        e.found.outside = e.found.square_bias.low() > most;
    }
}

bool PlanComparison::all_known(bool thorough) const {
    const double small = std::pow(kSmallShare * request_.tolerance, 2);
    const double most = kBiasShare * request_.tolerance * request_.tolerance;
    return std::all_of(entries_.begin(), entries_.end(), [&](const Entry& e) {
        if (e.settled) return true;
        const Estimate& bias = e.found.square_bias;
        // More samples do not tell what other pixels hold.
        const double measured = bias.high() - bias.unseen;
        if (!thorough) return e.found.inside || e.found.outside || bias.unseen > most;
        return measured <= small || measured <= 4 * bias.low();
    });
}

std::vector<PlanCandidate> PlanComparison::candidates() const {
    std::vector<PlanCandidate> out;
    const double floor = pilot_floor(*pilot_, scale(), least_);
    const auto measured = [&](PlanCandidate found, const PilotModel& model) {
        found.noise = noise_of(*pilot_, model, scale_of(model, floor));
        // Through another camera lamps fall on other places: those of the pinhole are not blurred.
        if (found.model != PlanModel::Pinhole)
            found.rare = rare_light(*pilot_, model, lamps_, has_lamps(features_), floor);
        found.rays = model.rays_per_sample();
        out.push_back(std::move(found));
    };
    for (const Entry& e : entries_) measured(e.found, *e.model);
    PlanCandidate full{open_.dispersion ? PlanModel::Split : PlanModel::Full, full_scene_};
    full.inside = true;
    measured(std::move(full), *full_);
    return out;
}

const PilotModel& PlanComparison::model_of(size_t candidate) const {
    return candidate < entries_.size() ? *entries_[candidate].model : *full_;
}

double PlanComparison::cpu_s_per_sample(size_t candidate) const {
    return model_of(candidate).cpu_s_per_sample();
}

std::optional<double> PlanComparison::effort_of(const SceneRequest& scene, size_t candidate) const {
    const PilotModel& own = model_of(candidate);
    const auto other = model(open(scene));
    pilot_->sample(*other, own.samples());
    const double floor = pilot_floor(*pilot_, scale(), least_);
    const auto effort = [&](const PilotModel& m) {
        return noise_of(*pilot_, m, scale_of(own, floor)).variances.back().mean *
               m.rays_per_sample();
    };
    const double of_own = effort(own);
    if (!(of_own > 0)) return std::nullopt;
    return effort(*other) / of_own;
}

std::optional<double> PlanComparison::light_of(const SceneRequest& scene, size_t candidate) const {
    const auto other = model(open(scene));
    pilot_->sample(*other, kLeastSamples);
    const double of_own = mean_luminance(*pilot_, model_of(candidate));
    if (!(of_own > 0)) return std::nullopt;
    return mean_luminance(*pilot_, *other) / of_own;
}

}  // namespace petzval::apps
