// SPDX-License-Identifier: Apache-2.0
// Diffraction of a setup: whether it changes the picture, and the camera that has it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/setup/render_setup.h"
#include "core/light/small_features.h"

namespace petzval::apps {

/// What diffraction at the iris does to a picture.
struct DiffractionEffect {
    bool has_iris = false;
    double finest_contrast = 1;         ///< what it leaves to gratings of two pixels, line d
    std::vector<SmallFeature> lamps{};  ///< small ones that shine in, which get a star
    /// Errors of contrast against waves, the larger of three places of the film: of what a picture
    /// of so many pixels can show, up to 100 cycles/mm.
    struct Errors {
        double with = 0, without = 0;
    };
    std::optional<Errors> errors{};  ///< of a lens that is traced, in which rays err as well

    /// Whether the picture changes by more than a hundredth of contrast, and towards the truth.
    [[nodiscard]] bool matters() const {
        return has_iris && (!lamps.empty() || (changes() && !is_worse()));
    }
    /// Reason in words.
    [[nodiscard]] std::string text() const;
    /// Whether errors are worth a remark where diffraction was asked for.
    [[nodiscard]] bool has_doubt() const {
        return errors && (matters() ? errors->with > kLeastContrast : changes());
    }

  private:
    static constexpr double kLeastContrast = 0.01;
    [[nodiscard]] bool changes() const { return finest_contrast < 1 - kLeastContrast; }
    [[nodiscard]] bool is_worse() const { return errors && errors->with > errors->without; }
};
/// Effect on pictures of a view whose plane of focus lies so far from the entrance pupil. Up to a
/// second of CPU time where a lens is traced.
[[nodiscard]] DiffractionEffect diffraction_effect(const View&, V2i frame_px, double focus_m,
                                                   const PreparedScene&);

/// Spreads the camera of a view by diffraction where that was asked for and matters. Returns a
/// remark on what is wrong then, if anything is. like: nullptr, or a setup from which it is taken
/// where rays, scene and size are the same. Where displacements are weighed, sharp targets, which
/// move the film point, are left to the stars.
std::optional<std::string> add_diffraction(const SceneRequest&, double focus_m,
                                           const RenderSetup* like, const PreparedScene&, View&);

}  // namespace petzval::apps
