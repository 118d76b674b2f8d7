// SPDX-License-Identifier: Apache-2.0
// From a film to a picture with its layers and everything needed to make it again.
#pragma once

#include "apps/setup/denoised_film.h"
#include "apps/setup/render_setup.h"
#include "core/film/film.h"
#include "integrator/path/path_options.h"
#include "integrator/render/render_job.h"
#include "io/picture/picture.h"

namespace petzval::apps {

/// Metadata name of an exposure that was found, not asked for: of PNG and JPEG alone.
inline constexpr const char* kFoundExposure = "petzval:exposure_ev";

/// Metadata name of the noise that was asked for: another one may go on with the same samples.
inline constexpr const char* kNoiseTarget = "petzval:noiseTarget";

/// Metadata name of the samples that a picture has, as "0:64"; with a noise to reach, at most.
inline constexpr const char* kSamples = "petzval:samples";

/// Metadata that say what the pixels of a render follow from: the same for all of its samples and
/// crops.
[[nodiscard]] io::Metadata describe_render(const RenderSetup&, const integrator::RenderJob&,
                                           const integrator::PathOptions&);

/// Picture in memory of what a film has now: R, G, B in nits, denoised where that is given, and A
/// where four channels are asked for.
[[nodiscard]] io::Picture colours_of(const Film&, int channels,
                                     const DenoisedFilm* denoised = nullptr);

/// Picture of a film that has these samples: R, G, B, A in nits of the white point; with bins the
/// channels S0 of io/image/spectral_layout.h, XYZ in nits and the standard errors of R, G and B;
/// then the denoised picture, its error and its bins, where there is one, and the film's layers as
/// "layer.channel". Metadata: those of the render, with the samples and what bins mean; no times,
/// so that equal renders are equal files. The film must outlive the rows.
[[nodiscard]] io::PictureRows develop(const Film&, SampleRange, const io::Metadata&,
                                      std::shared_ptr<const DenoisedFilm> = {});

/// Picture for a display: the denoised R, G, B in nits, and A.
[[nodiscard]] io::PictureRows denoised_colours(const Film&, SampleRange, const io::Metadata&,
                                               std::shared_ptr<const DenoisedFilm>);

}  // namespace petzval::apps
