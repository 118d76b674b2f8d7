// SPDX-License-Identifier: Apache-2.0
// Simpler models of a render next to the fullest one, looked at until they are told apart.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/plan/pilot.h"
#include "apps/plan/plan.h"

namespace petzval {

/// What a request leaves to the plan.
struct PlanOpen {
    bool spectral = false;    ///< RGB or wavelengths
    bool dispersion = false;  ///< whether wavelengths that a lens parts may share a ray
    bool parted = false;      ///< how they are parted, where nothing is left out

    PlanOpen(const SceneRequest&, const Session&);
    [[nodiscard]] bool any() const { return spectral || dispersion; }
};

/// All must outlive it.
class PlanComparison {
  public:
    /// The fullest model is what the session shows with one ray for each wavelength; pixels: about
    /// so many are looked at.
    PlanComparison(const PlanRequest&, const Session&, const PlanOpen&, int pixels, TbbExecutor&);

    /// Cameras without glass, and without an iris, in place of the session's.
    void add_simpler_cameras();
    void add_rgb();
    /// One ray for all wavelengths. Where dispersion is open.
    void add_shared();
    /// A way that parts wavelengths. Where dispersion is open.
    void add_parted(const std::string& name, DispersionMode);

    /// One without a bias, whatever wavelengths do: only its cost and noise are looked at.
    void add_unbiased(const std::string& name, DispersionMode);

    /// Doubles the samples until it is known which candidates are inside, or where thorough until
    /// the predictions are good figures; never beyond most_samples of all models together.
    void look(double most_samples, bool thorough);

    /// As added, and last the fullest model: it has no bias.
    [[nodiscard]] std::vector<PlanCandidate> candidates() const;
    [[nodiscard]] double cpu_s_per_sample(size_t candidate) const;
    /// How far wavelengths are parted (apps/plan/dispersion_spread.h); 0 unless dispersion is open.
    [[nodiscard]] double spread() const { return spread_px_; }

  private:
    struct Entry {
        PlanCandidate found;
        const PilotModel* model;
        std::vector<PilotTerm> difference;  ///< from the fullest
        std::unique_ptr<PilotModel> own;    ///< the model, unless it is one of the others'
    };

    [[nodiscard]] Session open(const SceneRequest&) const;
    [[nodiscard]] std::unique_ptr<PilotModel> model(const SceneRequest&) const;
    [[nodiscard]] std::unique_ptr<PilotModel> further(const SceneRequest&) const;
    void part_wavelengths();
    void add(const std::string& name, const SceneRequest&);
    void evaluate();
    [[nodiscard]] bool settled_all(bool thorough) const;

    const PlanRequest& request_;
    const Session& first_;
    PlanOpen open_;
    SceneRequest full_scene_, shared_scene_;
    TbbExecutor& executor_;
    Pilot pilot_;
    std::unique_ptr<PilotModel> full_, shared_;
    const PilotModel* scale_ = nullptr;  ///< what errors are relative to
    std::vector<PilotTerm> minus_full_;
    std::vector<Entry> entries_;
    double spread_px_ = 0;
    float factor_ = 1;  ///< by which full_ parts wavelengths further than the fullest model
};

}  // namespace petzval
