// SPDX-License-Identifier: Apache-2.0
// Picture of a finished render, with all that its file says of it.
#pragma once

#include <filesystem>
#include <optional>

#include "apps/setup/denoised_film.h"
#include "apps/state/render_facts.h"
#include "core/film/film.h"
#include "integrator/render/noise_target.h"
#include "io/picture/picture.h"

namespace petzval::apps {

/// A finished render, as far as its pictures go.
struct FinishedFilm {
    const Film& film;
    SampleRange samples;
    const RenderFacts& facts;
    std::optional<integrator::NoiseReport> noise{};  ///< where one was to be reached
    std::shared_ptr<const DenoisedFilm> denoised{};  ///< where it was denoised
};

/// Noise that a film has reached, as its facts ask for one; nothing where none is asked for.
[[nodiscard]] std::optional<integrator::NoiseReport> reached_noise(const RenderFacts&, const Film&,
                                                                   SampleRange);

/// Warning of the samples that a film left out; nothing where there are none.
[[nodiscard]] std::optional<std::string> left_out_text(const Film&);

/// Linear picture of a film, with the metadata of its file: PNG and JPEG say how they were made for
/// a display too, and show what was denoised.
[[nodiscard]] io::PictureRows picture_for(const std::filesystem::path&, const FinishedFilm&);

}  // namespace petzval::apps
