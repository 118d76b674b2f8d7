// SPDX-License-Identifier: Apache-2.0
// The cheapest way to render a scene that stays within a tolerance, and on what grounds. Errors are
// roots of the symmetric MSE (io/image/symmetric_mse.h) against the fullest model: wavelengths, one
// ray for each.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "apps/plan/mode_choice.h"
#include "apps/plan/plan_details.h"
#include "apps/plan/plan_types.h"
#include "apps/setup/diffraction.h"
#include "integrator/render/executor.h"

namespace petzval::apps {

/// Choice of a plan, and every figure that led to it. plan_wording.h puts it into sentences.
struct Plan {
    SceneRequest scene;  ///< that the choice renders
    PlanModel chosen = PlanModel::Full;
    std::vector<PlanCandidate> candidates;  ///< chosen or not; last the fullest model
    Provenance requested;                   ///< what the request itself turned out to be
    bool dispersion_open = false;           ///< candidates differ in how wavelengths share rays
    bool anything_open = false;
    /// RMS lateral dispersion in pixels, where it was measured.
    std::optional<double> dispersion_px;
    /// Set where spectra are asked for: the mode that choose_mode() found.
    std::optional<ModeChoice> measured_mode;
    std::optional<PrecisionFound> precision;  ///< where a lens is traced
    bool lights_asked = false;                ///< the request fixes how lights are chosen
    std::optional<LightsFound> lights;        ///< where there are several to choose from
    std::optional<GhostsFound> ghosts;        ///< where a lens is traced
    DiffractionEffect diffraction;            ///< of the camera that was asked for
    double bias = 0, noise = 0;               ///< predicted, of what was chosen with `samples`
    double first_noise = 0;                   ///< with one sample
    bool noise_at_least = false;              ///< rare light may add to the noise
    RareLight rare;                           ///< what light that is
    uint64_t samples = 0;                     ///< of each pixel
    double cpu_s = 0;                         ///< about what the samples take here
    double load_s = 0;                        ///< until the first sample
    int threads = 1;                          ///< that share it

    [[nodiscard]] double error() const { return std::hypot(bias, noise); }
    /// Wall time of the render, s, where nothing else runs here.
    [[nodiscard]] double wall_s() const { return load_s + cpu_s / threads; }
    /// Interval of wall_s() that holds in nine of ten renders: docs/measured/plan.md.
    static constexpr double kLeastTime = 0.75, kMostTime = 1.3;
    /// The candidate of a model; nullptr where it was none.
    [[nodiscard]] const PlanCandidate* find(PlanModel) const;
};

/// Plan of a scene, from measuring it through all models; takes up to most_samples in all, some
/// seconds. Throws as set_up_render does.
[[nodiscard]] Plan make_plan(const PlanRequest&, integrator::TbbExecutor&, const io::Notice& notice,
                             double most_samples = 5e6);

/// Choice that `auto` made for a render, and its grounds.
struct AutoChoice {
    /// Dispersion mode; absent where it was not open.
    std::optional<camera::DispersionMode> dispersion;
    double dispersion_px = 0;
    std::string dispersive_lens;
    std::optional<ModeChoice> measured_mode;  ///< where choose_mode() was asked
    bool dispersion_compared = false;         ///< sharing one ray is a candidate
    std::vector<PlanCandidate> candidates;    ///< empty where nothing was measured
    /// Index among the candidates of the simpler model that was taken; absent where none was.
    std::optional<size_t> taken;
};

struct AutoSetup {
    RenderSetup setup;
    AutoChoice choice;
};

/// Setup as set_up_render gives it, with what the request leaves open (RGB or wavelengths,
/// dispersion mode) chosen by a pilot of at most a fifth of a sample for each pixel of the whole
/// frame, and that of choose_mode(): samples, seed and crop do not matter.
/// Without a pilot where nothing depends on wavelength, and without the first for frames too small
/// for it. No camera that was asked for is replaced.
[[nodiscard]] AutoSetup set_up_planned(const PlanRequest&, integrator::TbbExecutor&,
                                       const io::Notice& notice, const PhaseSink& begins = {});

}  // namespace petzval::apps
