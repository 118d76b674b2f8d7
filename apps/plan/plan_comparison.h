// SPDX-License-Identifier: Apache-2.0
// Simpler models of a render compared with the fullest one, until they are told apart.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "apps/plan/pilot.h"
#include "apps/plan/plan_types.h"

namespace petzval::apps {

/// Comparison of models by a pilot. What the constructor takes must outlive it.
class PlanComparison {
  public:
    /// The fullest model is what the setup shows with one ray for each wavelength; pixels: about so
    /// many pixels are rendered, where things that a few pixels hold have pilot pixels of their
    /// own.
    PlanComparison(const PlanRequest&, const RenderSetup&, const PlanOpen&, int pixels,
                   integrator::TbbExecutor&);

    /// Adds cameras without glass, and without an iris, in place of the setup's.
    void add_simpler_cameras();
    void add_rgb();
    /// Adds one ray for all wavelengths. Where dispersion is open.
    void add_shared();
    /// Adds a dispersion mode without an error, whatever wavelengths do: only its cost and noise
    /// are measured.
    void add_unbiased(PlanModel, camera::DispersionMode);

    /// Whether a candidate can be found to be inside: what pixels that are not sampled may hold
    /// is not too much for all of them.
    [[nodiscard]] bool may_find_one() const;
    /// Doubles the samples until it is known which candidates are inside, or where thorough until
    /// the predictions are good figures; never beyond most_samples of all models together.
    void measure(double most_samples, bool thorough);

    /// Candidates as added, and last the fullest model: it has no bias.
    [[nodiscard]] std::vector<PlanCandidate> candidates() const;
    [[nodiscard]] double cpu_s_per_sample(size_t candidate) const;
    /// Noise times cost in rays of a candidate's scene in another request, over the candidate's
    /// own: in proportion to the time that a given noise takes. Nothing where no noise was seen.
    [[nodiscard]] std::optional<double> effort_of(const SceneRequest&, size_t candidate) const;
    /// Mean light of a candidate's scene in another request, over that of the candidate, by a few
    /// samples. Nothing where no light was seen.
    [[nodiscard]] std::optional<double> light_of(const SceneRequest&, size_t candidate) const;
    /// RMS lateral dispersion in pixels; 0 unless dispersion is open.
    [[nodiscard]] double dispersion_px() const { return dispersion_px_; }

  private:
    struct Entry {
        PlanCandidate found;
        const PilotModel* model;
        std::vector<PilotTerm> difference;  ///< from the fullest
        double unseen;                      ///< PilotPixels::unseen()
        std::unique_ptr<PilotModel> own;    ///< the model, unless it is one of the others'
        bool settled = false;               ///< beyond the tolerance: sampled no more
    };

    [[nodiscard]] const PilotModel& model_of(size_t candidate) const;
    [[nodiscard]] RenderSetup open(const SceneRequest&) const;
    [[nodiscard]] std::unique_ptr<PilotModel> model(RenderSetup) const;
    /// The setups of one ray for each wavelength and of one for all.
    void compare_dispersion(const RenderSetup& split, const RenderSetup& shared);
    void choose_pilot_pixels(int wanted);
    void add(PlanModel, const SceneRequest&, const FilmMap& most);
    void add_camera(PlanModel, const SceneRequest&);
    void evaluate();
    /// Model to whose means errors are relative: of those whose pictures are nearly equal, the one
    /// with the least noise.
    [[nodiscard]] const PilotModel& scale() const { return shared_ ? *shared_ : *full_; }
    [[nodiscard]] PilotScale scale_of(const PilotModel&, double floor) const;
    /// Upper bound of the error by light that the pilot did not find, beyond that of unseen pixels.
    [[nodiscard]] double missed(PlanModel, const RareLight&) const;
    [[nodiscard]] bool all_known(bool thorough) const;

    const PlanRequest& request_;
    const RenderSetup& first_;
    PlanOpen open_;
    SceneRequest full_scene_, shared_scene_;
    integrator::TbbExecutor& executor_;
    std::vector<SmallFeature> features_;
    std::vector<camera::FilmRegion> regions_;
    std::vector<SeenLamp> lamps_;
    std::vector<V3d> least_;  ///< least_means() of the pilot pixels
    FilmMap dispersed_;       ///< most error of rays that do not disperse
    std::optional<Pilot> pilot_;
    std::unique_ptr<PilotModel> full_, shared_;
    std::vector<Entry> entries_;
    double dispersion_px_ = 0;
    bool glass_disperses_ = false;  ///< of a material
};

}  // namespace petzval::apps
