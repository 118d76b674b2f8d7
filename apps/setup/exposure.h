// SPDX-License-Identifier: Apache-2.0
// The exposure that suits a picture, and whether a picture shows anything with the one that it has.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/setup/render_setup.h"
#include "core/film/film.h"
#include "integrator/path/path_options.h"
#include "integrator/render/executor.h"
#include "integrator/render/render_job.h"

namespace petzval::apps {

/// Exposure for a picture, from what a pilot saw.
struct FoundExposure {
    float ev = 0;            ///< a multiple of 0.1, so that it can be typed
    double log_average = 0;  ///< luminance, in units of the film; 0: no light was seen
};

/// Exposure that shows luminances well, ones above 0: their log-average becomes 0.18, the grey in
/// the middle between black and white (Reinhard et al. 2002, "Photographic tone reproduction for
/// digital images", equations 1 and 2), or less where more than a tenth would be brighter than
/// white. What is darker than a hundredth of nearly the brightest counts as that.
[[nodiscard]] FoundExposure exposure_for(std::vector<double> luminances);

/// Exposure for the full frame of a setup. It follows from scene, camera, frame and seed alone: not
/// from crop, samples or threads. Pixels count that show something of the scene; the background
/// counts where hardly any do. What a pilot of 2048 pixels does not meet is looked for in up to
/// 2^20. Uses job.seed, job.sampler and job.filter.
[[nodiscard]] FoundExposure find_exposure(const RenderSetup&, const integrator::RenderJob&,
                                          const integrator::PathOptions&, integrator::TbbExecutor&);

/// Brightness of a picture as PNG and JPEG show it.
enum class Brightness : uint8_t { Normal, Black, AlmostBlack, MostlyBlack, AlmostWhite };

/// Brightness of a film with an exposure. Pixels without light do not count.
[[nodiscard]] Brightness brightness_of(const Film&, float exposure_ev);

/// Line for a picture that shows nothing: what to type. Nothing where the picture is normal, and
/// where the exposure that was found would hardly change it, or make a mostly black one, which may
/// be meant so, less than 8 times as bright. white_cause: sentence on why a white one may be white;
/// empty: nothing is known.
[[nodiscard]] std::optional<std::string> exposure_advice(Brightness, const FoundExposure&,
                                                         float exposure_ev,
                                                         const std::string& white_cause = "");

}  // namespace petzval::apps
