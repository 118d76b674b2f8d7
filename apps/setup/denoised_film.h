// SPDX-License-Identifier: Apache-2.0
// Denoised picture of a film, with what is known of its error.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "apps/setup/error_blocks.h"
#include "integrator/denoise/denoise.h"
#include "integrator/render/executor.h"

namespace petzval::apps {

/// What a film with halves shows when it is denoised.
struct DenoisedFilm {
    integrator::Denoised picture;
    double floor_nits = 0;  ///< a quarter of its mid-grey
    DenoisedError error;    ///< of the whole
    DenoisedError noisy;    ///< of the picture that is not denoised, by the same measure
    /// Error about each pixel: of the smallest square that tells it to about a third, from 32
    /// pixels on; or the least upper bound of squares about it, where that is less.
    std::vector<float> error_about;
    ErrorBlocks blocks, noisy_blocks;  ///< of both pictures, by which parts of them are told
};

/// The error and its bounds, or that it is at most so large.
[[nodiscard]] std::string text_of(const DenoisedError&);
/// What is known of the error, in a sentence.
[[nodiscard]] std::string text_of(const DenoisedFilm&);

/// Denoises a film with halves; nothing where `stop` is set meanwhile.
[[nodiscard]] std::shared_ptr<const DenoisedFilm> denoised_film(const Film&,
                                                                integrator::TbbExecutor&,
                                                                const std::atomic<bool>& stop);

}  // namespace petzval::apps
